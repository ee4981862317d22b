// The shaders of the voxels. The vertex shader hides classes and cuts the slices by moving
// corners, so neither needs a new mesh; the fragment shader draws edges and contact shadows.

export const VERTEX = /* glsl */ `
precision highp float;
precision highp int;
uniform mat4 projectionMatrix, viewMatrix, modelMatrix;
uniform vec4 palette[16]; // rgb, and whether the class is drawn
uniform vec3 origin; // metres
uniform float voxel; // metres
uniform vec3 boxLow, boxHigh; // cells; what the slices leave
uniform float shrink; // side of a drawn cube, share of a cell
uniform vec2 overlap; // of neighbouring quads, in cells: a unit of depth, and everywhere
in vec4 place, kind;
out vec3 cell;
out vec2 across; // along the face, in cells
flat out vec3 normal, tint;
flat out float span, light;

const float LIGHT[6] = float[6](0.85, 0.93, 1.0, 0.79, 0.72, 0.52); // +x +y +z -x -y -z

void main() {
  int bits = int(place.w + 0.5);
  int face = bits & 7;
  int corner = bits >> 3;
  int axis = face % 3;
  vec3 n = vec3(axis == 0, axis == 1, axis == 2) * (face < 3 ? 1.0 : -1.0);
  vec3 at = (modelMatrix * vec4(place.xyz, 1.0)).xyz;
  at = floor((at - origin) / voxel + 0.5);
  int label = int(kind.x + 0.5);
  bool hidden = palette[label].a < 0.5;
#ifdef CUBES
  vec3 owner = at;
  vec3 side = vec3(corner & 1, (corner >> 1) & 1, corner >> 2);
  at += 0.5 + (side - 0.5) * shrink;
  hidden = hidden || any(lessThan(owner, boxLow)) || any(greaterThanEqual(owner, boxHigh));
#else
  // Quads whose sides meet other corners leave pinholes between them, unless they overlap a little.
  vec3 side = vec3(corner & 1, (corner >> 1) & 1, corner >> 2) * 2.0 - 1.0;
  float deep = -(viewMatrix * vec4(origin + at * voxel, 1.0)).z;
  at += side * (1.0 - abs(n)) * (overlap.x * max(deep, 0.0) + overlap.y);
  float plane = dot(at, abs(n)), low = dot(boxLow, abs(n)), high = dot(boxHigh, abs(n));
  hidden = hidden || (face < 3 ? plane <= low || plane > high : plane < low || plane >= high);
  at = clamp(at, boxLow, boxHigh);
#endif
  if (hidden) at = boxLow; // all corners in one place: no area
  cell = at;
  across = axis == 0 ? at.yz : axis == 1 ? at.zx : at.xy;
  normal = n;
  span = kind.y;
  tint = palette[label & 15].rgb;
  light = LIGHT[face];
  gl_Position = projectionMatrix * viewMatrix * vec4(origin + at * voxel, 1.0);
}
`;

// The ramp runs from doubtful, warm and light, to sure, dark and blue: about even steps to the eye.
export const FRAGMENT = /* glsl */ `
precision highp float;
precision highp sampler3D;
uniform sampler3D solid; // 1 where a drawn cell is; z y x
uniform sampler3D field; // a value for each cell; z y x
uniform vec3 shape; // cells of \`solid\`: two more than the scene
uniform float edges, opacity;
uniform float grain; // number of the frame of those that are averaged
in vec3 cell;
in vec2 across;
flat in vec3 normal, tint;
flat in float span, light;
out vec4 colour;

vec3 ramp(float t) {
  const vec3 STOPS[5] = vec3[5](vec3(0.99, 0.87, 0.44), vec3(0.97, 0.62, 0.38), vec3(0.84, 0.43, 0.48),
    vec3(0.57, 0.41, 0.62), vec3(0.34, 0.45, 0.69));
  float at = clamp(t, 0.0, 1.0) * 3.999;
  int stop = int(at);
  return mix(STOPS[stop], STOPS[stop + 1], fract(at));
}

vec3 base() {
  ivec3 owner = ivec3(floor(cell - normal * 0.5)).zyx;
#if defined(BY_CONFIDENCE)
  return ramp(texelFetch(field, owner, 0).r);
#elif defined(BY_COLOUR)
  vec3 seen = texelFetch(field, owner, 0).rgb; // black: no photo saw it
  return seen == vec3(0.0) ? mix(vec3(dot(tint, vec3(0.3, 0.6, 0.1))), tint, 0.35) : seen;
#elif defined(BY_DIFFERENCE)
  float code = texelFetch(field, owner, 0).r * 255.0;
  vec3 same = mix(vec3(dot(tint, vec3(0.3, 0.6, 0.1))), vec3(0.62), 0.7);
  return code > 1.5 ? vec3(0.98, 0.70, 0.22) : code > 0.5 ? vec3(0.25, 0.74, 0.46) : same;
#else
  return tint;
#endif
}

void main() {
#ifdef SCREEN_DOOR
  // Layers behind each other get other patterns, else the nearest would hide all of them; each
  // goes through the eighths in an order of its own.
  float layer = fract(dot(floor(cell - normal * 0.5), vec3(0.754877, 0.569840, 0.431597)));
  float turn = grain * (1.0 + 2.0 * floor(layer * 4.0)) / 8.0;
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))) + layer + turn);
  if (noise >= opacity) discard;
#endif
  vec3 rgb = base() * light;
#ifdef SHADOWS
  float near = texture(solid, ((cell + 1.0 + normal * 0.5 * span) / shape).zyx).r;
  rgb *= 1.0 - 0.42 * near;
#endif
#ifdef EDGES
  vec2 wide = fwidth(across);
  vec2 away = abs(fract(across - 0.5) - 0.5) / wide; // pixels from the nearest line
  float line = max(wide.x, wide.y); // cells a pixel
  float edge = clamp(1.2 - min(away.x, away.y), 0.0, 1.0);
  rgb *= 1.0 - edges * edge * clamp(1.4 - 4.0 * line, 0.0, 1.0);
#endif
  colour = vec4(rgb, 1.0);
}
`;
