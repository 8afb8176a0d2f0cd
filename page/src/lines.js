// Lines of any width, as quads that are made in the shader: drawing by instances is slow where there is no graphics card.
import * as THREE from 'three';

const vertexShader = `
in vec3 position, other;
in float side;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform vec2 pixels;  // of the pane
uniform float width;
void main() {
  mat4 matrix = projectionMatrix * modelViewMatrix;
  vec4 here = matrix * vec4(position, 1.0), there = matrix * vec4(other, 1.0);
  vec2 along = (there.xy / max(there.w, 1e-6) - here.xy / max(here.w, 1e-6)) * pixels;
  along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  // To the side, and a little beyond the end, so that lines meet.
  vec2 move = width * (side * vec2(-along.y, along.x) - 0.7 * along);
  here.xy += move / pixels * here.w;
  gl_Position = here;
}`;
const fragmentShader = `
precision highp float;
uniform vec3 colour;
out vec4 result;
void main() { result = vec4(colour, 1.0); }`;

/** segments: six numbers each. width: pixels. */
export function lineMesh(segments, colour, width, onTop) {
  const n = segments.length / 6, position = new Float32Array(12 * n), other = new Float32Array(12 * n), side = new Float32Array(4 * n), index = new Uint32Array(6 * n);
  for (let i = 0; i < n; ++i) {
    const from = segments.subarray(6 * i, 6 * i + 3), to = segments.subarray(6 * i + 3, 6 * i + 6);
    // Seen from its other end left is right.
    [[from, to, 1], [from, to, -1], [to, from, 1], [to, from, -1]].forEach(([a, b, s], k) => {
      position.set(a, 12 * i + 3 * k);
      other.set(b, 12 * i + 3 * k);
      side[4 * i + k] = s;
    });
    index.set([4 * i, 4 * i + 1, 4 * i + 2, 4 * i, 4 * i + 2, 4 * i + 3], 6 * i);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
  geometry.setAttribute('other', new THREE.BufferAttribute(other, 3));
  geometry.setAttribute('side', new THREE.BufferAttribute(side, 1));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  const rgb = new THREE.Color(colour);
  const material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader, fragmentShader, side: THREE.DoubleSide, depthTest: !onTop, transparent: onTop,
    uniforms: { pixels: { value: new THREE.Vector2(1, 1) }, width: { value: width }, colour: { value: new THREE.Vector3(rgb.r, rgb.g, rgb.b) } },
  });
  const object = new THREE.Mesh(geometry, material), viewport = new THREE.Vector4();
  object.frustumCulled = false;
  object.onBeforeRender = (renderer) => {
    renderer.getCurrentViewport(viewport);
    const ratio = renderer.getPixelRatio();
    material.uniforms.pixels.value.set(viewport.z / ratio, viewport.w / ratio);
    material.uniformsNeedUpdate = true;
  };
  return object;
}
