// The sums of a pixel of a layer, by its place: the texture, and what is below it.
#define FLOWTEX_DEFERRED

//#include common/uniforms.glsl
#ifdef FLOWTEX_REPEATED
uniform vec4 u_ends;         // of a map around the Earth: unit vector across it, and its ends along that
uniform vec3 u_turnEven;     // from one end to the other in cells of octave 0: whole numbers,
uniform vec3 u_turnRestEven; // and the rest
uniform vec3 u_turnOdd;      // the same in cells of octave 1
uniform vec3 u_turnRestOdd;
#endif
//#include common/flowtex.glsl
//#include webgl2/mapped.glsl
uniform highp usampler2D u_places; // as webgl2/place.glsl writes them
uniform int u_layer;
#ifdef FLOWTEX_TRIANGLES
uniform highp usampler2D u_corners; // as in webgl2/vertex.glsl
#endif
#ifdef FLOWTEX_IMAGE
uniform highp sampler2D u_along; // coordinates of columns and rows in the image
#endif
uniform highp sampler2D u_shares; // of the colour map's range at the nodes, at both times of the slices
uniform bool u_flat;       // values belong to cells: they lie at first nodes, or are those of triangles
uniform bool u_mapped;     // colour by the scalar, or one colour for all
uniform vec3 u_colour;
uniform bool u_lit;
uniform vec3 u_toEye;      // way to the light, which is the camera's own

layout(location = 0) out vec4 flowtexUnder;    // colour below the texture
layout(location = 1) out vec4 flowtexTextured; // texture before it fades, the factor by which it does, and the light

// The share at a place, between the corners of its triangle.
float flowtexShareAt(vec2 coordinate, int triangle)
{
  ivec2 size = textureSize(u_shares, 0);
#ifdef FLOWTEX_TRIANGLES
  vec3 shares = flowtexShares(coordinate);
  vec2 share = mat3x2(texelFetch(u_shares, flowtexNodes[0], 0).xy, texelFetch(u_shares, flowtexNodes[1], 0).xy,
                      texelFetch(u_shares, flowtexNodes[2], 0).xy) * shares;
  if (u_flat)
    share = texelFetch(u_shares, ivec2(triangle % size.x, triangle / size.x), 0).xy;
#else
  vec2 at = coordinate * u_slicesSize - 0.5 - u_padding;
  ivec2 cell = clamp(ivec2(floor(at)), ivec2(0), size - 2);
  vec2 part = clamp(at - vec2(cell), 0.0, 1.0);
  float least = min(part.x, part.y);
  float most = max(part.x, part.y);
  ivec2 aside = part.x >= part.y ? ivec2(1, 0) : ivec2(0, 1);
  vec2 share = (1.0 - most) * texelFetch(u_shares, cell, 0).xy
    + (most - least) * texelFetch(u_shares, cell + aside, 0).xy
    + least * texelFetch(u_shares, cell + 1, 0).xy;
  if (u_flat)
    share = texelFetch(u_shares, cell, 0).xy;
#endif
#ifdef FLOWTEX_UNSTEADY
  return mix(share.x, share.y, u_between);
#else
  return share.x;
#endif
}

#ifdef FLOWTEX_IMAGE
// The texture at a place, whose coordinate in the image is linear between the nodes.
vec2 flowtexImageAt(FlowtexPlace place)
{
  vec2 at = place.coordinate * u_slicesSize - 0.5 - u_padding;
  ivec2 cell = clamp(ivec2(floor(at)), ivec2(0), textureSize(u_nodes, 0).xy - 2);
  vec2 first = vec2(texelFetch(u_along, ivec2(cell.x, 0), 0).x, texelFetch(u_along, ivec2(cell.y, 0), 0).y);
  vec2 change = vec2(texelFetch(u_along, ivec2(cell.x + 1, 0), 0).x, texelFetch(u_along, ivec2(cell.y + 1, 0), 0).y) - first;
  vec2 scale = change * u_slicesSize;
  return flowtexFragment(place.coordinate, first + change * (at - vec2(cell)), scale * place.byX, scale * place.byY,
                         flowtexSliceLevel(place.byX, place.byY));
}
#endif

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uvec4 drawn = texelFetch(u_places, pixel, 0);
  if (int(drawn.w) != u_layer)
    discard;
  int triangle = int(drawn.z);
#ifdef FLOWTEX_TRIANGLES
  int width = textureSize(u_corners, 0).x;
  flowtexSetCorners(vec3(texelFetch(u_corners, ivec2(triangle % width, triangle / width), 0).xyz));
#endif
  FlowtexPlace place = flowtexFindPlace(vec2(pixel) + 0.5, uintBitsToFloat(drawn.xy));
#ifdef FLOWTEX_IMAGE
  vec2 textured = flowtexImageAt(place);
#else
  vec2 textured = flowtexValueAt(place);
#endif
  vec3 colour = u_mapped ? flowtexMapped(flowtexShareAt(place.coordinate, triangle)) : u_colour;
  if (u_showLevel)
    colour = flowtexLevelColour(flowtexNoiseLevel);
#ifdef FLOWTEX_PAINTED
  colour = flowtexPaint(colour);
#endif
  float light = 1.0;
  if (u_lit)
  {
    float facing = abs(dot(normalize(place.normal), u_toEye));
    light = min(FLOWTEX_AMBIENT_LIGHT + FLOWTEX_DIFFUSE_LIGHT * facing, 1.0);
  }
  flowtexUnder = vec4(colour, 1.0);
  flowtexTextured = vec4(textured, light, 0.0);
}
