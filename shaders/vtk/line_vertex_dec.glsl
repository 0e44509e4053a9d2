// A line as a ribbon that has the same width in pixels everywhere: each piece of it is four
// vertices, two at either end, which know the other end.
in vec3 flowtexOther;
in float flowtexSide; // 1 or -1 at the one end, 2 or -2 at the other
flat out vec4 flowtexEndsVSOutput;
flat out float flowtexRadiusVSOutput;
