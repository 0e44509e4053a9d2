//#include vtk/map_vertex_impl.glsl
  vec4 flowtexThere = MCDCMatrix * vec4(flowtexOther, 1.0);
  // What is behind the eye has no place: such a piece ends just before it.
  float flowtexFront = 1e-3 * max(gl_Position.w, flowtexThere.w);
  if (gl_Position.w < flowtexFront)
    gl_Position = mix(gl_Position, flowtexThere, (flowtexFront - gl_Position.w) / (flowtexThere.w - gl_Position.w));
  else if (flowtexThere.w < flowtexFront)
    flowtexThere = mix(flowtexThere, gl_Position, (flowtexFront - flowtexThere.w) / (gl_Position.w - flowtexThere.w));
  vec2 flowtexHalf = 0.5 * flowtexViewport.zw;
  vec2 flowtexFrom = gl_Position.xy / gl_Position.w * flowtexHalf;
  vec2 flowtexTo = flowtexThere.xy / flowtexThere.w * flowtexHalf;
  vec2 flowtexWay = flowtexTo - flowtexFrom;
  // Of a dot the one end does not know where the other is.
  flowtexWay = length(flowtexWay) > 1e-2 ? normalize(flowtexWay) : vec2(abs(flowtexSide) > 1.5 ? -1.0 : 1.0, 0.0);
  vec2 flowtexMiddle = flowtexViewport.xy + flowtexHalf;
  flowtexEndsVSOutput = vec4(flowtexMiddle + flowtexFrom, flowtexMiddle + flowtexTo);
  flowtexRadiusVSOutput = flowtexRadius;
  vec2 flowtexAside = vec2(-flowtexWay.y, flowtexWay.x) * sign(flowtexSide) - flowtexWay;
  gl_Position.xy += flowtexAside * (flowtexRadius + 1.0) / flowtexHalf * gl_Position.w;
