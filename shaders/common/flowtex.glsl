// The method: everything a fragment needs, in the order that GLSL asks for.

#ifdef FLOWTEX_PAINTED
void flowtexGather(vec3 displacement, float weight);
#else
vec2 flowtexLookup(vec3 displacement, float length_);
float flowtexBlend(vec2 sums, float near);
#endif
#ifndef FLOWTEX_IMAGE
void flowtexMove(float slope, float speed);
#endif
//#include common/path.glsl
//#include common/cell.glsl
//#include common/even_gain.glsl
//#include common/texture.glsl
//#include common/derivatives.glsl
//#include common/levels.glsl
//#include common/shade.glsl
#ifdef FLOWTEX_IMAGE
//#include common/mip_level.glsl
#ifdef FLOWTEX_PAINTED
//#include common/lookup_image.glsl
#else
//#include common/lookup_noise_texture.glsl
#endif
#else
//#include common/noise.glsl
//#include common/lookup_space.glsl
#endif
//#include common/fragment.glsl
