// Two shapes side by side in one WebGL canvas, each with its own pose; drawn only when something changed.
import { PerspectiveCamera, Quaternion, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import { Marker } from "./markers.js";

const FIELD = 28; // degrees of view, small: little perspective
const UP = { x: [0, 0, Math.SQRT1_2, Math.SQRT1_2], y: [0, 0, 0, 1], z: [-Math.SQRT1_2, 0, 0, Math.SQRT1_2] };

/** The first sight: a little from aside and from above, so that depth shows (as kfmaps.viz has it). */
const ASIDE = new Quaternion()
  .setFromAxisAngle(new Vector3(1, 0, 0), (10 * Math.PI) / 180)
  .multiply(new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), (-20 * Math.PI) / 180));
const TURNTABLE = 0.7; // radians a second

class View {
  constructor(surface, box) {
    this.surface = surface;
    this.box = box;
    this.scene = new Scene();
    this.scene.add(surface.group);
    this.camera = new PerspectiveCamera(FIELD, 1, 0.01, 100);
    this.markers = [];
    this.turn = new Quaternion(); // by hand
    this.base = new Quaternion(); // alignment and up axis
    this.zoom = 1;
    this.shift = new Vector2();
  }

  /** The points of a cloud as wide as 1.3 times their mean distance, for a view of so many pixels. */
  dots(height) {
    const pixels = height / (2 * Math.tan((FIELD * Math.PI) / 360));
    this.surface.material.uniforms.size.value = (1.3 / Math.sqrt(this.surface.count)) * pixels;
  }

  /** Puts camera and shape where the pose says; `fit` is the radius that fills the view at zoom 1. */
  settle(fit, width, height) {
    const half = Math.tan((FIELD * Math.PI) / 360) * Math.min(1, width / height);
    const distance = (1.04 * fit) / Math.sin(Math.atan(half)) / this.zoom;
    this.camera.aspect = width / height;
    this.camera.near = Math.max(distance - 3 * fit, distance / 200);
    this.camera.far = distance + 3 * fit;
    this.camera.position.set(0, 0, distance);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.surface.group.quaternion.copy(this.turn).multiply(this.base);
    this.surface.group.position.set(this.shift.x * fit, this.shift.y * fit, 0);
    this.surface.group.updateMatrixWorld();
    for (const marker of this.markers) marker.settle(this, height);
  }
}

export class Stage {
  constructor(element, shapes, boxes) {
    this.element = element;
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, powerPreference: "high-performance" });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.domElement.className = "canvas";
    this.renderer.domElement.setAttribute("aria-hidden", "true");
    element.prepend(this.renderer.domElement);
    this.views = shapes.map((shape, i) => new View(shape, boxes[i]));
    this.fit = Math.max(...shapes.map((s) => s.radius));
    this.linked = true;
    this.asked = false;
    this.onDraw = () => {};
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  resize() {
    const { width, height } = this.element.getBoundingClientRect();
    this.renderer.setSize(Math.max(width, 1), Math.max(height, 1));
    this.draw();
  }

  /** Draws at the next frame, once however often it is asked. */
  draw() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.paint();
      this.onDraw();
    });
  }

  paint() {
    const all = this.element.getBoundingClientRect();
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    for (const view of this.views) {
      const { left, bottom, width, height } = view.box.getBoundingClientRect();
      if (width < 1 || height < 1) continue;
      view.settle(this.fit, width, height);
      view.dots(height * this.renderer.getPixelRatio());
      const place = [left - all.left, all.bottom - bottom, width, height];
      this.renderer.setViewport(...place);
      this.renderer.setScissor(...place);
      this.renderer.render(view.scene, view.camera);
    }
  }

  /** The views that a movement of number `i` moves. */
  moved(i) {
    return this.linked ? this.views : [this.views[i]];
  }

  rotate(i, x, y, roll = 0) {
    const step = new Quaternion()
      .setFromAxisAngle(new Vector3(0, 1, 0), x)
      .multiply(new Quaternion().setFromAxisAngle(new Vector3(1, 0, 0), y))
      .multiply(new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), roll));
    for (const view of this.moved(i)) view.turn.premultiply(step).normalize();
    this.draw();
  }

  zoom(i, factor) {
    for (const view of this.moved(i)) view.zoom = Math.min(Math.max(view.zoom * factor, 0.2), 60);
    this.draw();
  }

  /** Moves by pixels of the view. */
  shift(i, x, y) {
    const { width, height } = this.views[i].box.getBoundingClientRect();
    for (const view of this.moved(i)) {
      const scale = 2.1 / Math.min(width, height) / view.zoom;
      view.shift.add(new Vector2(x * scale, -y * scale));
    }
    this.draw();
  }

  /** All views back to where they began: with `frame` for the camera, or with the axis `up` upwards. */
  reset(up, frame, rotations) {
    this.views.forEach((view, i) => {
      view.turn.copy(ASIDE);
      view.zoom = 1;
      view.shift.set(0, 0);
      if (up === "auto") view.base.copy(frame);
      else view.base.fromArray(UP[up]);
      if (rotations[i]) view.base.multiply(rotations[i]);
    });
    this.draw();
  }

  /** A turntable: all shapes turn about what is upright in them, until it is switched off. */
  spin(on) {
    this.spinning = on;
    if (!on || this.turning) return;
    this.turning = true;
    let last = null;
    const step = (now) => {
      if (!this.spinning) {
        this.turning = false;
        return;
      }
      const seconds = last === null ? 0 : Math.min((now - last) / 1000, 0.1);
      last = now;
      const about = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), seconds * TURNTABLE);
      for (const view of this.views) view.turn.multiply(about).normalize();
      this.draw();
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  /** The vertex of view `i` under a point of the window, or -1; with `inside` the point in its triangle, or null. */
  pick(i, clientX, clientY, inside = false) {
    const view = this.views[i];
    const { left, top, width, height } = view.box.getBoundingClientRect();
    const at = new Vector2(((clientX - left) / width) * 2 - 1, 1 - ((clientY - top) / height) * 2);
    view.settle(this.fit, width, height);
    const caster = new Raycaster();
    caster.setFromCamera(at, view.camera);
    return view.surface.pick(caster.ray, inside);
  }

  /** Where a vertex of view `i` is in the window, and whether it is in sight. */
  project(i, vertex) {
    const view = this.views[i];
    const { left, top, width, height } = view.box.getBoundingClientRect();
    view.settle(this.fit, width, height);
    const p = view.surface.world(vertex).project(view.camera);
    const visible = view.surface.sees(vertex, view.camera.position);
    return { x: left + ((p.x + 1) / 2) * width, y: top + ((1 - p.y) / 2) * height, visible };
  }

  /** Turns all views so that the surface around a point of view `i` faces the viewer. */
  face(i, at) {
    const view = this.views[i];
    const normal = view.surface.normal(at).applyQuaternion(view.base);
    // The shortest way would tilt what is upright; so first about that, then towards it.
    const about = Math.atan2(normal.x, normal.z), tilt = Math.asin(Math.min(Math.max(normal.y, -1), 1));
    for (const each of this.views) {
      each.turn.setFromAxisAngle(new Vector3(1, 0, 0), tilt)
        .multiply(new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), -about));
    }
  }

  /** Puts a point of view `i` in its middle, `zoom` times as large. */
  centre(i, at, zoom) {
    const view = this.views[i];
    const place = view.surface.place(at).applyQuaternion(view.base).applyQuaternion(view.turn);
    view.zoom = zoom;
    view.shift.set(-place.x / this.fit, -place.y / this.fit);
    this.draw();
  }

  /** Replaces the markers of view `i`: [{vertex, colour, text}]. */
  mark(i, marks) {
    const view = this.views[i];
    for (const marker of view.markers) marker.remove(view.scene);
    view.markers = marks.map((mark) => new Marker(mark, view.scene));
    this.draw();
  }

  /** What is on the canvas now, drawn `scale` times as fine, as a canvas of its own. */
  picture(scale) {
    const before = this.renderer.getPixelRatio();
    this.renderer.setPixelRatio(scale);
    this.paint();
    const copy = document.createElement("canvas");
    copy.width = this.renderer.domElement.width;
    copy.height = this.renderer.domElement.height;
    copy.getContext("2d").drawImage(this.renderer.domElement, 0, 0);
    this.renderer.setPixelRatio(before);
    this.paint();
    return copy;
  }
}
