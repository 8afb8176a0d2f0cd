// Where the eye is: it turns around a target, z up; one camera for all panes, parallel or perspective.
import * as THREE from 'three';

const fieldOfView = 28;

export class Eye {
  constructor() {
    this.target = new THREE.Vector3();
    this.azimuth = -Math.PI / 4;
    this.elevation = 0.46;
    this.height = 1;      // of what is seen at the target
    this.isParallel = false;
    this.reach = 1;       // everything lies within this distance of the origin
    this.perspective = new THREE.PerspectiveCamera(fieldOfView, 1, 0.1, 10);
    this.parallel = new THREE.OrthographicCamera();
    for (const camera of [this.perspective, this.parallel]) camera.up.set(0, 0, 1);
  }

  get camera() { return this.isParallel ? this.parallel : this.perspective; }
  get distance() { return this.height / 2 / Math.tan((fieldOfView * Math.PI) / 360); }
  /** From the target to the eye. */
  get direction() {
    const c = Math.cos(this.elevation);
    return new THREE.Vector3(c * Math.cos(this.azimuth), c * Math.sin(this.azimuth), Math.sin(this.elevation));
  }

  look(x, y, z) {
    const length = Math.hypot(x, y, z);
    this.elevation = Math.asin(z / length);
    this.azimuth = Math.hypot(x, y) > 1e-9 * length ? Math.atan2(y, x) : -Math.PI / 2;
  }
  turn(dx, dy) {
    this.azimuth -= dx;
    this.elevation = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.elevation + dy));
  }
  /** By parts of the height of the view. */
  move(dx, dy) {
    const camera = this.update(1);
    const right = new THREE.Vector3(), up = new THREE.Vector3();
    camera.matrixWorld.extractBasis(right, up, new THREE.Vector3());
    this.target.addScaledVector(right, -dx * this.height).addScaledVector(up, dy * this.height);
  }
  /** x, y: what stays in place, in parts of the height from the middle. */
  zoom(factor, x = 0, y = 0) {
    const before = this.height;
    this.height = Math.max(this.reach * 1e-6, Math.min(this.reach * 40, this.height * factor));
    const change = (before - this.height) / this.height;
    this.move(-x * change, -y * change);
  }
  fit(center, radius) {
    this.target.copy(center);
    this.height = Math.max(2.15 * radius, 1e-9 * this.reach);
  }

  update(aspect) {
    const { camera, distance } = this, direction = this.direction;
    camera.position.copy(this.target).addScaledVector(direction, distance);
    // Straight from above or below y points up.
    if (Math.abs(this.elevation) > Math.PI / 2 - 1e-6) {
      const s = this.elevation > 0 ? -1 : 1;
      camera.up.set(s * Math.cos(this.azimuth), s * Math.sin(this.azimuth), 0);
    } else camera.up.set(0, 0, 1);
    camera.lookAt(this.target);
    const depth = this.reach * 1.1 + this.target.length();
    if (this.isParallel) {
      Object.assign(camera, { left: (-aspect * this.height) / 2, right: (aspect * this.height) / 2, top: this.height / 2, bottom: -this.height / 2,
        near: distance - depth, far: distance + depth });
    } else {
      camera.aspect = aspect;
      camera.near = Math.max(distance - depth, (distance + depth) / 2e4);
      camera.far = distance + depth;
    }
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    return camera;
  }
}
