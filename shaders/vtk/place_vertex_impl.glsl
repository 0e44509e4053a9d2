  flowtexCoordinateVSOutput = flowtexCoordinate;
#ifdef FLOWTEX_TRIANGLES
  flowtexTriangleVSOutput = flowtexCorners.w;
#endif
