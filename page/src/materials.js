// How quads are drawn: flat, with their edges, by one shader. Colours are those of the screen.
import * as THREE from 'three';

const vertexShader = `
in vec3 position;
in vec4 tint;
uniform mat4 modelViewMatrix, projectionMatrix;
out vec3 seen, placed;
out vec2 at;
out vec4 colour;
void main() {
  int corner = gl_VertexID & 3;
  at = vec2(corner == 1 || corner == 2 ? 1.0 : 0.0, corner >= 2 ? 1.0 : 0.0);
  colour = tint;
  placed = position;
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  seen = view.xyz;
  gl_Position = projectionMatrix * view;
}`;

const fragmentShader = `
precision highp float;
precision highp int;
in vec3 seen, placed;
in vec2 at;
in vec4 colour;
uniform vec4 clip;      // what is above this plane is not drawn
uniform float lines;    // strength of the edges
uniform vec3 ink;
uniform float opacity;
uniform float lit;
out vec4 result;
void main() {
  if (dot(clip.xyz, placed) > clip.w) discard;
  vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
  // Light comes from the left above the eye; both sides are alike.
  float shade = 0.70 + 0.32 * max(0.0, dot(normal, normalize(vec3(-0.25, 0.45, 0.9))));
#ifdef PLAIN
  float edge = 0.0;
#else
  vec2 wide = fwidth(at);
  vec2 near = min(at, 1.0 - at) / max(wide, vec2(1e-6));
  float edge = 1.0 - smoothstep(0.4, 1.25, min(near.x, near.y));
  // Edges of small quads fade: they would cover everything.
  edge *= lines * clamp(1.25 - 2.5 * max(wide.x, wide.y), 0.0, 1.0);
#endif
  vec3 base = colour.rgb * mix(1.0, shade, lit);
  result = vec4(mix(base, ink, edge), opacity * colour.a);
}`;

export const noClip = () => new THREE.Vector4(0, 0, 0, 1);

export function quadMaterial(options = {}) {
  const { opacity = 1, lines = 0.55, lit = 1, offset = 1, onTop = false, isPlain = false } = options;
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader, fragmentShader, side: THREE.DoubleSide, defines: isPlain ? { PLAIN: 1 } : {},
    transparent: opacity < 1, depthWrite: opacity === 1, depthTest: !onTop,
    polygonOffset: true, polygonOffsetFactor: offset, polygonOffsetUnits: offset,
    uniforms: {
      clip: { value: noClip() }, lines: { value: lines }, ink: { value: new THREE.Vector3(0.12, 0.14, 0.18) },
      opacity: { value: opacity }, lit: { value: lit },
    },
  });
}

/** Smooth surfaces of the CAD. */
export function cadMaterial() {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2,
    vertexShader: `
in vec3 position, normal;
in vec2 uv;
in vec4 tint;
out vec3 own;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform mat3 normalMatrix;
out vec3 turned, placed;
out vec2 at;
void main() {
  placed = position;
  own = tint.rgb;
  at = uv;
  turned = normalMatrix * normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`,
    fragmentShader: `
precision highp float;
in vec3 turned, placed, own;
in vec2 at;
uniform vec4 clip;
uniform vec3 colour, ink;
uniform float lines;  // of the mesh
uniform float tinted; // 1: each surface has its colour
out vec4 result;
void main() {
  if (dot(clip.xyz, placed) > clip.w) discard;
  vec3 n = normalize(turned);
  float shade = 0.70 + 0.32 * max(0.0, dot(n.z < 0.0 ? -n : n, normalize(vec3(-0.25, 0.45, 0.9))));
  vec2 wide = fwidth(at), near = min(at, 1.0 - at) / max(wide, vec2(1e-6));
  float edge = (1.0 - smoothstep(0.4, 1.25, min(near.x, near.y))) * lines * clamp(1.25 - 2.5 * max(wide.x, wide.y), 0.0, 1.0);
  result = vec4(mix(mix(colour, own, tinted) * shade, ink, edge), 1.0);
}`,
    uniforms: { clip: { value: noClip() }, colour: { value: new THREE.Vector3() }, ink: { value: new THREE.Vector3() }, lines: { value: 0 }, tinted: { value: 0 } },
  });
}
