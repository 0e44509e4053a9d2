// Derivatives on the screen, exact for each fragment.
//
// A varying v changes as a quotient under perspective: v / w and 1 / w are linear on the screen,
// and differences of what is linear are exact, while plain differences of v belong to the middle
// between two pixels, and show as steps of two lines where a surface is seen at a grazing angle.

vec2 flowtexDx(vec2 v)
{
  return (dFdx(v * gl_FragCoord.w) - v * dFdx(gl_FragCoord.w)) / gl_FragCoord.w;
}

vec2 flowtexDy(vec2 v)
{
  return (dFdy(v * gl_FragCoord.w) - v * dFdy(gl_FragCoord.w)) / gl_FragCoord.w;
}

vec3 flowtexDx(vec3 v)
{
  return (dFdx(v * gl_FragCoord.w) - v * dFdx(gl_FragCoord.w)) / gl_FragCoord.w;
}

vec3 flowtexDy(vec3 v)
{
  return (dFdy(v * gl_FragCoord.w) - v * dFdy(gl_FragCoord.w)) / gl_FragCoord.w;
}
