    flowtexPositionGSOutput = flowtexPositionVSOutput[i];
    flowtexCoordinateGSOutput = flowtexCoordinateVSOutput[i];
#ifndef FLOWTEX_PLANAR
    flowtexNormalGSOutput = flowtexNormalVSOutput[i];
#endif
#ifdef FLOWTEX_TRIANGLES
    flowtexCornersGSOutput = flowtexCornersVSOutput[i];
#endif
#ifdef FLOWTEX_PAPER
    flowtexNoiseGSOutput = flowtexNoiseVSOutput[i];
#endif
