#ifndef FLOWTEX_DEFERRED
  flowtexCoordinateVSOutput = flowtexCoordinate;
  flowtexPositionVSOutput = flowtexPosition;
#ifdef FLOWTEX_TRIANGLES
  flowtexCornersVSOutput = flowtexCorners;
#endif
#ifdef FLOWTEX_IMAGE
  flowtexImageVSOutput = flowtexImage;
#endif
#endif
