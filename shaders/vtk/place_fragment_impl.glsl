#ifdef FLOWTEX_TRIANGLES
  gl_FragData[0] = vec4(flowtexCoordinateVSOutput, flowtexTriangleVSOutput, u_layer);
#else
  gl_FragData[0] = vec4(flowtexCoordinateVSOutput, 0.0, u_layer);
#endif
