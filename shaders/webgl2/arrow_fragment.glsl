in vec2 flowtexPlaceOut;
in float flowtexSizeOut;
in vec4 flowtexCoreOut;

//#include common/arrow_shape.glsl

out vec4 flowtexOut;

void main()
{
  flowtexOut = flowtexArrow(flowtexPlaceOut, flowtexSizeOut, flowtexCoreOut);
}
