in vec2 flowtexPlaceVSOutput;
in float flowtexSizeVSOutput;
in vec4 flowtexCoreVSOutput;
//#include common/arrow_shape.glsl
