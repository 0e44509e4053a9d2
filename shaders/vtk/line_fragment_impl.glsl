  // Smooth by the distance in pixels to the nearest point of the piece.
  vec2 flowtexAlong = flowtexEndsVSOutput.zw - flowtexEndsVSOutput.xy;
  vec2 flowtexFrom = gl_FragCoord.xy - flowtexEndsVSOutput.xy;
  float flowtexShare = clamp(dot(flowtexFrom, flowtexAlong) / max(dot(flowtexAlong, flowtexAlong), 1e-6), 0.0, 1.0);
  float flowtexDistance = length(flowtexFrom - flowtexShare * flowtexAlong);
#ifdef FLOWTEX_OPAQUE
  // What is hardly seen beyond an end must not hide the next piece.
  if (dot(flowtexAlong, flowtexAlong) > 1e-6 && (flowtexShare <= 0.0 || flowtexShare >= 1.0) && flowtexDistance > flowtexRadiusVSOutput - 0.5)
    discard;
  if (flowtexDistance > flowtexRadiusVSOutput + 0.5)
    discard;
#endif
  gl_FragData[0].a *= clamp(flowtexRadiusVSOutput + 0.5 - flowtexDistance, 0.0, 1.0);
