// The method: everything a fragment needs, in the order that GLSL asks for.

//#include common/path.glsl
#ifdef FLOWTEX_PAPER
float flowtexLookup(vec3 displacement, float length_, float level);
#else
//#include common/noise.glsl
float flowtexLookup(vec3 displacement, float length_, float level);
#endif
//#include common/texture.glsl
//#include common/levels.glsl
#ifdef FLOWTEX_PAPER
//#include common/lookup_paper.glsl
#else
//#include common/lookup_space.glsl
#endif
