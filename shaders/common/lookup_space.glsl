// The noise at a traced point: even in space, at the level of the fragment.
//
// The finer octave has lattice cells of half a grain to one grain, the coarser one of one to two.

FlowtexLattice flowtexFine;
FlowtexLattice flowtexCoarse;
float flowtexPixel; // length that a pixel covers
float flowtexLate;  // how far the level is from the finer octave to the coarser one

vec2 flowtexLookup(vec3 displacement, float length_)
{
  float turn = u_turn + u_wave * length_ / flowtexPixel;
  return vec2(flowtexOctave(flowtexFine, displacement, turn),
              flowtexOctave(flowtexCoarse, displacement, turn));
}

// The finer octave fades early, before its grains are smaller than a pixel.
float flowtexBlend(vec2 sums)
{
  float w = (1.0 - flowtexLate) * sqrt(1.0 - flowtexLate);
  sums *= inversesqrt(flowtexShared(u_spacing * exp2(flowtexLate) * vec2(1.0, 0.5)));
  return (sums.x * w + sums.y * (1.0 - w)) * inversesqrt(1.0 - 2.0 * w * (1.0 - w));
}

// Texture at a position with the footprint given by its derivatives.
float flowtexFragment(vec3 position, vec3 dx, vec3 dy, vec2 coordinate, float sliceLevel)
{
  vec2 footprint = flowtexFootprint(dot(dx, dx), dot(dy, dy), length(cross(dx, dy)));
  flowtexPixel = u_lod ? footprint.x : u_texel;
  float level = clamp(log2(flowtexPixel * u_grain / u_noiseFinest), 0.0, 29.99);
  int octave = int(level);
  flowtexLate = level - float(octave);
  flowtexFine = flowtexLattice(position - u_noiseOrigin, octave);
  flowtexCoarse = flowtexLattice(position - u_noiseOrigin, octave + 1);
  return flowtexTexture(coordinate, sliceLevel, u_spacing * flowtexPixel * u_grain);
}
