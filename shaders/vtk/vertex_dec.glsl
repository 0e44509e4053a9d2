in vec3 flowtexPosition;
in vec2 flowtexCoordinate;
out vec3 flowtexPositionVSOutput;
out vec2 flowtexCoordinateVSOutput;
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoise;
out vec2 flowtexNoiseVSOutput;
#endif
