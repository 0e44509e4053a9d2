in vec2 flowtexPlaceVSOutput;
in vec2 flowtexShapeVSOutput;
in vec4 flowtexCoreVSOutput;
//#include common/arrow_shape.glsl
