// The noise at a traced point: the paper's mipmapped texture over the parameters of the surface.
//
// The level is the one that mipmapping chooses for the noise at the fragment (section 4), and
// the step is looked up at the same level, where its values count 2^level times (section 4.1).
// Averaging four texels halves the deviation of independent noise, which is made up for, so that
// the contrast does not change with the level.

vec2 flowtexHere; // noise coordinate of the fragment

float flowtexLookup(vec3 displacement, float length_, float level)
{
  vec2 at = flowtexHere + displacement.xy * u_noiseScale;
  return textureLod(u_noiseImage, at, level).r * exp2(level);
}

// Texture at a noise coordinate with its derivatives.
float flowtexFragment(vec2 coordinate, vec2 noise, vec2 dx, vec2 dy, float sliceLevel)
{
  vec2 sx = dx * u_noiseSize;
  vec2 sy = dy * u_noiseSize;
  float texels = max(dot(sx, sx), dot(sy, sy));
  float level = u_lod ? max(0.5 * log2(max(texels, 1e-20)), 0.0) : 0.0;
  flowtexHere = noise;
  float step_ = textureLod(u_stepImage, noise, level).r * exp2(level) * u_spacing;
  return flowtexTexture(coordinate, sliceLevel, level, step_);
}
