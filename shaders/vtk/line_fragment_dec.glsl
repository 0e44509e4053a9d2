flat in vec4 flowtexEndsVSOutput;
flat in float flowtexRadiusVSOutput;
