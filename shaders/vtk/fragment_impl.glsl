  // VTK has set ambientColor and diffuseColor from the property or the scalars by now, each times
  // its share of the light, and lights them next.
  vec3 flowtexColour = (ambientColor + diffuseColor) / max(ambientIntensity + diffuseIntensity, FLOWTEX_LEAST_LIGHTNESS);
#ifdef FLOWTEX_DEFERRED
#ifdef FLOWTEX_PROJECTED
  ivec2 flowtexPixel = ivec2(floor(flowtexPixelVSOutput.xy / flowtexPixelVSOutput.z));
#else
  ivec2 flowtexPixel = ivec2(gl_FragCoord.xy) + u_margin;
#endif
  vec4 flowtexShown = texelFetch(u_shown, flowtexPixel, 0);
#ifdef FLOWTEX_OWN
  if (!u_showLevel)
    flowtexShown.rgb = flowtexShade(flowtexColour, flowtexShown.a);
#endif
  flowtexColour = flowtexShown.rgb;
#else
#ifdef FLOWTEX_TRIANGLES
  flowtexSetCorners(flowtexCornersVSOutput.xyz);
  flowtexTriangleNumber = int(flowtexCornersVSOutput.w);
#endif
  vec2 flowtexPlaced = flowtexCoordinateVSOutput;
#ifdef FLOWTEX_IMAGE
  vec2 flowtexTextured = flowtexValue(flowtexPlaced, flowtexImageVSOutput);
#else
  vec2 flowtexTextured = flowtexValue(flowtexPlaced, flowtexPositionVSOutput);
#endif
  flowtexColour = flowtexBelow(flowtexColour, flowtexPlaced);
#ifdef FLOWTEX_PAINTED
  flowtexColour = flowtexPaint(flowtexColour);
#else
  flowtexColour = flowtexShade(flowtexColour, flowtexTextured.x * flowtexTextured.y);
#endif
#endif
  ambientColor = ambientIntensity * flowtexColour;
  diffuseColor = diffuseIntensity * flowtexColour;
