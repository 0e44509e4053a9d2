// The deviation that a texture keeps when its local mean is subtracted (even.glsl).

// Factor that brings the texture back to the deviation 1, from what is known of its correlation, a bell along
// the streak and one across it: ``near`` is the correlation of the weights of neighbouring samples, and
// ``drawn`` the size of a grain in the picture, across the streak and along it, over the usual one.
float flowtexEvenGain(float near, vec2 drawn)
{
  float samples = -0.5 / log(clamp(near, FLOWTEX_LEAST_NEAR, FLOWTEX_MOST_NEAR));
  float grain = 0.5 / FLOWTEX_BELL;
  vec2 variance = vec2(grain, grain + u_spacing * u_spacing * samples) * drawn * drawn;
  const float bell = FLOWTEX_EVEN_SIGMA * FLOWTEX_EVEN_SIGMA;
  vec2 once = variance / (variance + bell);
  vec2 twice = variance / (variance + 2.0 * bell);
  return inversesqrt(1.0 - 2.0 * sqrt(once.x * once.y) + sqrt(twice.x * twice.y));
}
