// The texture of each pixel of one layer, by its place in the buffer of places.
uniform sampler2D u_places; // coordinate, number of the triangle, and of the layer
uniform float u_layer;
#ifdef FLOWTEX_TRIANGLES
uniform highp sampler2DArray u_corners; // nodes of the triangles
#endif
//#include common/uniforms.glsl
//#include common/flowtex.glsl

// A pixel without a place, at the outline, takes that of the pixel beside it.
vec4 flowtexPlaceAt(inout ivec2 pixel)
{
  vec4 place = texelFetch(u_places, pixel, 0);
  ivec2 last = textureSize(u_places, 0) - 1;
  for (int n = 0; n < 4 && place.w == 0.0; ++n)
  {
    ivec2 beside = clamp(pixel + ivec2(n < 2 ? 2 * n - 1 : 0, n < 2 ? 0 : 2 * n - 5), ivec2(0), last);
    place = texelFetch(u_places, beside, 0);
    if (place.w != 0.0)
      pixel = beside;
  }
  return place;
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 place = flowtexPlaceAt(pixel);
  if (place.w != u_layer)
    discard;
#ifdef FLOWTEX_TRIANGLES
  int width = textureSize(u_corners, 0).x;
  int triangle = int(place.z + 0.5);
  flowtexSetCorners(texelFetch(u_corners, ivec3(triangle % width, triangle / width, 0), 0).xyz);
#endif
  FlowtexPlace found = flowtexFindPlace(vec2(pixel) + 0.5, place.xy);
  float value = flowtexValueAt(found);
  gl_FragData[0] = vec4(value, flowtexNoiseLevel, found.coordinate);
}
