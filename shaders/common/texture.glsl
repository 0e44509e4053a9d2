// The sum of equation 2: noise along the path of a fragment, weighted by a kernel.
//
// Wrappers supply flowtexLookup(displacement, lag), which is the noise at the traced point, for
// the procedural noise or for the paper's texture.

// Footprint of a pixel: the longest and the shortest side of what it covers.
vec2 flowtexFootprint(float aa, float bb, float determinant)
{
  float half_ = 0.5 * (aa + bb);
  float longest = sqrt(max(half_ + sqrt(max(half_ * half_ - determinant * determinant, 0.0)), 1e-38));
  return vec2(longest, abs(determinant) / longest);
}

// Weight at x in -1 ... 1, negative behind the particle. Kernels: 0 Hann, 1 box, 2 ramp.
float flowtexWeight(float x)
{
  if (u_kernel == 1)
    return 1.0;
  if (u_kernel == 2)
    return u_sides == 2 ? 0.5 * (1.0 - x) : 1.0 - abs(x);
  return 0.5 + 0.5 * cos(3.14159265 * x);
}

// Adds one side of the path. ``sum`` holds the weighted noise, the weights' squares and weights.
void flowtexSide(inout vec3 sum, FlowtexPath path, float side, float step_, float reach,
                 float scale, float level, int count)
{
  float last = min(reach, u_lags[u_lagCount - 1]);
  for (int k = 1; k <= count; ++k)
  {
    float lag = float(k) * step_;
    float alive = clamp((last - lag) / step_ + 1.0, 0.0, 1.0);
    if (alive <= 0.0)
      break;
    vec3 displacement = flowtexFollow(path, lag) * (side * scale);
    float weight = alive * flowtexWeight(side * float(k) / float(count + 1));
    sum += vec3(weight * flowtexLookup(displacement, side * lag * scale, level), weight * weight, weight);
  }
}

// Texture of a fragment, of zero mean and about unit variance.
float flowtexTexture(vec2 coordinate, float sliceLevel, float noiseLevel, float stepLength)
{
  vec4 base = flowtexLayer(coordinate, 0, sliceLevel);
  vec4 back = flowtexLayer(coordinate, 1, sliceLevel);
  float scale = base.w * u_unit;
  float speed = length(base.xyz);
  float here = flowtexLookup(vec3(0.0), 0.0, noiseLevel);
  if (speed < 1e-6)
    return here;
#ifdef FLOWTEX_PAPER
  float step_ = stepLength;
  scale = 1.0;
#else
  float step_ = stepLength / (scale * speed);
#endif
  int count = u_sides == 2 ? u_samples / 2 : u_samples - 1;
  float weight = flowtexWeight(0.0);
  vec3 sum = vec3(weight * here, weight * weight, weight);
  flowtexSide(sum, flowtexStart(coordinate, sliceLevel, base.xyz, back.xyz, 0), -1.0, step_, back.w,
              scale, noiseLevel, count);
  if (u_sides == 2)
  {
    vec4 ahead = flowtexLayer(coordinate, u_lagCount + 1, sliceLevel);
    flowtexSide(sum, flowtexStart(coordinate, sliceLevel, base.xyz, ahead.xyz, u_lagCount), 1.0,
                step_, ahead.w, scale, noiseLevel, count);
  }
  return sum.x * inversesqrt(sum.y * u_correlation);
}

// Colour with the texture laid over it: darker below the middle tone, lighter above, so that the
// texture shows on dark colours too and the mean over many grains stays close to the colour.
vec3 flowtexShade(vec3 colour, float value)
{
  float tone = 2.0 / (1.0 + exp(-1.3 * u_contrast * value)) - 1.0;
  float dark = u_strength * max(-tone, 0.0);
  float light = u_strength * max(tone, 0.0);
  return mix(mix(colour, colour * 0.12, dark), vec3(1.0), 0.62 * light);
}
