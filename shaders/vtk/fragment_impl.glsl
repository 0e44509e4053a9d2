#ifdef FLOWTEX_TRIANGLES
  flowtexSetCorners(flowtexCornersVSOutput.xyz);
  flowtexTriangleNumber = int(flowtexCornersVSOutput.w);
#endif
  flowtexPlaced = flowtexCoordinateVSOutput;
#if defined(FLOWTEX_DEFERRED)
  vec4 flowtexSum = texelFetch(u_sums, ivec2(gl_FragCoord.xy), 0);
  float flowtexTextured = flowtexSum.r;
#ifndef FLOWTEX_TRIANGLES
  // At an outline the pixel may belong to another part of the surface.
  if (all(lessThan(abs(flowtexSum.ba - flowtexPlaced) * u_slicesSize, vec2(FLOWTEX_PLACE_FAR))))
    flowtexPlaced = flowtexSum.ba;
#endif
  float flowtexNoiseLevel = flowtexSum.g;
#elif defined(FLOWTEX_PAPER)
  float flowtexTextured = flowtexValue(flowtexPlaced, flowtexNoiseVSOutput);
#else
  float flowtexTextured = flowtexValue(flowtexPlaced, flowtexPositionVSOutput);
#endif
  // VTK has set ambientColor and diffuseColor from the property or the scalars by now, each times
  // its share of the light, and lights them next.
  vec3 flowtexColour = (ambientColor + diffuseColor) / max(ambientIntensity + diffuseIntensity, FLOWTEX_LEAST_LIGHTNESS);
  if (u_mapped)
    flowtexColour = flowtexMapped(flowtexPlaced);
  if (u_plain)
    flowtexColour = u_plainColour;
  if (u_showLevel)
    flowtexColour = flowtexLevelColour(flowtexNoiseLevel);
#ifdef FLOWTEX_PICTURE
  flowtexColour = flowtexPaint(flowtexColour);
#else
  flowtexColour = flowtexShade(flowtexColour, flowtexTextured);
#endif
  ambientColor = ambientIntensity * flowtexColour;
  diffuseColor = diffuseIntensity * flowtexColour;
