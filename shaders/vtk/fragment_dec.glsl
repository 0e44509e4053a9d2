in vec2 flowtexCoordinateVSOutput;
#ifdef FLOWTEX_TRIANGLES
flat in vec4 flowtexCornersVSOutput;
#endif
//#include common/uniforms.glsl
//#include common/path.glsl
//#include common/shade.glsl
//#include vtk/mapped.glsl
#ifdef FLOWTEX_DEFERRED
uniform sampler2D u_sums; // texture, level and coordinate of each pixel
#else
in vec3 flowtexPositionVSOutput;
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoiseVSOutput;
#endif
//#include common/flowtex.glsl
#endif

uniform bool u_mapped;            // colour by the values of the nodes, or as VTK does,
uniform bool u_plain;             // or in one colour, as arrows have the others
uniform vec3 u_plainColour;

vec2 flowtexPlaced; // texture coordinate of the fragment
