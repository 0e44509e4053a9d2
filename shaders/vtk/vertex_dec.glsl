in vec3 flowtexPosition;
in vec2 flowtexCoordinate;
out vec3 flowtexPositionVSOutput;
out vec2 flowtexCoordinateVSOutput;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormal;
out vec3 flowtexNormalVSOutput;
#endif
#ifdef FLOWTEX_TRIANGLES
in vec3 flowtexCorners; // numbers of the three nodes, the same at each
flat out vec3 flowtexCornersVSOutput;
#endif
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoise;
out vec2 flowtexNoiseVSOutput;
#endif
