  // Derivatives first: they are not defined behind a branch.
  vec2 flowtexSliceDx = dFdx(flowtexCoordinateVS);
  vec2 flowtexSliceDy = dFdy(flowtexCoordinateVS);
  float flowtexLevel = flowtexSliceLevel(flowtexSliceDx, flowtexSliceDy);
#ifdef FLOWTEX_PAPER
  float flowtexValue = flowtexFragment(flowtexCoordinateVS, flowtexNoiseVS, dFdx(flowtexNoiseVS),
                                       dFdy(flowtexNoiseVS), flowtexLevel);
#else
  float flowtexValue = flowtexFragment(flowtexPositionVS, dFdx(flowtexPositionVS),
                                       dFdy(flowtexPositionVS), flowtexCoordinateVS, flowtexLevel);
#endif
  // VTK has set ambientColor and diffuseColor from the property or the scalars by now, and
  // lights them next.
  ambientColor = flowtexShade(ambientColor, flowtexValue);
  diffuseColor = flowtexShade(diffuseColor, flowtexValue);
