// A mesh that stands beside the flow, lit as VTK lights it; or what hides the flow from the pointer.

#ifdef FLOWTEX_HIDING
out uvec4 flowtexOut;

void main()
{
  flowtexOut = uvec4(0u);
}
#else
const int FLOWTEX_LIGHTS = 8;

in vec3 flowtexPositionOut;
in vec3 flowtexNormalOut;
in vec4 flowtexColourOut;

uniform vec4 u_eye; // as in common/uniforms.glsl
uniform vec3 u_lightWays[FLOWTEX_LIGHTS];
uniform vec3 u_lightColours[FLOWTEX_LIGHTS];
uniform float u_ambient;
uniform float u_diffuse;

out vec4 flowtexOut;

void main()
{
  vec3 normal = flowtexNormalOut;
  if (dot(normal, normal) < 0.25)
    normal = cross(dFdx(flowtexPositionOut), dFdy(flowtexPositionOut));
  normal = normalize(normal);
  if (dot(normal, u_eye.xyz - u_eye.w * flowtexPositionOut) < 0.0)
    normal = -normal;
  vec3 light = vec3(u_ambient);
  for (int n = 0; n < FLOWTEX_LIGHTS; ++n)
    light += u_diffuse * u_lightColours[n] * max(dot(normal, u_lightWays[n]), 0.0);
  flowtexOut = vec4(min(flowtexColourOut.rgb * light, 1.0), flowtexColourOut.a);
}
#endif
