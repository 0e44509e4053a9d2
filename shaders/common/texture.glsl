// The sum of equation 2: noise along the path of a fragment, weighted by a kernel.
//
// Wrappers supply
//   vec2 flowtexLookup(vec3 displacement, float length_)
// which is the noise at the traced point, in two octaves, and
//   float flowtexBlend(vec2 sums, float near)
// which mixes the two sums by the level of the fragment and brings them to unit variance.

// Variance of a sum of samples over that of independent ones, for samples that lie a number of
// grains apart: neighbours share a grain when they are close. ``near`` is the correlation of the
// weights with those of the next sample; m samples on it is about near^(m * m). That of the noise
// itself, over all directions, is a bell.
float flowtexShared(float apart, float near)
{
  float total = 1.0;
  for (int m = 1; m <= FLOWTEX_SHARED_TERMS; ++m)
  {
    float d = float(m * m) * apart * apart;
    if (d > FLOWTEX_BELL_END)
      break;
    total += 2.0 * pow(near, float(m * m)) * exp(-d * (FLOWTEX_BELL + FLOWTEX_BELL_BEND * d));
  }
  return total;
}

// Footprint of a pixel: the longest and the shortest side of what it covers.
vec2 flowtexFootprint(float aa, float bb, float determinant)
{
  float half_ = 0.5 * (aa + bb);
  float root = sqrt(max(half_ * half_ - determinant * determinant, 0.0));
  float longest = sqrt(max(half_ + root, FLOWTEX_LEAST_SQUARE));
  return vec2(longest, abs(determinant) / longest);
}

// Weight at x in -1 ... 1, negative behind the particle.
float flowtexWeight(float x)
{
  if (u_kernel == FLOWTEX_KERNEL_BOX)
    return 1.0;
  if (u_kernel == FLOWTEX_KERNEL_RAMP)
    return u_sides == 2 ? 0.5 * (1.0 - x) : 1.0 - abs(x);
  return 0.5 + 0.5 * cos(FLOWTEX_PI * x);
}

// Sums along a path: of the weighted noise in both octaves, of the squared weights, and of the
// products of neighbouring weights.
struct FlowtexSums
{
  vec2 noise;
  float squares;
  float neighbours;
};

void flowtexAdd(inout FlowtexSums sums, vec3 displacement, float length_, float weight, float before)
{
#ifdef FLOWTEX_PICTURE
  flowtexGather(displacement, weight);
#else
  sums.noise += weight * flowtexLookup(displacement, length_);
#endif
  sums.squares += weight * weight;
  sums.neighbours += weight * before;
}

// Adds one side of the path, ``count`` points ``spacing`` apart in nominal length.
void flowtexSide(inout FlowtexSums sums, FlowtexPath path, float side, float spacing, float reach,
                 float scale, int count)
{
  float last = min(reach, u_lags[u_lagCount - 1]);
  float lag = 0.0;
  float step_ = spacing / (scale * max(length(path.before), FLOWTEX_LEAST_SPEED));
  float before = flowtexWeight(0.0);
  for (int k = 1; k <= count; ++k)
  {
    lag += step_;
    float alive = clamp((last - lag) / step_ + 1.0, 0.0, 1.0);
    if (alive <= 0.0)
      break;
    vec3 displacement = flowtexFollow(path, lag) * (side * scale);
    float weight = alive * flowtexWeight(side * float(k) / float(count + 1));
    flowtexAdd(sums, displacement, side * lag * scale, weight, before);
    before = weight;
#ifndef FLOWTEX_PAPER
    // Points stay evenly spaced along the path where the particle is faster or slower there
    // than it is here: equation 3 at every point of the path.
    step_ = spacing / (scale * max(flowtexSpeed(path, lag), FLOWTEX_LEAST_SPEED));
#endif
  }
}

// Texture of a fragment, of zero mean and about unit variance. ``spacing`` is that of the points
// in nominal length, or in units of lag for the paper's textures.
float flowtexTexture(vec2 coordinate, float sliceLevel, float spacing)
{
  vec4 base = flowtexLayer(coordinate, 0, sliceLevel);
  vec4 back = flowtexLayer(coordinate, 1, sliceLevel);
  FlowtexSums sums = FlowtexSums(vec2(0.0), 0.0, 0.0);
  float speed = length(base.xyz);
  flowtexMove(speed, u_moving ? flowtexLayer(coordinate, 2, sliceLevel).w : 1.0);
  flowtexAdd(sums, vec3(0.0), 0.0, max(flowtexWeight(0.0), FLOWTEX_LEAST_WEIGHT), 0.0);
  if (speed > FLOWTEX_LEAST_SPEED)
  {
#ifdef FLOWTEX_PAPER
    float scale = 1.0;
    spacing *= speed;
#else
    float scale = base.w * u_unit;
#endif
    int count = u_sides == 2 ? u_samples / 2 : u_samples - 1;
    flowtexSide(sums, flowtexStart(coordinate, sliceLevel, base.xyz, back.xyz, 0), -1.0, spacing,
                back.w, scale, count);
    if (u_sides == 2)
    {
      vec4 ahead = flowtexLayer(coordinate, u_lagCount + 1, sliceLevel);
      flowtexSide(sums, flowtexStart(coordinate, sliceLevel, base.xyz, ahead.xyz, u_lagCount), 1.0,
                  spacing, ahead.w, scale, count);
    }
  }
  return flowtexBlend(sums.noise * inversesqrt(sums.squares), sums.neighbours / sums.squares);
}
