// Land, or places without data, in one colour.

//#include common/constants.glsl

uniform vec3 u_colour;
uniform bool u_lit;
uniform vec3 u_toEye;
#ifdef FLOWTEX_GLOBE
uniform vec3 u_aside;
uniform vec3 u_upward;
uniform vec3 u_ground;
uniform float u_away; // distance of the eye in radii; 0 without perspective
in vec2 flowtexPlaceOut;
in vec2 flowtexDepthOut;
const float FLOWTEX_FARTHEST = 0.999999; // depth that is still drawn
#endif

#ifdef FLOWTEX_ROUND
in vec3 flowtexOutwardOut;
#endif

out vec4 flowtexOut;

void main()
{
  vec3 colour = u_colour;
#ifdef FLOWTEX_ROUND
  if (u_lit)
  {
    float turned = abs(dot(normalize(flowtexOutwardOut), u_toEye));
    colour *= min(FLOWTEX_AMBIENT_LIGHT + FLOWTEX_DIFFUSE_LIGHT * turned, 1.0);
  }
#endif
#ifdef FLOWTEX_GLOBE
  float radius = length(flowtexPlaceOut);
  // Half a pixel within the flow, whose triangles lie within the sphere.
  float covered = clamp((1.0 - radius) / fwidth(radius), 0.0, 1.0);
  if (covered == 0.0)
    discard;
  if (u_lit)
  {
    // Where the ray through the disc meets the sphere, the eye lying on the third axis.
    vec3 normal = vec3(flowtexPlaceOut, sqrt(max(1.0 - radius * radius, 0.0)));
    if (u_away > 0.0)
    {
      float horizon = sqrt(1.0 - 1.0 / (u_away * u_away));
      vec3 ray = vec3(flowtexPlaceOut * horizon, 1.0 / u_away - u_away);
      float b = u_away * ray.z, a = dot(ray, ray);
      float t = (-b - sqrt(max(b * b - a * (u_away * u_away - 1.0), 0.0))) / a;
      normal = vec3(0.0, 0.0, u_away) + t * ray;
    }
    vec3 aside = normalize(u_aside), upward = normalize(u_upward);
    vec3 outward = normal.x * aside + normal.y * upward + normal.z * cross(aside, upward);
    float facing = abs(dot(outward, u_toEye));
    colour *= min(FLOWTEX_AMBIENT_LIGHT + FLOWTEX_DIFFUSE_LIGHT * facing, 1.0);
  }
  colour = mix(u_ground, colour, covered);
  gl_FragDepth = clamp(0.5 + 0.5 * flowtexDepthOut.x / flowtexDepthOut.y, 0.0, FLOWTEX_FARTHEST);
#endif
  flowtexOut = vec4(colour, 1.0);
}
