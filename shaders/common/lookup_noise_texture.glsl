// The noise at a traced point: a mipmapped texture on the parameters of the surface, as in the paper.
//
// The level is the one that mipmapping chooses for the noise at the fragment (section 4), and the step is
// looked up at the same level, where its values count 2^level times (section 4.1). What averaging takes of
// the contrast is known and made up for (flowtex/textures/noise_textures.py).

vec2 flowtexHere;        // noise coordinate of the fragment
float flowtexNoiseLevel; // level of the noise
float flowtexGain;       // one over the deviation of the noise at that level

// Deviation of the noise at a level.
float flowtexDeviation(float level)
{
  float at = min(2.0 * level, FLOWTEX_LAST_HALF_LEVEL);
  int n = int(at);
  return mix(u_noiseDeviations[n], u_noiseDeviations[n + 1], at - float(n));
}

vec2 flowtexLookup(vec3 displacement, float length_)
{
  vec2 at = flowtexHere + displacement.xy;
  return vec2(textureLod(u_image, vec3(at, 0.0), flowtexNoiseLevel).r * flowtexGain, 0.0);
}

// Samples are as far from each other as texels.
float flowtexBlend(vec2 sums, float near)
{
  return sums.x * inversesqrt(flowtexShared(vec2(u_spacing), near).x);
}

// Texture and factor at a noise coordinate with its derivatives.
vec2 flowtexFragment(vec2 coordinate, vec2 at, vec2 dx, vec2 dy, float sliceLevel)
{
  flowtexHere = at;
  flowtexNoiseLevel = flowtexMip(flowtexCovered(dx, dy, u_imageSize));
  flowtexGain = 1.0 / flowtexDeviation(flowtexNoiseLevel);
  float step_ = textureLod(u_stepImage, vec3(at, 0.0), flowtexNoiseLevel).r * exp2(flowtexNoiseLevel);
  vec4 base = flowtexLayer(coordinate, 0, sliceLevel);
  return flowtexTexture(coordinate, sliceLevel, base, step_ * u_spacing, 1.0, vec2(1.0));
}
