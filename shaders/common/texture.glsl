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

// Weights along a side of the path are x + y * cos(pi * t) + z * t, with t from 0 at the particle to 1
// beyond the last sample. Kernels: 0 Hann, 1 box, 2 ramp, which falls behind the particle.
vec3 flowtexKernel(float side)
{
  if (u_kernel == FLOWTEX_KERNEL_BOX)
    return vec3(1.0, 0.0, 0.0);
  if (u_kernel == FLOWTEX_KERNEL_RAMP)
    return u_sides == 2 ? vec3(0.5, 0.0, -0.5 * side) : vec3(1.0, 0.0, -1.0);
  return vec3(0.5, 0.5, 0.0);
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

// Adds one side of the path, ``count`` points ``spacing`` apart in nominal length. ``before`` and
// ``after`` are the slopes at lag zero and at the first lag, ``first`` the layer before the first slice.
//
// The loop over the segments between two lags is outside, so that no sample fetches anything.
void flowtexSide(inout FlowtexSums sums, vec2 coordinate, float level, vec3 before, vec3 after,
                 int first, float side, float spacing, float reach, float scale, int count,
                 bool inCell)
{
  float last = min(reach, u_lags[u_lagCount - 1]);
  float per_speed = scale / spacing;
  float rate = per_speed * max(length(before), FLOWTEX_LEAST_SPEED); // samples in a unit of lag
  float lag = 1.0 / rate;
  float from = 0.0;
  float to = u_lags[0];
  vec3 kernel = flowtexKernel(side);
  float angle = FLOWTEX_PI / float(count + 1);
  vec2 turn = vec2(cos(angle), sin(angle));
  vec2 turned = turn; // cosine and sine of pi * t, turned on from sample to sample
  float previous = kernel.x + kernel.y;
  flowtexLeaveFragment();
  int k = 1;
  for (int segment = 1; k <= count; ++segment)
  {
    bool final = segment >= u_lagCount;
    vec3 bend = (after - before) / (to - from);
    for (; k <= count && (final || lag <= to); ++k)
    {
      float alive = clamp((last - lag) * rate + 1.0, 0.0, 1.0);
      vec3 slope = before + bend * (lag - from);
      vec3 displacement = slope * (lag * side * scale);
      if (inCell)
        flowtexGoOn(side * spacing, displacement, alive);
      if (alive <= 0.0)
        return;
      float weight = alive * dot(kernel, vec3(1.0, turned.x, float(k) / float(count + 1)));
      flowtexAdd(sums, displacement, side * lag * scale, weight, previous);
      previous = weight;
      turned = vec2(turned.x * turn.x - turned.y * turn.y, turned.y * turn.x + turned.x * turn.y);
#ifndef FLOWTEX_PAPER
      // Points stay evenly spaced along the path where the particle is faster or slower there
      // than it is here: equation 3 at every point of the path, with the derivative of lag * slope.
      rate = per_speed * max(length(slope + bend * lag), FLOWTEX_LEAST_SPEED);
#endif
      lag += 1.0 / rate;
    }
    if (final)
      return;
    before = after;
    after = flowtexLayer(coordinate, first + segment + 1, level).xyz;
    from = to;
    to = u_lags[segment];
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
#ifdef FLOWTEX_MOVING
  flowtexMove(speed, flowtexLayer(coordinate, 2, sliceLevel).w);
#endif
  vec3 kernel = flowtexKernel(-1.0);
  flowtexAdd(sums, vec3(0.0), 0.0, max(kernel.x + kernel.y, FLOWTEX_LEAST_WEIGHT), 0.0);
  if (speed > FLOWTEX_LEAST_SPEED)
  {
#ifdef FLOWTEX_PAPER
    float scale = 1.0;
    spacing *= speed;
#else
    float scale = base.w * u_unit;
#endif
    int count = u_sides == 2 ? u_samples / 2 : u_samples - 1;
    int inCell = flowtexEnterCell(coordinate, float(count) * spacing) ? count : 0;
    flowtexSide(sums, coordinate, sliceLevel, base.xyz, back.xyz, 0, -1.0, spacing, back.w, scale,
                count - inCell, false);
    flowtexSide(sums, coordinate, sliceLevel, base.xyz, back.xyz, 0, -1.0, spacing, back.w, scale,
                inCell, true);
    if (u_sides == 2)
    {
      vec4 ahead = flowtexLayer(coordinate, u_lagCount + 1, sliceLevel);
      flowtexSide(sums, coordinate, sliceLevel, base.xyz, ahead.xyz, u_lagCount, 1.0, spacing,
                  ahead.w, scale, count - inCell, false);
      flowtexSide(sums, coordinate, sliceLevel, base.xyz, ahead.xyz, u_lagCount, 1.0, spacing,
                  ahead.w, scale, inCell, true);
    }
  }
  return flowtexBlend(sums.noise * inversesqrt(sums.squares), sums.neighbours / sums.squares);
}
