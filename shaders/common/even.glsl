// Even streaks: a texture without its low frequencies.
//
// Noise that is averaged along paths keeps its low frequencies across the flow, and a picture of it looks
// cloudy. So the local mean of the texture is subtracted from it, over a bell whose deviation is
// FLOWTEX_EVEN_SIGMA grains. It is computed in four steps: means of square blocks of pixels, a blur of these
// along the rows and one along the columns, and the linear interpolation of them at each pixel. The blur
// brings the three to the variance of the bell (flowtex/rendering/even.py).
//
// Pixels off the surface count as zero, the mean of the texture. So the mean gets less towards a border, and
// what is left has about the same deviation there as elsewhere: a mean over the surface alone would take away
// more of it.

#ifdef FLOWTEX_EVEN_BLOCKS
uniform highp sampler2D u_texture; // texture of each pixel of the surface, zero beside it
uniform ivec2 u_first;             // lower left pixel of the first block,
uniform ivec2 u_end;               // and those that follow the upper right of all
uniform int u_side;                // of a block, in pixels

// Mean of the texture in the block of a texel. Before and after those of the surface there is one more.
float flowtexBlock(ivec2 texel)
{
  ivec2 low = max(u_first + (texel - 1) * u_side, u_first);
  ivec2 high = min(u_first + texel * u_side, u_end);
  float sum = 0.0;
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x)
      sum += texelFetch(u_texture, ivec2(x, y), 0).r;
  return sum / float(u_side * u_side);
}
#endif

#ifdef FLOWTEX_EVEN_BLUR
uniform highp sampler2D u_means; // of the blocks
uniform ivec2 u_blocks;          // their columns and rows
uniform ivec2 u_along;           // from one to the next, in columns and rows
uniform int u_reach;             // blocks on each side
uniform float u_variance;        // of the bell, in blocks

// Mean of the means along a row or a column.
float flowtexBlurred(ivec2 texel)
{
  float sum = 0.0;
  float weights = 0.0;
  for (int n = -u_reach; n <= u_reach; ++n)
  {
    float weight = exp(-0.5 * float(n * n) / u_variance);
    ivec2 at = texel + n * u_along;
    weights += weight;
    if (at == clamp(at, ivec2(0), u_blocks - 1))
      sum += weight * texelFetch(u_means, at, 0).r;
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
