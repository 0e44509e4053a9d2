  gl_FragData[0] = flowtexArrow(flowtexPlaceVSOutput, flowtexShapeVSOutput.x, flowtexShapeVSOutput.y, flowtexCoreVSOutput);
