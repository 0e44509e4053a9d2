  flowtexPositionVSOutput = flowtexPosition;
  flowtexCoordinateVSOutput = flowtexCoordinate;
#ifndef FLOWTEX_PLANAR
  flowtexNormalVSOutput = flowtexNormal;
#endif
#ifdef FLOWTEX_TRIANGLES
  flowtexCornersVSOutput = flowtexCorners;
#endif
#ifdef FLOWTEX_PAPER
  flowtexNoiseVSOutput = flowtexNoise;
#endif
