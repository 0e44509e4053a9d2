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
// itself, over all directions, is a bell. For two kinds of grains.
//
// So it is the sum of exp(-decay m^2 - bend m^4) over all whole numbers m. Where many samples share a grain this
// is the integral (a series in bend / decay^2, to one part in 1000), and otherwise the next samples do alone.
vec2 flowtexShared(vec2 apart, float near)
{
  vec2 square = apart * apart;
  vec2 decay = FLOWTEX_BELL * square - log(max(near, FLOWTEX_LEAST_SQUARE));
  vec2 bend = FLOWTEX_BELL_BEND * square * square;
  vec2 bent = bend / (decay * decay);
  vec2 many = sqrt(FLOWTEX_PI / (decay * (1.0 + bent * (FLOWTEX_BENT - FLOWTEX_BENT_TWICE * bent))));
  vec2 few = 1.0 + 2.0 * exp(-decay - bend);
  return max(many, few);
}

// A vector of length 1 with the direction of another, or none.
vec3 flowtexUnit(vec3 vector)
{
  return vector * inversesqrt(max(dot(vector, vector), FLOWTEX_LEAST_SQUARE));
}

// Footprint of a pixel: the longest and the shortest side of what it covers, by derivatives on the screen.
vec2 flowtexFootprint(vec3 dx, vec3 dy)
{
  // In their own size, so that no power is too small or too large for single precision.
  vec3 most = max(abs(dx), abs(dy));
  float size = max(max(most.x, most.y), max(most.z, FLOWTEX_LEAST_SQUARE));
  dx /= size;
  dy /= size;
  float half_ = 0.5 * (dot(dx, dx) + dot(dy, dy));
  vec3 across = cross(dx, dy);
  float square = dot(across, across);
  float longest = sqrt(max(half_ + sqrt(max(half_ * half_ - square, 0.0)), FLOWTEX_LEAST_SQUARE));
  return size * vec2(longest, sqrt(square) / longest);
}

#ifdef FLOWTEX_SPARSE
float flowtexParting = 0.0; // how paths part, from 0 to 1 where they begin

// Direction of the flow beside a fragment, by so much in its coordinate.
vec3 flowtexWay(vec2 coordinate, vec2 to, float level, bool inCell)
{
  vec3 way = flowtexUnit(flowtexLayer(coordinate + to, 0, level).xyz);
#ifdef FLOWTEX_CELLS
#ifndef FLOWTEX_TRIANGLES
  to *= u_slicesSize;
#endif
  if (inCell)
    way = mix(way, flowtexUnit(flowtexCell.velocity * flowtexFactors(to)), flowtexCell.share);
#endif
  return way;
}

// Share of a path over which it stays with those beside it, half a side's length away.
//
// A grain from which paths part, as in a source, is in all of them: it would be as wide a spot as a
// streak is long. So streaks lie before the grain there. Where paths meet, and before the grain where they
// part, long streaks would be finer than a pixel.
float flowtexTogether(vec2 coordinate, float level, float half_, bool inCell)
{
  vec3 across = flowtexUnit(cross(flowtexCellNormal, flowtexWay(coordinate, vec2(0.0), level, inCell)));
  vec2 to = flowtexBy * (half_ * across);
  vec3 change = flowtexWay(coordinate, to, level, inCell) - flowtexWay(coordinate, -to, level, inCell);
  float sine = 0.5 * dot(across, change);
  float cosine = sqrt(max(1.0 - sine * sine, 0.0));
  flowtexParting = clamp(2.0 * sine, 0.0, 1.0);
  return min(FLOWTEX_TOGETHER * cosine / max(abs(sine), FLOWTEX_LEAST_SPEED), 1.0);
}
#else
const float flowtexParting = 0.0;
#endif

// Weights along a side of the path are x + y * cos(pi * t) + z * t, with t from 0 at the particle to 1
// beyond the last sample. Kernels: 0 Hann, 1 box, 2 ramp, which falls behind the particle.
vec3 flowtexKernel(float side)
{
  if (u_kernel == FLOWTEX_KERNEL_BOX)
    return vec3(1.0, 0.0, 0.0);
  if (u_kernel != FLOWTEX_KERNEL_RAMP)
    return vec3(0.5, 0.5, 0.0);
  if (u_sides == 1)
    return vec3(1.0, 0.0, -1.0);
  return (0.5 + 0.5 * side * flowtexParting) * vec3(1.0, 0.0, -side);
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
#ifdef FLOWTEX_PAINTED
  flowtexGather(displacement, weight);
#else
  sums.noise += weight * flowtexLookup(displacement, length_);
#endif
  sums.squares += weight * weight;
  sums.neighbours += weight * before;
}

// Adds one side of the path, ``count`` points ``spacing`` apart in nominal length, the last one in
// part where that is no whole number. ``after`` is the slope at lag zero, ``layer`` that before the
// side's first slice.
//
// The loop over the segments between two lags is outside, so that no sample fetches anything. Both
// end with their conditions: without a graphics card the body of any other loop is run once more
// for nothing.
void flowtexSide(inout FlowtexSums sums, vec2 coordinate, float level, vec3 after, int layer,
                 float side, float spacing, float scale, float count, bool inCell)
{
  float per_speed = scale / spacing;
  float rate = per_speed * max(length(after), FLOWTEX_LEAST_SPEED); // samples in a unit of lag
  float lag = 1.0 / rate;
  float was = 0.0;  // the lag of the sample before
  float to = 0.0;
  float last = 0.0; // lag at which the path ends
  vec3 kernel = flowtexKernel(side);
  float slant = kernel.z / (count + 1.0);
  // The cosine goes on by its change, and this by a change that is in proportion to the cosine.
  float half_ = sin(0.5 * FLOWTEX_PI / (count + 1.0));
  float turn = 4.0 * half_ * half_;
  float change = -0.5 * turn * kernel.y;
  float cosine = kernel.y + change;
  float line = kernel.x + slant;
  float previous = kernel.x + kernel.y;
  flowtexLeaveFragment();
  int k = 1;
  int slice = 0;
  do
  {
    float from = to;
    vec3 before = after;
    vec4 next = flowtexLayer(coordinate, layer + slice + 1, level);
    if (slice == 0)
      last = min(next.w, u_lags[u_lagCount - 1]);
    after = next.xyz;
    to = u_lags[slice];
    ++slice;
    bool final = slice == u_lagCount;
    vec3 bend = (after - before) / (to - from);
    before -= bend * from;
#ifndef FLOWTEX_IMAGE
    // From a point nearly at rest the path does not jump: it is at least as fast as it will soon be.
    float least = max(sqrt(length(bend) / per_speed), FLOWTEX_LEAST_SPEED);
    if (slice == 1)
    {
      rate = max(rate, per_speed * least);
      lag = 1.0 / rate;
    }
#endif
    do
    {
      if (final || lag <= to)
      {
        float alive = clamp((last - lag) * rate + 1.0, 0.0, 1.0);
        vec3 bent = bend * lag;
        vec3 slope = before + bent;
        vec3 displacement = slope * (lag * side * scale);
        if (inCell)
          flowtexGoOn(side * spacing, displacement, alive);
        float weight = alive * (line + cosine);
        weight *= min(count - float(k) + 1.0, 1.0);
        flowtexAdd(sums, displacement, side * lag * scale, weight, previous);
        previous = weight;
        line += slant;
        change -= turn * cosine;
        cosine += change;
#ifndef FLOWTEX_IMAGE
        // Points stay evenly spaced along the path where the particle is faster or slower there
        // than it is here: equation 3 at every point of the path, with the derivative of
        // lag * slope.
        rate = per_speed * max(length(slope + bent), least);
#endif
        was = lag;
        lag += 1.0 / rate;
        ++k;
      }
    }
    while (float(k) < count + 1.0 && (was < last || inCell) && (final || lag <= to));
  }
  while (float(k) < count + 1.0 && (was < last || inCell));
}

// Adds both sides, or the only one.
void flowtexSides(inout FlowtexSums sums, vec2 coordinate, float level, vec3 slope, float spacing,
                  float scale, float count, bool inCell)
{
  flowtexSide(sums, coordinate, level, slope, 0, -1.0, spacing, scale, count, inCell);
  if (u_sides == 2)
    flowtexSide(sums, coordinate, level, slope, u_lagCount, 1.0, spacing, scale, count, inCell);
}

// Texture of a fragment, of zero mean and about unit variance, and the factor by which it is shown once its
// local mean is subtracted: the contrast that this takes, and less where it fades. ``spacing`` is that of the points
// in nominal length, or in units of lag for an image; ``stretch`` times as many as usual are summed. ``drawn`` is
// the size of a grain in the picture, across the flow and along it, over the usual one.
// ``base`` is layer 0 at the fragment.
vec2 flowtexTexture(vec2 coordinate, float sliceLevel, vec4 base, float spacing, float stretch, vec2 drawn)
{
  FlowtexSums sums = FlowtexSums(vec2(0.0), 0.0, 0.0);
  float speed = length(base.xyz);
#ifndef FLOWTEX_PAINTED
  // Where the flow only crosses the surface, the share by which the texture fades, below zero.
  float shown = flowtexLayer(coordinate, 2, sliceLevel).w;
#endif
#if defined(FLOWTEX_MOVING) && !defined(FLOWTEX_IMAGE)
  flowtexMove(speed, max(shown, 0.0));
#endif
  float count = float(u_sides == 2 ? u_samples / 2 : u_samples - 1) * stretch;
#ifdef FLOWTEX_UNCERTAIN
  float known = flowtexKnown(coordinate, sliceLevel);
  count *= known;
#endif
  bool goes = speed > FLOWTEX_LEAST_SPEED && count > 0.0;
#ifdef FLOWTEX_IMAGE
  float scale = 1.0;
  spacing *= speed;
#else
  float scale = base.w * u_unit;
#endif
  bool inCell = goes && flowtexEnterCell(coordinate, count * spacing);
#if defined(FLOWTEX_SPARSE) && !defined(FLOWTEX_SIGNFREE)
  if (goes)
    count *= flowtexTogether(coordinate, sliceLevel, 0.5 * count * spacing, inCell);
#endif
  vec3 kernel = flowtexKernel(1.0);
  flowtexAdd(sums, vec3(0.0), 0.0, max(kernel.x + kernel.y, FLOWTEX_LEAST_WEIGHT), 0.0);
  if (goes)
  {
    // Apart: what is no loop over paths in a cell costs less.
    if (inCell)
      flowtexSides(sums, coordinate, sliceLevel, base.xyz, spacing, scale, count, true);
    else
      flowtexSides(sums, coordinate, sliceLevel, base.xyz, spacing, scale, count, false);
  }
#ifdef FLOWTEX_PAINTED
  return vec2(0.0); // the colours have been gathered
#else
  float near = sums.neighbours / sums.squares;
  float value = flowtexBlend(sums.noise * inversesqrt(sums.squares), near);
  float share = u_even ? flowtexEvenGain(near, drawn) : 1.0;
#ifdef FLOWTEX_UNCERTAIN
  share *= mix(FLOWTEX_FADED, 1.0, known);
#endif
  share *= step(FLOWTEX_LEAST_SPEED, speed); // a particle at rest has no direction
  share *= clamp(1.0 + shown, 0.0, 1.0);
  if (u_fade > 0.0)
    share *= smoothstep(0.0, u_fade, shown);
  return vec2(value, share);
#endif
}
