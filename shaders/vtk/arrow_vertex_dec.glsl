in vec2 flowtexCoordinate;
in vec2 flowtexRibbon; // piece and side
in float flowtexRadius;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormal;
#endif
#ifdef FLOWTEX_TRIANGLES
in vec3 flowtexCorners;
#endif
out vec2 flowtexPlaceVSOutput;
out vec2 flowtexShapeVSOutput; // size and share
//#include common/arrow.glsl
