  flowtexCoordinateVSOutput = flowtexCoordinate;
#ifndef FLOWTEX_DEFERRED
  flowtexPositionVSOutput = flowtexPosition;
#endif
#ifdef FLOWTEX_TRIANGLES
  flowtexCornersVSOutput = flowtexCorners;
#endif
#ifdef FLOWTEX_PAPER
  flowtexNoiseVSOutput = flowtexNoise;
#endif
