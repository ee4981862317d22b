// Voxels that are seen through: at rest several frames, each with other pixels left out, are
// averaged, so that the grain of one frame becomes glass.

import * as THREE from "three";

export const PASSES = 8; // as the fragment shader counts them

const COPY_VERTEX = /* glsl */ `
out vec2 at;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);
}
`;

const COPY_FRAGMENT = /* glsl */ `
precision highp float;
uniform sampler2D picture;
uniform float share;
in vec2 at;
out vec4 colour;
void main() {
  colour = vec4(texture(picture, at).rgb, share);
}
`;

export class Glass {
  private readonly one = new THREE.WebGLRenderTarget(1, 1);
  private readonly sum = new THREE.WebGLRenderTarget(1, 1, { type: THREE.HalfFloatType, depthBuffer: false });
  private readonly copy = new THREE.Mesh(
    new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(new Float32Array(9), 3)),
    new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader: COPY_VERTEX,
      fragmentShader: COPY_FRAGMENT,
      uniforms: { picture: { value: null as THREE.Texture | null }, share: { value: 1 } },
      transparent: true,
      depthTest: false,
      depthWrite: false,
    }),
  );

  constructor(private readonly renderer: THREE.WebGLRenderer) {
    this.copy.frustumCulled = false;
  }

  /** Add one more frame of a scene to the average, from pass 0 on, and show it. */
  add(pass: number, scene: THREE.Scene, camera: THREE.Camera): void {
    const { renderer, one, sum } = this;
    const { x, y } = renderer.getDrawingBufferSize(new THREE.Vector2());
    one.setSize(x, y);
    sum.setSize(x, y);
    const { background } = scene;
    // A target holds what shaders say; the canvas would turn the background's colour into sRGB.
    if (background instanceof THREE.Color) scene.background = background.clone().convertLinearToSRGB();
    renderer.setRenderTarget(one);
    renderer.render(scene, camera);
    scene.background = background;
    renderer.autoClear = false;
    this.draw(one.texture, sum, 1 / (pass + 1), camera);
    this.draw(sum.texture, null, 1, camera);
    renderer.autoClear = true;
  }

  dispose(): void {
    this.one.dispose();
    this.sum.dispose();
    this.copy.geometry.dispose();
    this.copy.material.dispose();
  }

  private draw(from: THREE.Texture, to: THREE.WebGLRenderTarget | null, share: number, camera: THREE.Camera): void {
    const { uniforms } = this.copy.material;
    uniforms.picture!.value = from;
    uniforms.share!.value = share;
    this.copy.material.uniformsNeedUpdate = true;
    this.renderer.setRenderTarget(to);
    this.renderer.render(this.copy, camera);
  }
}
