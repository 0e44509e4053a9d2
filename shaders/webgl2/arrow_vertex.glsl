// A vertex of an arrow; what a seed has is the same for all of them.

in vec3 flowtexPosition; // in the surface's own frame, from u_anchor of the client
in vec2 flowtexCoordinate;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormal;
#else
const vec3 flowtexNormal = vec3(0.0, 0.0, 1.0);
#endif
#ifdef FLOWTEX_TRIANGLES
in vec3 flowtexCorners;
#endif
in float flowtexRadius;
in vec2 flowtexScalar; // share of the colour map's range, at both times of the slices

uniform mat4 u_matrix; // from the surface's frame to the picture

out vec2 flowtexPlaceOut;
out float flowtexSizeOut;
out vec4 flowtexCoreOut;  // colour, and whether it is that of a value
uniform bool u_plain;     // the arrows have the colours

//#include common/arrow.glsl
//#include webgl2/mapped.glsl

void main()
{
#ifdef FLOWTEX_TRIANGLES
  flowtexSetCorners(flowtexCorners);
#endif
  float side = float(gl_VertexID & 1) * 2.0 - 1.0;
  FlowtexStroke stroke = flowtexStroke(u_matrix, flowtexPosition, flowtexNormal, flowtexCoordinate,
                                       flowtexRadius, gl_VertexID >> 1, side);
  gl_Position = stroke.position;
  flowtexPlaceOut = stroke.place;
  flowtexSizeOut = stroke.size;
#ifdef FLOWTEX_UNSTEADY
  float scalar = mix(flowtexScalar.x, flowtexScalar.y, u_between);
#else
  float scalar = flowtexScalar.x;
#endif
  flowtexCoreOut = u_plain ? vec4(flowtexMapped(scalar), 1.0) : vec4(0.0);
}
