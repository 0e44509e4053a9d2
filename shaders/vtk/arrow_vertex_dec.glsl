in vec2 flowtexCoordinate;
in vec2 flowtexRibbon; // piece and side
in float flowtexRadius;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormal;
#endif
#ifdef FLOWTEX_TRIANGLES
in vec4 flowtexCorners;
#endif
out vec2 flowtexPlaceVSOutput;
out float flowtexSizeVSOutput;
out vec4 flowtexCoreVSOutput; // colour, and whether it is that of a value
uniform bool u_plain; // the arrows have the colours
//#include common/arrow.glsl
//#include vtk/mapped.glsl
