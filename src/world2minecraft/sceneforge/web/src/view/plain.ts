// Materials of the marks over the voxels. three.js's own would do, but each takes a software GL
// long to compile, and the first frame waits for it.

import * as THREE from "three";

const FLAT_VERTEX = /* glsl */ `
precision highp float;
uniform mat4 projectionMatrix, modelViewMatrix;
uniform vec4 tint;
in vec3 position;
out vec4 shade;
#ifdef COLOURS
in vec4 color;
#endif
void main() {
  shade = tint;
#ifdef COLOURS
  shade *= color;
#endif
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

const FLAT_FRAGMENT = /* glsl */ `
precision highp float;
in vec4 shade;
out vec4 colour;
void main() {
  colour = shade;
}
`;

// Balls are squares that face the camera.
const BALL_VERTEX = /* glsl */ `
precision highp float;
uniform mat4 projectionMatrix, viewMatrix;
in vec3 position; // the centre
in vec4 ball; // corner x y, radius in metres, width of the rim as a share of it
in vec4 color, edge;
out vec2 at;
flat out float rim;
flat out vec4 fill, line;
void main() {
  at = ball.xy * (1.0 + ball.w);
  rim = 1.0 + ball.w;
  fill = color;
  line = edge;
  vec4 middle = viewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * (middle + vec4(at * ball.z, 0.0, 0.0));
}
`;

const BALL_FRAGMENT = /* glsl */ `
precision highp float;
in vec2 at;
flat in float rim;
flat in vec4 fill, line;
out vec4 colour;
void main() {
  float away = length(at);
  float soft = fwidth(away);
  float light = 1.04 - 0.22 * clamp(dot(at, vec2(0.5, -0.6)) + 0.2, 0.0, 1.0);
  vec4 inside = vec4(fill.rgb * light, fill.a);
  colour = mix(inside, line, smoothstep(1.0 - soft, 1.0, away));
  colour.a *= 1.0 - smoothstep(rim - soft, rim, away);
}
`;

export type FlatMaterial = THREE.RawShaderMaterial & { uniforms: { tint: { value: THREE.Vector4 } } };

/** One colour (sRGB) and opacity, times a `color` attribute of four where `colours`. */
export function flatMaterial(
  colour: string | number,
  opacity: number,
  options: THREE.ShaderMaterialParameters & { colours?: boolean } = {},
): FlatMaterial {
  const { colours, ...rest } = options;
  const { r, g, b } = srgb(colour);
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: FLAT_VERTEX,
    fragmentShader: FLAT_FRAGMENT,
    defines: colours ? { COLOURS: "" } : {},
    uniforms: { tint: { value: new THREE.Vector4(r, g, b, opacity) } },
    transparent: true,
    depthWrite: false,
    ...rest,
  }) as unknown as FlatMaterial;
}

export function ballMaterial(): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: BALL_VERTEX,
    fragmentShader: BALL_FRAGMENT,
    transparent: true,
    depthTest: false,
    depthWrite: false,
  });
}

/** The three parts of a colour as a screen shows them, 0..1. */
export function srgb(colour: string | number): { r: number; g: number; b: number } {
  return new THREE.Color(colour).getRGB({ r: 0, g: 0, b: 0 }, THREE.SRGBColorSpace);
}
