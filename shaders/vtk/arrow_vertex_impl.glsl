#ifdef FLOWTEX_TRIANGLES
  flowtexSetCorners(flowtexCorners.xyz);
  flowtexTriangleNumber = int(flowtexCorners.w);
#endif
#ifdef FLOWTEX_PLANAR
  const vec3 flowtexNormal = vec3(0.0, 0.0, 1.0);
#endif
  FlowtexStroke flowtexVertex = flowtexStroke(MCDCMatrix, vertexMC.xyz, flowtexNormal, flowtexCoordinate,
                                              flowtexRadius, int(flowtexRibbon.x), flowtexRibbon.y);
  gl_Position = flowtexVertex.position;
  flowtexPlaceVSOutput = flowtexVertex.place;
  flowtexSizeVSOutput = flowtexVertex.size;
  flowtexCoreVSOutput = u_plain ? vec4(flowtexMapped(flowtexCoordinate), 1.0) : vec4(0.0);
