//#include common/uniforms.glsl
//#include common/shade.glsl
#ifdef FLOWTEX_DEFERRED
uniform sampler2D u_shown; // colour under the texture, and the texture itself, of each pixel
#ifdef FLOWTEX_PROJECTED
in vec3 flowtexPixelVSOutput; // pixel of it, before the division by the third number
#else
uniform int u_margin; // pixels of it before the first of the frame
#endif
#else
in vec2 flowtexCoordinateVSOutput;
in vec3 flowtexPositionVSOutput;
#ifdef FLOWTEX_TRIANGLES
flat in vec4 flowtexCornersVSOutput;
#endif
#ifdef FLOWTEX_IMAGE
in vec2 flowtexImageVSOutput;
#endif
//#include common/flowtex.glsl
//#include vtk/colour.glsl
#endif
