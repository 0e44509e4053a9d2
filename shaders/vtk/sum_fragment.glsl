// The pixels of one layer by their places in the buffer: colour and texture, and the texture again as it is
// before it fades, with the factor by which it does.
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
  vec2 texture_ = flowtexValueAt(found);
  gl_FragData[0] = vec4(flowtexBelow(u_plainColour, found.coordinate), texture_.x * texture_.y);
  // What is beside the surface does not count for the local mean.
  float covered = pixel == ivec2(gl_FragCoord.xy) ? 1.0 : 0.0;
  gl_FragData[1] = vec4(covered * texture_.x, texture_.y, 0.0, 0.0);
}
