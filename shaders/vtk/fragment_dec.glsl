in vec3 flowtexPositionVSOutput;
in vec2 flowtexCoordinateVSOutput;
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoiseVSOutput;
#endif
//#include common/uniforms.glsl
//#include common/flowtex.glsl
