// A piece of a line with round ends and smooth sides. Of pieces that overlap the client keeps what
// covers most, so that a line has one opacity.

in vec2 flowtexPlace;
in float flowtexSize;
in float flowtexSeen;
#ifdef FLOWTEX_BODY
in vec4 flowtexColourOut;
#endif

uniform float u_width;
uniform vec4 u_lineColour;

out vec4 flowtexOut;

void main()
{
  if (flowtexSeen < 0.0)
    discard;
  float beyond = max(max(-flowtexPlace.x, flowtexPlace.x - flowtexSize), 0.0);
  float away = length(vec2(beyond, flowtexPlace.y));
#ifdef FLOWTEX_MARK
  // What is hardly seen, or lies beyond an end, must not hide the next piece.
  float covered = clamp(0.5 * u_width + 0.5 - away, 0.0, 1.0);
  if (covered == 0.0 || (covered < 1.0 && beyond > 0.0 && flowtexSize > 0.0))
    discard;
  flowtexOut = vec4(flowtexColourOut.rgb, flowtexColourOut.a * covered);
  return;
#endif
#ifdef FLOWTEX_BODY
  // What lies behind must not be hidden by a pixel of which it is seen.
  if (away > 0.5 * max(u_width, 1.0))
    discard;
  flowtexOut = flowtexColourOut;
  return;
#endif
  float share = clamp(0.5 * u_width + 0.5 - away, 0.0, min(u_width, 1.0)) * u_lineColour.a;
  flowtexOut = vec4(u_lineColour.rgb * share, share);
}
