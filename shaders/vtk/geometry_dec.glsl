// VTK puts a geometry shader in when it draws edges; what it does not pass on is lost. VTK names
// the outputs of a stage by it: VSOutput, GSOutput.
in vec3 flowtexPositionVSOutput[];
in vec2 flowtexCoordinateVSOutput[];
out vec3 flowtexPositionGSOutput;
out vec2 flowtexCoordinateGSOutput;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormalVSOutput[];
out vec3 flowtexNormalGSOutput;
#endif
#ifdef FLOWTEX_TRIANGLES
flat in vec4 flowtexCornersVSOutput[];
flat out vec4 flowtexCornersGSOutput;
#endif
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoiseVSOutput[];
out vec2 flowtexNoiseGSOutput;
#endif
