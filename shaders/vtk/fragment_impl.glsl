  // Derivatives first: they are not defined behind a branch.
  vec2 flowtexSliceDx = dFdx(flowtexCoordinateVSOutput);
  vec2 flowtexSliceDy = dFdy(flowtexCoordinateVSOutput);
  float flowtexLevel = flowtexSliceLevel(flowtexSliceDx, flowtexSliceDy);
#ifdef FLOWTEX_PAPER
  float flowtexValue = flowtexFragment(flowtexCoordinateVSOutput, flowtexNoiseVSOutput, dFdx(flowtexNoiseVSOutput),
                                       dFdy(flowtexNoiseVSOutput), flowtexLevel);
#else
  float flowtexValue = flowtexFragment(flowtexPositionVSOutput, dFdx(flowtexPositionVSOutput),
                                       dFdy(flowtexPositionVSOutput), flowtexCoordinateVSOutput, flowtexLevel);
#endif
  // VTK has set ambientColor and diffuseColor from the property or the scalars by now, and
  // lights them next.
  ambientColor = flowtexShade(ambientColor, flowtexValue);
  diffuseColor = flowtexShade(diffuseColor, flowtexValue);
