// The noise at a traced point: even in space, at the level of the fragment.

vec3 flowtexHere;    // position relative to u_noiseOrigin
float flowtexPixel;  // length that a pixel covers

float flowtexLookup(vec3 displacement, float length_, float level)
{
  float turn = u_turn + u_wave * length_ / flowtexPixel;
  return flowtexNoise(flowtexHere + displacement, level, turn);
}

// Texture at a position with the footprint given by its derivatives.
float flowtexFragment(vec3 position, vec3 dx, vec3 dy, vec2 coordinate, float sliceLevel)
{
  float determinant = length(cross(dx, dy));
  vec2 footprint = flowtexFootprint(dot(dx, dx), dot(dy, dy), determinant);
  flowtexPixel = u_lod ? footprint.x : u_texel;
  flowtexHere = position - u_noiseOrigin;
  float level = max(log2(flowtexPixel * u_grain / u_noiseFinest), 0.0);
  return flowtexTexture(coordinate, sliceLevel, level, u_spacing * flowtexPixel * u_grain);
}
