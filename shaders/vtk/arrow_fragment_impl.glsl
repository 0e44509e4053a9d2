  gl_FragData[0] = flowtexArrow(flowtexPlaceVSOutput, flowtexSizeVSOutput, flowtexCoreVSOutput);
