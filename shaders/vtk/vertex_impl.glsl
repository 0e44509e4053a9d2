  flowtexPositionVSOutput = flowtexPosition;
  flowtexCoordinateVSOutput = flowtexCoordinate;
#ifdef FLOWTEX_PAPER
  flowtexNoiseVSOutput = flowtexNoise;
#endif
