#ifndef FLOWTEX_DEFERRED
in vec2 flowtexCoordinate;
out vec2 flowtexCoordinateVSOutput;
in vec3 flowtexPosition;
out vec3 flowtexPositionVSOutput;
#ifdef FLOWTEX_TRIANGLES
in vec4 flowtexCorners; // numbers of the three nodes and of the triangle, the same at each
flat out vec4 flowtexCornersVSOutput;
#endif
#ifdef FLOWTEX_IMAGE
in vec2 flowtexImage;
out vec2 flowtexImageVSOutput;
#endif
#endif
