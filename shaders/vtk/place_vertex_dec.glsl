in vec2 flowtexCoordinate;
out vec2 flowtexCoordinateVSOutput;
#ifdef FLOWTEX_TRIANGLES
in vec4 flowtexCorners; // numbers of the three nodes and of the triangle, the same at each
flat out float flowtexTriangleVSOutput;
#endif
