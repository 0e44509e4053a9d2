uniform sampler2D u_places; // coordinate, number of the triangle, and of the layer

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
