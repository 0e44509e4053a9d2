in vec3 flowtexPosition;
in vec2 flowtexCoordinate;
out vec3 flowtexPositionVS;
out vec2 flowtexCoordinateVS;
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoise;
out vec2 flowtexNoiseVS;
#endif
