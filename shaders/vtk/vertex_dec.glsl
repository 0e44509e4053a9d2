#if defined(FLOWTEX_PROJECTED)
in vec3 flowtexPosition;
uniform mat4 u_toPixels; // from positions to pixels of the texture that is shown
out vec3 flowtexPixelVSOutput;
#elif !defined(FLOWTEX_DEFERRED)
in vec2 flowtexCoordinate;
out vec2 flowtexCoordinateVSOutput;
in vec3 flowtexPosition;
out vec3 flowtexPositionVSOutput;
#ifdef FLOWTEX_TRIANGLES
in vec4 flowtexCorners; // numbers of the three nodes and of the triangle, the same at each
flat out vec4 flowtexCornersVSOutput;
#endif
#ifdef FLOWTEX_IMAGE
in vec2 flowtexImage;
out vec2 flowtexImageVSOutput;
#endif
#endif
