// The noise at a traced point: the paper's mipmapped texture over the parameters of the surface.
//
// The level is the one that mipmapping chooses for the noise at the fragment (section 4), and
// the step is looked up at the same level, where its values count 2^level times (section 4.1).
// Averaging n independent grains divides their deviation by sqrt(n), which is made up for, so
// that the contrast does not change with the level. Corrected noise has grains as long as the
// longer side of a texel, so that along the shorter side fewer of them make the average, and the
// level can be finer than the longest side of the footprint asks for.

vec2 flowtexHere; // noise coordinate of the fragment
float flowtexMip; // level
float flowtexGain;

vec2 flowtexLookup(vec3 displacement, float length_)
{
  vec2 at = flowtexHere + displacement.xy;
  return vec2(textureLod(u_noiseImage, at, flowtexMip).r * flowtexGain, 0.0);
}

float flowtexBlend(vec2 sums)
{
  return sums.x * inversesqrt(flowtexShared(vec2(u_spacing)).x);
}

// Texture at a noise coordinate with its derivatives.
float flowtexFragment(vec2 coordinate, vec2 noise, vec2 dx, vec2 dy, float sliceLevel)
{
  vec2 sx = dx * u_noiseSize;
  vec2 sy = dy * u_noiseSize;
  float determinant = sx.x * sy.y - sx.y * sy.x;
  vec2 footprint = flowtexFootprint(dot(sx, sx), dot(sy, sy), determinant);
  float texels = u_noiseCorrected ? sqrt(footprint.x * footprint.y) : footprint.x;
  flowtexMip = u_lod ? max(log2(max(texels, 1e-6)), 0.0) : 0.0;
  float width = exp2(flowtexMip);
  float across = u_noiseCorrected ? max(width * footprint.y / footprint.x, 1.0) : width;
  flowtexGain = sqrt(width * across);
  flowtexHere = noise;
  float step_ = textureLod(u_stepImage, noise, flowtexMip).r * width;
  return flowtexTexture(coordinate, sliceLevel, step_ * u_spacing);
}
