#ifdef FLOWTEX_TRIANGLES
  flowtexSetCorners(flowtexCornersVSOutput.xyz);
  flowtexTriangleNumber = int(flowtexCornersVSOutput.w);
#endif
  flowtexPlaced = flowtexCoordinateVSOutput;
#if defined(FLOWTEX_PAPER)
  float flowtexTextured = flowtexValue(flowtexPlaced, flowtexNoiseVSOutput);
#elif defined(FLOWTEX_PLANAR)
  float flowtexTextured = flowtexValue(flowtexPlaced, flowtexPositionVSOutput, vec3(0.0, 0.0, 1.0));
#else
  float flowtexTextured = flowtexValue(flowtexPlaced, flowtexPositionVSOutput, flowtexNormalVSOutput);
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
