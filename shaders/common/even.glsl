// Even streaks: a texture without its low frequencies.
//
// Noise that is averaged along paths keeps its low frequencies across the flow, and a picture of it looks
// cloudy. So the local mean of the texture is subtracted from it, over a bell whose deviation is
// FLOWTEX_EVEN_SIGMA grains. It is computed in three steps: means around the middles of blocks of pixels along
// the rows, means of these along the columns, and their linear interpolation at each pixel, which all
// together have the variance of the bell (flowtex/rendering/even.py).
//
// Pixels off the surface count as zero, the mean of the texture. So the mean gets less towards a border, and
// what is left has about the same deviation there as elsewhere: a mean over the surface alone would take away
// more of it.

#ifdef FLOWTEX_EVEN_BLUR
uniform highp sampler2D u_source; // texture of each pixel of the surface, zero beside it, or means along rows
uniform ivec2 u_from;             // its texel at the lower left of the first block
uniform ivec2 u_along;            // from one texel to the next: to the right, or upwards
uniform int u_count;              // of texels in this direction,
uniform int u_side;               // of those in a block,
uniform float u_reach;            // and of those on each side of the middle of the bell
uniform float u_variance;         // of the bell

// Mean around the middle of a block, along rows or columns. Before the first block there is one more.
float flowtexBlurred(ivec2 texel)
{
  ivec2 aside = u_from + texel * (1 - u_along);
  int block = texel.x * u_along.x + texel.y * u_along.y;
  float middle = (float(block) - 0.5) * float(u_side) - 0.5;
  int first = int(ceil(middle - u_reach));
  int last = int(floor(middle + u_reach));
  // A weight of the bell is the one before times a ratio, which has a constant ratio itself.
  float away = float(first) - middle;
  float weight = exp(-0.5 * away * away / u_variance);
  float ratio = exp(-(away + 0.5) / u_variance);
  float bend = exp(-1.0 / u_variance);
  float sum = 0.0;
  float weights = 0.0;
  for (int n = first; n <= last; ++n)
  {
    weights += weight;
    if (n >= 0 && n < u_count)
      sum += weight * texelFetch(u_source, aside + n * u_along, 0).r;
    weight *= ratio;
    ratio *= bend;
  }
  return sum / weights;
}
#endif

#ifdef FLOWTEX_EVEN_LAID
uniform highp sampler2D u_means; // of the blocks, blurred
uniform ivec2 u_first;
uniform int u_side;

// Mean of the texture around a pixel.
float flowtexMeanAround(ivec2 pixel)
{
  vec2 at = (vec2(pixel - u_first) + 0.5) / float(u_side) + 0.5;
  ivec2 texel = ivec2(at);
  vec2 part = at - vec2(texel);
  vec2 low = vec2(texelFetch(u_means, texel, 0).r, texelFetch(u_means, texel + ivec2(0, 1), 0).r);
  vec2 high = vec2(texelFetch(u_means, texel + ivec2(1, 0), 0).r, texelFetch(u_means, texel + 1, 0).r);
  vec2 rows = mix(low, high, part.x);
  return mix(rows.x, rows.y, part.y);
}
#endif
