// How blocks are drawn: sharp textures that repeat, the light of the game at each corner, what is
// hidden collapsed. Products are taken on screen values, as the game does.

import * as THREE from "three";

const VERTEX = /* glsl */ `
in vec4 light; // sky, block, corner, own
in vec4 colour; // tint, shade
in vec4 kind; // texture; class + 256 * cuts, its own and of what lies on it
uniform int hiddenClasses;
uniform int hiddenCuts;
uniform vec3 skyLight;
uniform vec3 lampLight;
uniform vec3 ambient;
uniform float corner;
uniform float curve;
uniform float tall; // of the picture, in pixels
in vec3 outward;
out vec2 at;
flat out float layer;
out vec3 tint;
float shine(float level) {
  float share = min(level * (255.0 / 60.0), 1.0);
  return share / (1.0 + curve * (1.0 - share));
}
bool isOff(float told) {
  int facts = int(told + 0.5);
  return ((1 << (facts & 255)) & hiddenClasses) != 0 || ((facts >> 8) & hiddenCuts) != 0;
}
void main() {
  bool hidden = isOff(kind.y) || (kind.z < 65534.5 && !isOff(kind.z));
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  float pixel = 2.0 * (projectionMatrix * place).w / (projectionMatrix[1][1] * tall);
  vec3 away = mat3(modelViewMatrix) * outward;
  float reach = length(away);
  if (reach > 0.0) place.xyz += away * (max(pixel, 0.0) * 0.12 / reach);
  gl_Position = hidden ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * place;
  at = uv;
  layer = kind.x;
  vec3 lit = ambient + max(skyLight * shine(light.x), lampLight * shine(light.y));
  lit *= colour.a * (1.0 - corner * light.z * (255.0 / 80.0));
  tint = colour.rgb * max(lit, vec3(light.w * 1.12));
}
`;

const FRAGMENT = /* glsl */ `
uniform sampler2DArray textures;
uniform bool clear;
in vec2 at;
flat in float layer;
in vec3 tint;
out vec4 painted;
void main() {
  vec4 texel = texture(textures, vec3(at, layer));
  if (clear ? texel.a < 0.02 : texel.a < 0.5) discard;
  painted = vec4(texel.rgb * tint, clear ? texel.a : 1.0);
}
`;

export const LIGHTS = ["even", "day", "night"] as const;
export type Light = (typeof LIGHTS)[number];

/** Screen values: the preview's even light, and the game's by day and by night. */
const LOOKS: Record<Light, { sky: number[]; lamp: number[]; ambient: number[]; corner: number }> = {
  even: { sky: [0, 0, 0], lamp: [0, 0, 0], ambient: [1.1, 1.1, 1.1], corner: 0.15 },
  day: { sky: [1, 1, 1], lamp: [0.95, 0.82, 0.6], ambient: [0.1, 0.1, 0.1], corner: 0.2 },
  night: { sky: [0.13, 0.15, 0.26], lamp: [0.95, 0.82, 0.6], ambient: [0.05, 0.05, 0.07], corner: 0.2 },
};

/** What is behind all blocks for one who walks. */
export const SKIES: Record<Light, number> = { even: 0x8fb8f0, day: 0x8fb8f0, night: 0x0b1026 };

export class BlockMaterial {
  light: Light = "even";
  readonly uniforms = {
    textures: { value: null as THREE.DataArrayTexture | null },
    hiddenClasses: { value: 0 },
    hiddenCuts: { value: 0 },
    skyLight: { value: new THREE.Vector3() },
    lampLight: { value: new THREE.Vector3() },
    ambient: { value: new THREE.Vector3() },
    corner: { value: 0 },
    curve: { value: 0.525 },
    tall: { value: 1000 },
  };
  readonly solid = this.made(false);
  readonly clear = this.made(true);

  constructor() {
    this.setLight(this.light);
  }

  setLight(light: Light): void {
    this.light = light;
    const { sky, lamp, ambient, corner } = LOOKS[light];
    this.uniforms.skyLight.value.fromArray(sky);
    this.uniforms.lampLight.value.fromArray(lamp);
    this.uniforms.ambient.value.fromArray(ambient);
    this.uniforms.corner.value = corner;
  }

  setTextures(texels: Uint8Array, side: number, layers: number): void {
    const texture = new THREE.DataArrayTexture(texels, side, side, layers);
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.magFilter = THREE.NearestFilter;
    texture.minFilter = THREE.NearestMipmapNearestFilter; // Sharp near, calm far, cheap by software.
    texture.generateMipmaps = true;
    texture.needsUpdate = true;
    this.uniforms.textures.value?.dispose();
    this.uniforms.textures.value = texture;
  }

  dispose(): void {
    this.uniforms.textures.value?.dispose();
    this.solid.dispose();
    this.clear.dispose();
  }

  private made(clear: boolean): THREE.ShaderMaterial {
    return new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { ...this.uniforms, clear: { value: clear } },
      transparent: clear,
      depthWrite: !clear,
    });
  }
}
