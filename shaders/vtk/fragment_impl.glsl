  // VTK has set ambientColor and diffuseColor from the property or the scalars by now, each times
  // its share of the light, and lights them next.
  vec3 flowtexColour = (ambientColor + diffuseColor) / max(ambientIntensity + diffuseIntensity, FLOWTEX_LEAST_LIGHTNESS);
#ifdef FLOWTEX_DEFERRED
  vec4 flowtexSum = texelFetch(u_sums, ivec2(gl_FragCoord.xy), 0);
#ifdef FLOWTEX_OWN
  flowtexColour = u_showLevel ? flowtexSum.rgb : flowtexShade(flowtexColour, flowtexSum.a);
#else
  flowtexColour = flowtexSum.rgb;
#endif
#else
#ifdef FLOWTEX_TRIANGLES
  flowtexSetCorners(flowtexCornersVSOutput.xyz);
  flowtexTriangleNumber = int(flowtexCornersVSOutput.w);
#endif
  vec2 flowtexPlaced = flowtexCoordinateVSOutput;
#ifdef FLOWTEX_IMAGE
  float flowtexTextured = flowtexValue(flowtexPlaced, flowtexImageVSOutput);
#else
  float flowtexTextured = flowtexValue(flowtexPlaced, flowtexPositionVSOutput);
#endif
  flowtexColour = flowtexColoured(flowtexColour, flowtexPlaced, flowtexTextured);
#endif
  ambientColor = ambientIntensity * flowtexColour;
  diffuseColor = diffuseIntensity * flowtexColour;
