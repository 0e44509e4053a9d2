// A picture of the flow on a web map; nothing beside it.

in vec3 flowtexPlaceOut;
in vec2 flowtexSidesOut;

uniform vec4 u_box;
uniform mat4 u_flowMatrix;
uniform sampler2D u_flowPicture;
uniform float u_opacity;
uniform float u_flowPixel; // share of the box's width that a pixel of the picture covers
uniform bool u_repeated;   // whether the map goes on at its other side

// Pixels beside such a side into whose colour what is clear beyond may be mixed, which keeps this share at least.
const float FLOWTEX_EDGE = 4.0;
const float FLOWTEX_LEAST_SHARE = 0.2;
const float FLOWTEX_ROUNDED = 1e-6; // share of the width by which nodes of a scene are rounded

out vec4 flowtexOut;

void main()
{
  float pixel = max(max(fwidth(flowtexSidesOut.x), fwidth(flowtexSidesOut.y)), u_flowPixel);
  vec2 inside = max(max(0.5 * pixel, FLOWTEX_ROUNDED) - flowtexSidesOut, 0.0);
  vec3 seen = flowtexPlaceOut;
  if (u_repeated)
    seen += (inside.x - inside.y) * u_box.z * u_flowMatrix[0].xyw;
  vec2 place = 0.5 + 0.5 * seen.xy / seen.z;
  if (seen.z <= 0.0 || place != clamp(place, 0.0, 1.0))
    discard;
  vec4 colour = texture(u_flowPicture, place);
  float side = min(flowtexSidesOut.x, flowtexSidesOut.y);
  if (u_repeated && side < FLOWTEX_EDGE * pixel && colour.a > FLOWTEX_LEAST_SHARE)
    colour /= colour.a;
  flowtexOut = u_opacity * colour;
}
