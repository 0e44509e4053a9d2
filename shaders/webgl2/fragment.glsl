in vec3 flowtexPositionOut;
in vec2 flowtexCoordinateOut;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormalOut;
#endif
#ifdef FLOWTEX_TRIANGLES
flat in vec3 flowtexCornersOut;
in float flowtexScalarOut;
flat in float flowtexFlatOut;
#endif
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoiseOut;
#endif

//#include common/uniforms.glsl
//#include common/flowtex.glsl

//#include webgl2/mapped.glsl
#ifndef FLOWTEX_TRIANGLES
uniform highp sampler2D u_shares; // of the colour map's range at the nodes, at both times of the slices
#endif
uniform bool u_flat;       // values belong to cells: they lie at first nodes, or are those of triangles
uniform bool u_mapped;     // colour by the scalar, or one colour for all
uniform vec3 u_colour;
uniform bool u_lit;
uniform vec3 u_toEye;      // way to the light, which is the camera's own
uniform vec3 u_ground;     // behind the surface
uniform float u_opacity;

out vec4 flowtexOut;

#ifndef FLOWTEX_TRIANGLES
// The share at a place, in the triangles of its cell: those that are drawn may cover many cells.
float flowtexShareAt(vec2 coordinate)
{
  vec2 at = coordinate * u_slicesSize - 0.5 - u_padding;
  ivec2 cell = clamp(ivec2(floor(at)), ivec2(0), textureSize(u_shares, 0) - 2);
  vec2 part = clamp(at - vec2(cell), 0.0, 1.0);
  float least = min(part.x, part.y);
  float most = max(part.x, part.y);
  ivec2 aside = part.x >= part.y ? ivec2(1, 0) : ivec2(0, 1);
  vec2 share = (1.0 - most) * texelFetch(u_shares, cell, 0).xy
    + (most - least) * texelFetch(u_shares, cell + aside, 0).xy
    + least * texelFetch(u_shares, cell + 1, 0).xy;
  if (u_flat)
    share = texelFetch(u_shares, cell, 0).xy;
#ifdef FLOWTEX_UNSTEADY
  return mix(share.x, share.y, u_between);
#else
  return share.x;
#endif
}
#endif

void main()
{
#ifdef FLOWTEX_TRIANGLES
  flowtexSetCorners(flowtexCornersOut);
#endif
#if defined(FLOWTEX_PAPER)
  float textured = flowtexValue(flowtexCoordinateOut, flowtexNoiseOut);
#elif defined(FLOWTEX_PLANAR)
  float textured = flowtexValue(flowtexCoordinateOut, flowtexPositionOut, vec3(0.0, 0.0, 1.0));
#else
  float textured = flowtexValue(flowtexCoordinateOut, flowtexPositionOut, flowtexNormalOut);
#endif
#ifdef FLOWTEX_TRIANGLES
  vec3 colour = u_mapped ? flowtexMapped(u_flat ? flowtexFlatOut : flowtexScalarOut) : u_colour;
#else
  vec3 colour = u_mapped ? flowtexMapped(flowtexShareAt(flowtexCoordinateOut)) : u_colour;
#endif
  if (u_showLevel)
    colour = flowtexLevelColour(flowtexNoiseLevel);
#ifdef FLOWTEX_PICTURE
  colour = flowtexPaint(colour);
#else
  colour = flowtexShade(colour, textured);
#endif
  if (u_lit)
  {
#ifdef FLOWTEX_PLANAR
    float facing = abs(u_toEye.z);
#else
    float facing = abs(dot(normalize(flowtexNormalOut), u_toEye));
#endif
    colour *= min(FLOWTEX_AMBIENT_LIGHT + FLOWTEX_DIFFUSE_LIGHT * facing, 1.0);
  }
  // One layer before the ground: no order of drawing to keep.
  flowtexOut = vec4(mix(u_ground, colour, u_opacity), 1.0);
}
