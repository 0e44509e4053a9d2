// The number of the layer of each pixel as its depth, so that no other layer is computed there.

//#include vtk/sum_place.glsl
uniform float u_layers; // most layers

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  gl_FragDepth = flowtexPlaceAt(pixel).w / u_layers;
  gl_FragData[0] = vec4(0.0);
}
