// A picture of the flow on a web map; nothing beside it.

in vec3 flowtexPlaceOut;

uniform sampler2D u_flowPicture;
uniform float u_opacity;

out vec4 flowtexOut;

void main()
{
  vec2 place = 0.5 + 0.5 * flowtexPlaceOut.xy / flowtexPlaceOut.z;
  if (flowtexPlaceOut.z <= 0.0 || place != clamp(place, 0.0, 1.0))
    discard;
  flowtexOut = u_opacity * texture(u_flowPicture, place);
}
