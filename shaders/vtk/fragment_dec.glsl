in vec3 flowtexPositionVSOutput;
in vec2 flowtexCoordinateVSOutput;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormalVSOutput;
#endif
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoiseVSOutput;
#endif
//#include common/uniforms.glsl
//#include common/flowtex.glsl
