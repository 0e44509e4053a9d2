// VTK puts a geometry shader in when it draws edges; what it does not pass on is lost. VTK names
// the outputs of a stage by it: VSOutput, GSOutput.
#if defined(FLOWTEX_PROJECTED)
in vec3 flowtexPixelVSOutput[];
out vec3 flowtexPixelGSOutput;
#elif !defined(FLOWTEX_DEFERRED)
in vec2 flowtexCoordinateVSOutput[];
out vec2 flowtexCoordinateGSOutput;
in vec3 flowtexPositionVSOutput[];
out vec3 flowtexPositionGSOutput;
#ifdef FLOWTEX_TRIANGLES
flat in vec4 flowtexCornersVSOutput[];
flat out vec4 flowtexCornersGSOutput;
#endif
#ifdef FLOWTEX_IMAGE
in vec2 flowtexImageVSOutput[];
out vec2 flowtexImageGSOutput;
#endif
#endif
