in vec3 flowtexPositionVS;
in vec2 flowtexCoordinateVS;
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoiseVS;
#endif
//#include common/uniforms.glsl
//#include common/flowtex.glsl
