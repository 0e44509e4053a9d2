// Colour and texture of the pixels of one layer, by their places in the buffer.
#ifdef FLOWTEX_TRIANGLES
uniform highp sampler2DArray u_corners; // nodes of the triangles
#endif
//#include common/uniforms.glsl
//#include common/flowtex.glsl
//#include vtk/colour.glsl
//#include vtk/sum_place.glsl

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 place = flowtexPlaceAt(pixel);
#ifdef FLOWTEX_TRIANGLES
  int width = textureSize(u_corners, 0).x;
  flowtexTriangleNumber = int(place.z + 0.5);
  ivec2 corners = ivec2(flowtexTriangleNumber % width, flowtexTriangleNumber / width);
  flowtexSetCorners(texelFetch(u_corners, ivec3(corners, 0), 0).xyz);
#endif
  FlowtexPlace found = flowtexFindPlace(vec2(pixel) + 0.5, place.xy);
  float value = flowtexValueAt(found);
  gl_FragData[0] = vec4(flowtexColoured(u_plainColour, found.coordinate, value), value);
}
