in vec2 flowtexPlaceOut;
in vec2 flowtexShapeOut;
in vec4 flowtexCoreOut;

//#include common/arrow_shape.glsl

out vec4 flowtexOut;

void main()
{
  flowtexOut = flowtexArrow(flowtexPlaceOut, flowtexShapeOut.x, flowtexShapeOut.y, flowtexCoreOut);
}
