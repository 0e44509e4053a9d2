// The method: everything a fragment needs, in the order that GLSL asks for.

vec2 flowtexLookup(vec3 displacement, float length_);
float flowtexBlend(vec2 sums);
//#include common/path.glsl
//#include common/texture.glsl
//#include common/levels.glsl
#ifdef FLOWTEX_PAPER
//#include common/lookup_paper.glsl
#else
//#include common/noise.glsl
//#include common/lookup_space.glsl
#endif
