// The noise at a traced point: even in space, at the level of the fragment.

FlowtexLattice flowtexFine;
FlowtexLattice flowtexCoarse;
float flowtexPixel;      // length that a pixel covers
float flowtexLate;       // how far the level is from the finer octave to the coarser one
float flowtexNoiseLevel; // octaves of a factor 2 above the grain that is fixed on the surface
#ifdef FLOWTEX_REPEATED
FlowtexLattice flowtexFineBeyond; // beyond the nearer end of the map: those of its other end
FlowtexLattice flowtexCoarseBeyond;
vec3 flowtexEnd; // unit vector towards that end, and the way there
#endif

vec2 flowtexLookup(vec3 displacement, float length_)
{
#ifdef FLOWTEX_MOVING
  vec2 turns = flowtexMotion.clock + flowtexMotion.turns * length_;
#else
  const vec2 turns = vec2(0.0);
#endif
#ifdef FLOWTEX_REPEATED
  if (dot(displacement.xy, flowtexEnd.xy) > flowtexEnd.z)
    return vec2(flowtexOctave(flowtexFineBeyond, displacement, turns),
                flowtexOctave(flowtexCoarseBeyond, displacement, turns));
#endif
  return vec2(flowtexOctave(flowtexFine, displacement, turns),
              flowtexOctave(flowtexCoarse, displacement, turns));
}

// The variance of the mixture is known: that of both sums, which are independent.
float flowtexBlend(vec2 sums, float near)
{
  vec2 w = vec2(1.0 - flowtexLate, flowtexLate);
  vec2 apart = u_spacing * exp2(0.5 * flowtexLate) * vec2(1.0, FLOWTEX_SQRT_HALF);
  return dot(sums, w) * inversesqrt(dot(w * w, flowtexShared(apart, near)));
}

// Rates of the motion at a fragment. The value of a grain comes back after one turn, so a turn
// must take as long as the flow needs for a stretch that shows well, u_wave pixels and a little
// more. Turns take the base period divided by a power of two, so all are whole after the base
// period, and two neighbours are blended. Where the flow is too slow for one turn it stands.
void flowtexMove(float slope, float speed)
{
  float travel = u_travel * (u_travelInPixels ? flowtexPixel : 1.0) * (u_travelBySpeed ? speed : 1.0);
  float rate = log2(max(travel / (u_wave * flowtexPixel), FLOWTEX_LEAST_RATE));
  vec2 rates = floor(rate) + vec2(0.0, 1.0);
  vec2 turns = exp2(rates) * step(vec2(0.0), rates);
  flowtexMotion.clock = fract(turns * u_clock.x) + turns * u_clock.y;
  flowtexMotion.turns = turns * slope / max(travel, FLOWTEX_LEAST_TRAVEL);
  // A rate keeps its phases, whether it is the slower one or the faster one.
  vec2 phases = vec2(1.0, FLOWTEX_MANY_PHASES) / (2.0 * FLOWTEX_MOST_GRAIN);
  flowtexMotion.phases = mod(rates.x, 2.0) < 0.5 ? phases : phases.yx;
  vec2 shares = vec2(1.0 - rate + rates.x, rate - rates.x);
  flowtexMotion.shares = shares * (FLOWTEX_MOST_GRAIN * inversesqrt(dot(shares, shares)));
}

// How far a pixel extends on the surface across the flow; zero where it has no direction.
float flowtexAcross(vec3 dx, vec3 dy, vec3 tangent)
{
  vec3 across = flowtexUnit(cross(flowtexUnit(cross(dx, dy)), tangent));
  return length(vec2(dot(dx, across), dot(dy, across)));
}

// Texture and factor at a position with the footprint given by its derivatives.
vec2 flowtexFragment(vec3 position, vec3 dx, vec3 dy, vec2 coordinate, float sliceLevel)
{
  vec4 base = flowtexLayer(coordinate, 0, sliceLevel);
  vec2 footprint = flowtexFootprint(dx, dy);
  // The mean of both sides, as the longer one alone would draw grains out where it is far longer.
  float side = sqrt(footprint.x * max(footprint.y, FLOWTEX_LEAST_ROUND * footprint.x));
  float across = flowtexAcross(dx, dy, base.xyz);
  // Streaks along an outline would be finer than pixels.
  flowtexPixel = u_lod ? max(side, FLOWTEX_LEAST_ACROSS * across) : u_texel / u_grain;
  vec2 drawn = vec2(1.0);
  float stretch = 1.0;
  if (u_lod && !u_fixed && across > 0.0)
  {
    drawn = vec2(flowtexPixel / across, flowtexPixel * across / (footprint.x * footprint.y));
    // A streak is as long in the picture as where the surface faces the eye.
    stretch = clamp(1.0 / drawn.y, 1.0 / FLOWTEX_MOST_STRETCH, FLOWTEX_MOST_STRETCH);
    if (abs(stretch - 1.0) < FLOWTEX_LEAST_STRETCH)
      stretch = 1.0;
  }
  float grain = u_fixed ? max(flowtexPixel * u_grain, u_texel) : flowtexPixel * u_grain;
  flowtexNoiseLevel = log2(grain / u_texel);
  float level = clamp(2.0 * log2(grain / u_noiseFinest), 0.0, FLOWTEX_LAST_OCTAVE);
  int octave = int(level);
  flowtexLate = level - float(octave);
  flowtexFine = flowtexLattice(position - u_noiseOrigin, octave, 0.0);
  flowtexCoarse = flowtexLattice(position - u_noiseOrigin, octave + 1, 0.0);
#ifdef FLOWTEX_REPEATED
  float along = dot(position.xy, u_ends.xy);
  float turn = 2.0 * along > u_ends.z + u_ends.w ? 1.0 : -1.0;
  flowtexEnd = vec3(turn * u_ends.xy, turn > 0.0 ? u_ends.w - along : along - u_ends.z);
  flowtexFineBeyond = flowtexLattice(position - u_noiseOrigin, octave, turn);
  flowtexCoarseBeyond = flowtexLattice(position - u_noiseOrigin, octave + 1, turn);
#endif
  return flowtexTexture(coordinate, sliceLevel, base, u_spacing * grain, stretch, drawn);
}
