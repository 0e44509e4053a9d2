// A line with smooth sides, in premultiplied colours.

in float flowtexAcross;
in float flowtexSeen;

uniform float u_width;
uniform vec4 u_lineColour;

out vec4 flowtexOut;

void main()
{
  if (flowtexSeen < 0.0)
    discard;
  float covered = clamp(0.5 * u_width + 0.5 - abs(flowtexAcross), 0.0, min(u_width, 1.0));
  float share = covered * u_lineColour.a;
  flowtexOut = vec4(u_lineColour.rgb * share, share);
}
