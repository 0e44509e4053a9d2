in vec3 flowtexPositionVSOutput;
in vec2 flowtexCoordinateVSOutput;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormalVSOutput;
#endif
#ifdef FLOWTEX_TRIANGLES
flat in vec3 flowtexCornersVSOutput;
#endif
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoiseVSOutput;
#endif
//#include common/uniforms.glsl
//#include common/flowtex.glsl

uniform bool u_mapped;            // colour by the values of the nodes, or as VTK does
uniform sampler2DArray u_shares;  // of the range of the colour map, and where there is a value
uniform sampler2DArray u_colours; // below the range, in it, above it, and without a value
uniform vec2 u_padding;           // texels of the slices before the first node

#ifdef FLOWTEX_PLACED
uniform sampler2DArray u_nodes;   // nodes in the plane of the surface
uniform vec2 u_anchor;            // what positions are counted from there
const float FLOWTEX_PLACE_FAR = 4.0; // cells beyond which a correction is none

// A triangle that covers many cells gives a guess, of which a step of Newton's method takes the error.
vec2 flowtexPlace(vec2 coordinate, vec2 position)
{
  vec2 at = coordinate * u_slicesSize - 0.5 - u_padding;
  ivec2 cell = clamp(ivec2(floor(at)), ivec2(0), textureSize(u_nodes, 0).xy - 2);
  vec2 part = at - vec2(cell);
  bool lower = part.x >= part.y;
  vec2 near = texelFetch(u_nodes, ivec3(cell, 0), 0).xy;
  vec2 far = texelFetch(u_nodes, ivec3(cell + 1, 0), 0).xy;
  vec2 beside = texelFetch(u_nodes, ivec3(cell + (lower ? ivec2(1, 0) : ivec2(0, 1)), 0), 0).xy;
  mat2 sides = lower ? mat2(beside - near, far - beside) : mat2(far - beside, beside - near);
  vec2 off = position + u_anchor - near - sides * part;
  vec2 step_ = vec2(sides[1].y * off.x - sides[1].x * off.y, sides[0].x * off.y - sides[0].y * off.x);
  step_ /= sides[0].x * sides[1].y - sides[1].x * sides[0].y;
  // Where cells have collapsed there is no number.
  if (max(abs(step_.x), abs(step_.y)) <= FLOWTEX_PLACE_FAR)
    at += step_;
  return (at + u_padding + 0.5) / u_slicesSize;
}
#endif

// Values are interpolated first and mapped then, each entry of the map over an equal share.
vec3 flowtexMapped(vec2 coordinate)
{
#ifdef FLOWTEX_TRIANGLES
  vec3 shares = flowtexShares(coordinate);
  vec2 share = vec2(0.0);
  for (int k = 0; k < 3; ++k)
    share += shares[k] * texelFetch(u_shares, ivec3(flowtexNodes[k], 0), 0).rg;
#else
  vec2 at = (coordinate * u_slicesSize - u_padding) / vec2(textureSize(u_shares, 0).xy);
  vec2 share = textureLod(u_shares, vec3(at, 0.0), 0.0).rg;
#endif
  int count = textureSize(u_colours, 0).x - 3;
  float place = share.x / max(share.y, 0.5);
  int entry = place == 1.0 ? count : int(clamp(floor(place * float(count)), -1.0, float(count))) + 1;
  if (share.y < 0.5)
    entry = count + 2;
  return texelFetch(u_colours, ivec3(entry, 0, 0), 0).rgb;
}
