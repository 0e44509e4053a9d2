  flowtexPositionVS = flowtexPosition;
  flowtexCoordinateVS = flowtexCoordinate;
#ifdef FLOWTEX_PAPER
  flowtexNoiseVS = flowtexNoise;
#endif
