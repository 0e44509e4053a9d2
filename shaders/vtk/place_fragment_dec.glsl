in vec2 flowtexCoordinateVSOutput;
#ifdef FLOWTEX_TRIANGLES
flat in float flowtexTriangleVSOutput;
#endif
uniform float u_layer; // number of the layer, from 1
