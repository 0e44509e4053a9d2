#if defined(FLOWTEX_PROJECTED)
  flowtexPixelVSOutput = (u_toPixels * vec4(flowtexPosition, 1.0)).xyw;
#elif !defined(FLOWTEX_DEFERRED)
  flowtexCoordinateVSOutput = flowtexCoordinate;
  flowtexPositionVSOutput = flowtexPosition;
#ifdef FLOWTEX_TRIANGLES
  flowtexCornersVSOutput = flowtexCorners;
#endif
#ifdef FLOWTEX_IMAGE
  flowtexImageVSOutput = flowtexImage;
#endif
#endif
