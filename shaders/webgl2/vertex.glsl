// A node of the surface: its place in the picture, and what a fragment needs of it.

in vec3 flowtexPosition; // in the surface's own frame, from u_anchor of the client
in vec2 flowtexCoordinate;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormal;
#endif
#ifdef FLOWTEX_TRIANGLES
in vec3 flowtexCorners; // numbers of the three nodes, the same at each
in vec2 flowtexScalar;  // share of the colour map's range, at both times of the slices
#endif
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoise;
#endif

uniform mat4 u_matrix; // from the surface's frame to the picture
#if defined(FLOWTEX_TRIANGLES) && defined(FLOWTEX_UNSTEADY)
uniform float u_between;
#endif

out vec3 flowtexPositionOut;
out vec2 flowtexCoordinateOut;
#ifndef FLOWTEX_PLANAR
out vec3 flowtexNormalOut;
#endif
#ifdef FLOWTEX_TRIANGLES
flat out vec3 flowtexCornersOut;
flat out highp int flowtexTriangleOut; // its number
out float flowtexScalarOut;
flat out float flowtexFlatOut; // the same of a triangle, exactly
#endif
#ifdef FLOWTEX_PAPER
out vec2 flowtexNoiseOut;
#endif

void main()
{
  flowtexPositionOut = flowtexPosition;
  flowtexCoordinateOut = flowtexCoordinate;
#ifndef FLOWTEX_PLANAR
  flowtexNormalOut = flowtexNormal;
#endif
#ifdef FLOWTEX_TRIANGLES
  flowtexCornersOut = flowtexCorners;
  flowtexTriangleOut = gl_VertexID / 3;
#ifdef FLOWTEX_UNSTEADY
  flowtexScalarOut = mix(flowtexScalar.x, flowtexScalar.y, u_between);
#else
  flowtexScalarOut = flowtexScalar.x;
#endif
  flowtexFlatOut = flowtexScalarOut;
#endif
#ifdef FLOWTEX_PAPER
  flowtexNoiseOut = flowtexNoise;
#endif
  gl_Position = u_matrix * vec4(flowtexPosition, 1.0);
}
