    flowtexPositionGSOutput = flowtexPositionVSOutput[i];
    flowtexCoordinateGSOutput = flowtexCoordinateVSOutput[i];
#ifdef FLOWTEX_PAPER
    flowtexNoiseGSOutput = flowtexNoiseVSOutput[i];
#endif
