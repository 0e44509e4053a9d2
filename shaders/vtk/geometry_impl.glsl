#if defined(FLOWTEX_PROJECTED)
    flowtexPixelGSOutput = flowtexPixelVSOutput[i];
#elif !defined(FLOWTEX_DEFERRED)
    flowtexPositionGSOutput = flowtexPositionVSOutput[i];
    flowtexCoordinateGSOutput = flowtexCoordinateVSOutput[i];
#ifdef FLOWTEX_TRIANGLES
    flowtexCornersGSOutput = flowtexCornersVSOutput[i];
#endif
#ifdef FLOWTEX_IMAGE
    flowtexImageGSOutput = flowtexImageVSOutput[i];
#endif
#endif
