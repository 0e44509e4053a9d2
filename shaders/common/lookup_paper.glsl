// The noise at a traced point: the paper's mipmapped texture over the parameters of the surface.
//
// The level is the one that mipmapping chooses for the noise at the fragment (section 4), and
// the step is looked up at the same level, where its values count 2^level times (section 4.1).
// What averaging takes of the contrast is known and made up for (flowtex/textures/paper.py).
// Corrected noise has grains as long as the longer side of a texel, so the level can be finer than
// the longest side of the footprint asks for.

vec2 flowtexHere; // noise coordinate of the fragment
float flowtexMip; // level
float flowtexGain;
float flowtexGrains; // grains that a texel of the level is long
float flowtexNoiseLevel;

// Deviation of the noise at a level.
float flowtexDeviation(float level)
{
  float at = clamp(2.0 * level, 0.0, FLOWTEX_LAST_HALF_LEVEL);
  int n = int(at);
  return mix(u_noiseDeviation[n], u_noiseDeviation[n + 1], at - float(n));
}

vec2 flowtexLookup(vec3 displacement, float length_)
{
  vec2 at = flowtexHere + displacement.xy;
  return vec2(textureLod(u_noiseImage, vec3(at, 0.0), flowtexMip).r * flowtexGain, 0.0);
}

float flowtexBlend(vec2 sums, float near)
{
  return sums.x * inversesqrt(flowtexShared(vec2(u_spacing * flowtexGrains), near).x);
}

// The noise of a texture stands.
void flowtexMove(float slope, float speed)
{
}

#ifdef FLOWTEX_PICTURE
// A picture in place of the noise: the mean of its colours along the path. Its contrast is its own.

float flowtexPictureMip; // level of the picture, whose texels are not those of the noise
vec2 flowtexInset;       // half a texel of that level
vec4 flowtexSeen;        // sums of the weighted colours, times opacity, and of the weights
float flowtexWeights;

void flowtexGather(vec3 displacement, float weight)
{
  vec2 at = flowtexHere + displacement.xy;
  // Beyond its edge the picture is repeated, which must not be seen where the surface ends.
  at = mix(clamp(at, flowtexInset, 1.0 - flowtexInset), at, u_pictureRound);
  vec4 seen = textureLod(u_noiseImage, vec3(at * u_tiles, 0.0), flowtexPictureMip);
  flowtexSeen += weight * (u_pictureGrey ? vec4(seen.rrr, 1.0) : seen);
  flowtexWeights += weight;
}

// Chooses the level, and returns the width of a step in texels of the step texture: those of the
// noise's level, but no wider than a texel of the picture, of which none must be passed over.
float flowtexFrame(vec2 dx, vec2 dy, float texels)
{
  vec2 footprint = flowtexFootprint(vec3(dx * u_pictureSize, 0.0), vec3(dy * u_pictureSize, 0.0));
  float covered = u_noiseCorrected ? sqrt(footprint.x * footprint.y) : footprint.x;
  flowtexPictureMip = u_lod ? max(log2(max(covered, FLOWTEX_LEAST_TEXELS)), 0.0) : 0.0;
  flowtexNoiseLevel = flowtexPictureMip;
  flowtexInset = min(0.5 * exp2(ceil(flowtexPictureMip)) / u_pictureSize, 0.5);
  flowtexSeen = vec4(0.0);
  flowtexWeights = 0.0;
  vec2 texel = u_noiseSize / u_pictureSize;
  float least = min(min(texel.x, texel.y), 1.0);
  return u_lod ? max(texels, least) : least;
}

// Colour with the picture laid over it.
vec3 flowtexPaint(vec3 colour)
{
  vec4 mean = flowtexSeen / flowtexWeights;
  float strength = u_showLevel ? FLOWTEX_LEVEL_STRENGTH * u_strength : u_strength;
  return colour * (1.0 - strength * mean.a) + strength * mean.rgb;
}
#endif

// Texture at a noise coordinate with its derivatives.
float flowtexFragment(vec2 coordinate, vec2 noise, vec2 dx, vec2 dy, float sliceLevel)
{
  vec2 footprint = flowtexFootprint(vec3(dx * u_noiseSize, 0.0), vec3(dy * u_noiseSize, 0.0));
  float texels = u_noiseCorrected ? sqrt(footprint.x * footprint.y) : footprint.x;
  flowtexMip = u_lod ? max(log2(max(texels, FLOWTEX_LEAST_TEXELS)), 0.0) : 0.0;
  flowtexNoiseLevel = flowtexMip;
  float width = exp2(flowtexMip);
  flowtexGain = 1.0 / flowtexDeviation(flowtexMip);
  flowtexGrains = width * inversesqrt(u_noiseGrain * u_noiseGrain + width * width - 1.0);
  flowtexHere = noise;
#ifdef FLOWTEX_PICTURE
  width = flowtexFrame(dx, dy, texels);
#endif
  float step_ = textureLod(u_stepImage, vec3(noise, 0.0), flowtexMip).r * width;
  return flowtexTexture(coordinate, sliceLevel, step_ * u_spacing);
}
