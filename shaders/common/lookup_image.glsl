// An image in place of the noise: the mean of its colours along the path. Its contrast is its own.
//
// The step is looked up at the level that mipmapping chooses for its texture, where its values count
// 2^level times. It is no wider than a texel of the image, so that no texel is skipped.

vec2 flowtexHere;        // image coordinate of the fragment
float flowtexNoiseLevel; // level of the image
vec2 flowtexInset;       // half a texel of that level
vec4 flowtexSeen;        // sums of the weighted colours, times opacity, and of the weights
float flowtexWeights;

void flowtexGather(vec3 displacement, float weight)
{
  vec2 at = flowtexHere + displacement.xy;
  // The repetition beyond the image's edge must not be visible where the surface ends.
  at = mix(clamp(at, flowtexInset, 1.0 - flowtexInset), at, u_imageRound);
  flowtexSeen += weight * textureLod(u_image, vec3(at * u_tiles, 0.0), flowtexNoiseLevel);
  flowtexWeights += weight;
}

// Colour with the image laid over it.
vec3 flowtexPaint(vec3 colour)
{
  vec4 mean = flowtexSeen / flowtexWeights;
  float strength = u_showLevel ? FLOWTEX_LEVEL_STRENGTH * u_strength : u_strength;
  return colour * (1.0 - strength * mean.a) + strength * mean.rgb;
}

// Sums the image at an image coordinate with its derivatives.
vec2 flowtexFragment(vec2 coordinate, vec2 at, vec2 dx, vec2 dy, float sliceLevel)
{
  flowtexHere = at;
  flowtexNoiseLevel = flowtexMip(flowtexCovered(dx, dy, u_imageSize));
  flowtexInset = min(0.5 * exp2(ceil(flowtexNoiseLevel)) / u_imageSize, 0.5);
  flowtexSeen = vec4(0.0);
  flowtexWeights = 0.0;
  vec2 texel = u_stepSize / u_imageSize;
  float least = min(min(texel.x, texel.y), 1.0);
  float texels = flowtexCovered(dx, dy, u_stepSize);
  float width = u_lod ? max(texels, least) : least;
  float step_ = textureLod(u_stepImage, vec3(at, 0.0), flowtexMip(texels)).r * width;
  vec4 base = flowtexLayer(coordinate, 0, sliceLevel);
  return flowtexTexture(coordinate, sliceLevel, base, step_ * u_spacing, 1.0, vec2(1.0));
}
