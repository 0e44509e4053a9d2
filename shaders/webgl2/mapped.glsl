uniform highp sampler2D u_cmap;

// Nodes without a value have a share far below all others.
const float FLOWTEX_NO_VALUE = -1e3;

int flowtexColourCount()
{
  return textureSize(u_cmap, 0).x;
}

vec4 flowtexColourOf(int n)
{
  return texelFetch(u_cmap, ivec2(n, 0), 0);
}

//#include common/mapped.glsl

// Scalars are interpolated first and mapped then.
vec3 flowtexMapped(float share)
{
  return flowtexColourAt(share, share >= FLOWTEX_NO_VALUE);
}
