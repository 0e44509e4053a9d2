in vec2 flowtexPlaceVSOutput;
in vec2 flowtexShapeVSOutput;
//#include common/arrow_shape.glsl
