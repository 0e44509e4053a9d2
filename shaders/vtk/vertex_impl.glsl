#ifndef FLOWTEX_DEFERRED
  flowtexCoordinateVSOutput = flowtexCoordinate;
  flowtexPositionVSOutput = flowtexPosition;
#ifdef FLOWTEX_TRIANGLES
  flowtexCornersVSOutput = flowtexCorners;
#endif
#ifdef FLOWTEX_PAPER
  flowtexNoiseVSOutput = flowtexNoise;
#endif
#endif
