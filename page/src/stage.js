// The picture: panes side by side under one camera, mouse and keys on it, labels over it.
import * as THREE from 'three';
import { Eye } from './camera.js';
import { find, firstMet, hexesWithin, isCutOff } from './find.js';

const most = { labels: 400, tried: 4000 };

/** Is there no graphics card? Then every pixel costs. */
function drawsBySoftware() {
  const gl = document.createElement('canvas').getContext('webgl2'), info = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export class Stage {
  /** on: { hover(found), pick(found, add), area(kind, hexes, add), frame() } */
  constructor(canvas, over, theme, on) {
    this.canvas = canvas;
    this.over = over;
    this.on = on;
    this.theme = theme;
    this.eye = new Eye();
    this.panes = [];
    this.areaTool = null;     // 'box' or 'lasso'
    this.keyBox = { x: 0.15, y: 0.15 };  // half of the box around the cross that keys pick with, in parts of the height
    this.labelKind = null;
    this.kind = 'geometry';
    this.through = false;
    this.isSlow = drawsBySoftware();
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !this.isSlow, powerPreference: 'high-performance' });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;  // colours are those of the screen already
    this.renderer.autoClear = false;
    this.frames = 0;
    this.listen();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  resize() {
    const { clientWidth: w, clientHeight: h } = this.canvas.parentElement;
    this.width = Math.max(1, w);
    this.height = Math.max(1, h);
    const ratio = (this.ratio = Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(this.width, this.height, false);
    this.over.width = this.width * ratio;
    this.over.height = this.height * ratio;
    this.pen = this.over.getContext('2d', { willReadFrequently: this.isSlow });  // then it is drawn without the card that is not there
    this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.draw();
  }

  setPanes(panes) {
    this.panes = panes;
    const reach = Math.max(...panes.map((p) => p.scene.radius));
    this.eye.reach = 2.6 * reach;
    this.draw();
  }
  /** Below 1 where a pane is narrower than it is high. */
  get narrowness() { return Math.min(1, this.paneWidth / this.height); }
  get paneWidth() { return this.width / Math.max(1, this.panes.length); }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.render(); });
  }
  render() {
    if (!this.panes.length) return;
    const { renderer } = this, w = this.paneWidth;
    const camera = this.eye.update(w / this.height), isMoving = this.isSlow && this.moved();
    const ratio = isMoving && this.panes.some((pane) => pane.quads.n > 2000) ? 0.6 * this.ratio : this.ratio;
    if (renderer.getPixelRatio() !== ratio) renderer.setPixelRatio(ratio);
    renderer.setClearColor(this.theme.back, 1);
    renderer.setScissorTest(true);
    this.panes.forEach((pane, i) => {
      renderer.setViewport(i * w, 0, w, this.height);
      renderer.setScissor(i * w, 0, w, this.height);
      renderer.clear();
      pane.prepare(isMoving);
      renderer.render(pane.root, camera);
    });
    ++this.frames;
    this.drawOver(camera);
    this.on.frame?.();
  }

  /** Has the eye moved since the frame before? Then all details come a moment after it has stopped. */
  moved() {
    const { eye } = this, now = [eye.azimuth, eye.elevation, eye.height, ...eye.target.toArray(), this.width, this.panes.length].join();
    const has = this.eyeBefore !== undefined && this.eyeBefore !== now;
    this.eyeBefore = now;
    if (has) {
      for (const pane of this.panes) pane.makeCoarse();
      clearTimeout(this.settle);
      this.settle = setTimeout(() => this.draw(), 180);
    }
    return has;
  }

  drawOver(camera) {
    const { pen } = this, w = this.paneWidth;
    pen.clearRect(0, 0, this.width, this.height);
    this.drawAxes(pen, camera);
    if (this.labelPoints) this.drawLabels(pen, camera);
    if (this.area?.length > 1) {
      pen.beginPath();
      const path = this.areaPath();
      path.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
      pen.closePath();
      pen.fillStyle = 'rgba(194,65,12,0.14)';
      pen.strokeStyle = this.theme.pick;
      pen.fill();
      pen.stroke();
    }
    if (this.showsCross) {
      pen.strokeStyle = this.theme.pick;
      pen.beginPath();
      const x = this.width - w / 2, y = this.height / 2;
      if (this.areaTool) {
        const { x: dx, y: dy } = this.keyBox;
        pen.rect(x - dx * this.height, y - dy * this.height, 2 * dx * this.height, 2 * dy * this.height);
      }
      pen.moveTo(x - 10, y); pen.lineTo(x + 10, y); pen.moveTo(x, y - 10); pen.lineTo(x, y + 10);
      pen.stroke();
    }
    if (this.panes.length > 1) {
      pen.strokeStyle = 'rgba(128,128,128,0.6)';
      pen.beginPath(); pen.moveTo(w, 0); pen.lineTo(w, this.height); pen.stroke();
    }
  }
  drawAxes(pen, camera) {
    const right = new THREE.Vector3(), up = new THREE.Vector3(), back = new THREE.Vector3(), x0 = 44, y0 = this.height - 44, length = 26;
    camera.matrixWorld.extractBasis(right, up, back);
    const axes = ['x', 'y', 'z'].map((k, i) => ({ name: k, colour: this.theme.axes[i], x: right[k] * length, y: -up[k] * length, z: back[k] }));
    axes.sort((a, b) => a.z - b.z);
    pen.font = '600 11px system-ui, sans-serif';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    pen.lineWidth = 2;
    for (const { name, colour, x, y } of axes) {
      pen.strokeStyle = pen.fillStyle = colour;
      pen.beginPath(); pen.moveTo(x0, y0); pen.lineTo(x0 + x, y0 + y); pen.stroke();
      pen.fillText(name, x0 + 1.36 * x, y0 + 1.36 * y);
    }
    pen.lineWidth = 1;
  }
  drawLabels(pen, camera) {
    const { places, texts, textOf } = this.labelPoints, pane = this.panes[this.panes.length - 1], w = this.paneWidth, shift = this.width - w;
    const p = new THREE.Vector3(), place = new THREE.Vector3(), ray = new THREE.Raycaster(), taken = [], slack = 0.02 * pane.scene.radius, clip = pane.faces.material.uniforms.clip.value;
    pen.font = '600 11px system-ui, sans-serif';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    let n = 0, tried = 0;
    for (let i = 0; i < texts.length && n < most.labels && tried < most.tried; ++i) {
      const half = 3.4 * texts[i].length + 4;
      for (let k = 0; k < places[i].length; k += 3) {
        p.copy(place.fromArray(places[i], k)).project(camera);
        if (p.z < -1 || p.z > 1 || Math.abs(p.x) > 1 || Math.abs(p.y) > 1) continue;
        const x = ((p.x + 1) * w) / 2 + shift, y = ((1 - p.y) * this.height) / 2;
        if (taken.some(([a, b, c]) => Math.abs(a - x) < half + c && Math.abs(b - y) < 15)) continue;
        ++tried;
        ray.setFromCamera(new THREE.Vector2(p.x, p.y), camera);
        const hit = firstMet(pane.scene.isCad ? pane.cadTree() : pane.tree(), ray.ray, clip);
        if (isCutOff(place, clip) || (hit && hit.distance < ray.ray.origin.distanceTo(place) - slack)) continue;
        // Of a face it is the face itself that is met, from without: from within what the plane cuts covers it.
        if (textOf && (!hit || textOf(hit.faceIndex >> 1) !== texts[i] || hit.face.normal.dot(ray.ray.direction) > 0)) continue;
        taken.push([x, y, half]);
        pen.fillStyle = this.theme.label;
        pen.beginPath();
        pen.roundRect(x - half, y - 7.5, 2 * half, 15, 4);
        pen.fill();
        pen.fillStyle = this.theme.labelText;
        pen.fillText(texts[i], x, y + 0.5);
        ++n;
        break;
      }
    }
    this.nLabels = n;
  }

  /** The pane at a pixel, and where in it. */
  at(x) {
    const i = Math.min(this.panes.length - 1, Math.max(0, Math.floor(x / this.paneWidth)));
    return { pane: this.panes[i], x: x - i * this.paneWidth, index: i };
  }
  async find(x, y, kind = this.kind) {
    if (!this.panes.length) return null;
    const at = this.at(x), camera = this.eye.update(this.paneWidth / this.height);
    const found = await find(at.pane, camera, this.paneWidth, this.height, at.x, y, kind);
    if (found) found.pane = at.pane;
    return found;
  }

  /** Hexes within a polygon of the screen. */
  async pickArea(path, add) {
    const at = this.at(path[0][0]), camera = this.eye.update(this.paneWidth / this.height), shift = at.index * this.paneWidth;
    if (this.through) await at.pane.scene.inside();
    this.on.area(at.pane, hexesWithin(at.pane, camera, this.paneWidth, this.height, path.map(([x, y]) => [x - shift, y]), this.through), add);
    this.draw();
  }
  /** The same with the box around the cross. */
  pickKeyBox(add) {
    const x = this.width - this.paneWidth / 2, y = this.height / 2, dx = this.keyBox.x * this.height, dy = this.keyBox.y * this.height;
    return this.pickArea([[x - dx, y - dy], [x + dx, y - dy], [x + dx, y + dy], [x - dx, y + dy]], add);
  }
  growKeyBox(dx, dy) {
    const grown = (size, by, most) => Math.max(0.01, Math.min(most, size * 1.15 ** by));
    this.keyBox = { x: grown(this.keyBox.x, dx, this.paneWidth / this.height / 2), y: grown(this.keyBox.y, dy, 0.5) };
  }

  areaPath() {
    if (this.area.tool === 'lasso') return this.area;
    const [a, b] = [this.area[0], this.area[this.area.length - 1]];
    return [a, [b[0], a[1]], b, [a[0], b[1]]];
  }
  listen() {
    const { canvas } = this, held = new Map();
    let travelled = 0, spread = 0;
    const place = (e) => { const box = canvas.getBoundingClientRect(); return [e.clientX - box.left, e.clientY - box.top]; };
    canvas.addEventListener('contextmenu', (e) => e.preventDefault());
    canvas.addEventListener('pointerdown', (e) => {
      canvas.focus({ preventScroll: true });
      this.showsCross = false;
      canvas.setPointerCapture(e.pointerId);
      held.set(e.pointerId, place(e));
      travelled = spread = 0;
      const tool = this.areaTool ?? (e.ctrlKey || e.metaKey ? 'box' : e.altKey ? 'lasso' : null);
      if (tool && e.button === 0 && held.size === 1) {
        this.area = [place(e)];
        this.area.tool = tool;
      }
      this.on.hover(null);
    });
    canvas.addEventListener('pointermove', (e) => {
      const [x, y] = place(e);
      if (!held.has(e.pointerId)) {
        this.hoverAt = [x, y];
        this.hoverSoon();
        return;
      }
      const [px, py] = held.get(e.pointerId);
      held.set(e.pointerId, [x, y]);
      travelled += Math.abs(x - px) + Math.abs(y - py);
      if (held.size === 2) {
        const [a, b] = [...held.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]);
        if (spread > 0) this.eye.zoom(spread / now);
        spread = now;
        this.eye.move((x - px) / 2 / this.height, (y - py) / 2 / this.height);
      } else if (this.area) this.area.push([x, y]);
      else if (travelled > 3) {
        canvas.classList.add('drag');
        if (e.shiftKey || e.buttons & 6) this.eye.move((x - px) / this.height, (y - py) / this.height);
        else this.eye.turn((x - px) * 0.008, (y - py) * 0.008);
      }
      this.draw();
    });
    const release = async (e) => {
      if (!held.delete(e.pointerId)) return;
      canvas.classList.remove('drag');
      const add = e.shiftKey || e.ctrlKey || e.metaKey, area = this.area;
      if (area && travelled > 6) {
        const path = this.areaPath();
        this.area = null;
        await this.pickArea(path, e.shiftKey);
        return;
      }
      this.area = null;
      if (travelled <= 3 && e.button === 0 && e.type === 'pointerup') {
        this.picking = this.find(...place(e)).then((found) => this.on.pick(found, add));
        await this.picking;
      }
      this.draw();
    };
    canvas.addEventListener('pointerup', release);
    canvas.addEventListener('pointercancel', release);
    canvas.addEventListener('pointerleave', () => { this.hoverAt = null; this.on.hover(null); });
    canvas.addEventListener('wheel', (e) => {
      e.preventDefault();
      const [x, y] = place(e), at = this.at(x);
      this.eye.zoom(Math.exp(e.deltaY * (e.deltaMode ? 0.04 : 0.0013)), (at.x - this.paneWidth / 2) / this.height, (y - this.height / 2) / this.height);
      this.draw();
    }, { passive: false });
    // Who came by keys sees where Enter picks.
    canvas.addEventListener('focus', () => { this.showsCross = canvas.matches(':focus-visible'); this.draw(); });
    canvas.addEventListener('blur', () => { this.showsCross = false; this.draw(); });
  }
  hoverSoon() {
    if (this.hovering) return;
    this.hovering = true;
    requestAnimationFrame(async () => {
      const at = this.hoverAt;
      if (at) {
        const start = performance.now(), found = await this.find(...at);
        this.pickTime = performance.now() - start;
        if (this.hoverAt) this.on.hover(found, at);
      }
      this.hovering = false;
      if (this.hoverAt && at && (this.hoverAt[0] !== at[0] || this.hoverAt[1] !== at[1])) this.hoverSoon();
    });
  }
}
