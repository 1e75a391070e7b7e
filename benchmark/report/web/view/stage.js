// SPDX-License-Identifier: MIT
// The canvas: one camera, one or two clouds beside each other, drawn only when something changed.
import {BufferAttribute, BufferGeometry, Color, Line, LineBasicMaterial, Mesh, MeshBasicMaterial,
        PerspectiveCamera, Scene, SphereGeometry, Vector3, WebGLRenderer} from 'three';

import {listenToPointers} from './pointers.js';

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({canvas, antialias: false, powerPreference: 'high-performance'});
    this.renderer.setScissorTest(true);
    // Colours reach the screen as they are given. Versions before 152 do that without being told.
    this.renderer.outputColorSpace = 'srgb-linear';
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(50, 1, 0.3, 5000);
    this.camera.up.set(0, 0, 1);
    /** The centre of turns, in the middle of the picture. */
    this.target = new Vector3();
    listenToPointers(this);
    this.sides = [];
    this.path = new Line(new BufferGeometry(), new LineBasicMaterial());
    this.path.frustumCulled = false;
    this.sensor = new Mesh(new SphereGeometry(0.25, 16, 12), new MeshBasicMaterial());
    this.chosen = new Mesh(new SphereGeometry(1, 16, 12), new MeshBasicMaterial({transparent: true, opacity: 0.75}));
    this.chosen.visible = false;
    this.scene.add(this.path, this.sensor, this.chosen);
    this.pending = false;
    this.frames = 0;
    this.detail = 1;
    this.draw = () => {
      this.pending = false;
      this.adaptDetail(performance.now() - this.asked);
      this.render(this.detail);
      clearTimeout(this.rest);
      if (this.detail < 1) this.rest = setTimeout(this.drawAll, 400);
    };
    this.drawAll = () => this.render();
    new ResizeObserver(() => this.request()).observe(canvas.parentElement);
  }

  /** Draws soon, once. */
  request() {
    if (this.pending) return;
    this.pending = true;
    this.asked = performance.now();
    requestAnimationFrame(this.draw);
  }

  /** Where frames come late, fewer points are drawn until the view is at rest. */
  adaptDetail(waited) {
    const factor = waited > 50 ? Math.max(0.3, 40 / waited) : waited < 25 ? 1.1 : 1;
    this.detail = Math.min(1, Math.max(0.02, this.detail * factor));
  }

  /** @param clouds one or two */
  setClouds(clouds) {
    this.sides.forEach((cloud) => this.scene.remove(cloud.group));
    this.sides = clouds;
    clouds.forEach((cloud) => this.scene.add(cloud.group));
    this.request();
  }

  setTrajectory(positions) {
    this.path.geometry.dispose();
    this.path.geometry = new BufferGeometry();
    this.path.geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
  }

  setColours(ground, mark) {
    this.renderer.setClearColor(new Color(...ground), 1);
    for (const part of [this.path, this.sensor, this.chosen]) part.material.color.setRGB(...mark);
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    if (width !== this.width || height !== this.height || ratio !== this.ratio) {
      Object.assign(this, {width, height, ratio});
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
    }
    return width > 0 && height > 0;
  }

  /** @param detail share of the points of which a part may do */
  render(detail = 1) {
    if (!this.resize() || this.sides.length === 0) return;
    const each = this.width / this.sides.length;
    this.camera.aspect = each / this.height;
    this.camera.updateProjectionMatrix();
    this.chosen.scale.setScalar(0.009 * this.camera.position.distanceTo(this.chosen.position));
    for (let side = 0; side < this.sides.length; ++side) {
      for (let other = 0; other < this.sides.length; ++other) {
        this.sides[other].group.visible = other === side;
      }
      this.sides[side].setDetail(detail);
      this.renderer.setViewport(side * each, 0, each, this.height);
      this.renderer.setScissor(side * each, 0, each, this.height);
      this.renderer.render(this.scene, this.camera);
    }
    ++this.frames;
  }

  /** Looks at `target` from `offset` away, both [x, y, z] in metres. */
  look(target, offset) {
    this.target.set(...target);
    this.camera.position.set(target[0] + offset[0], target[1] + offset[1], target[2] + offset[2]);
    this.aim();
  }

  aim() {
    this.camera.lookAt(this.target);
    this.request();
  }

  /** Looks at the box between two corners from `direction`, from as near as shows all of it. */
  lookAtBox(low, high, direction) {
    this.resize();
    const each = this.width / Math.max(1, this.sides.length);
    const tangent = Math.tan(this.camera.fov * Math.PI / 360), margin = 1.04;
    const tangents = [tangent * each / Math.max(1, this.height) / margin, tangent / margin];
    const towards = new Vector3(...direction).normalize();
    const right = new Vector3(0, 0, 1).cross(towards).normalize();
    const axes = [right, towards.clone().cross(right)];
    const centre = low.map((value, axis) => (value + high[axis]) / 2);
    let range = 5;
    for (let corner = 0; corner < 8; ++corner) {
      const offset = new Vector3(...centre.map((value, axis) => (corner >> axis & 1 ? high : low)[axis] - value));
      axes.forEach((axis, i) => {
        range = Math.max(range, offset.dot(towards) + Math.abs(offset.dot(axis)) / tangents[i]);
      });
    }
    this.look(centre, towards.multiplyScalar(range).toArray());
  }

  /** Turns by angles in radians about the target, never over the top. */
  turn(azimuth, polar) {
    const offset = this.camera.position.clone().sub(this.target);
    const range = offset.length();
    const angle = Math.atan2(offset.y, offset.x) + azimuth;
    const up = Math.min(Math.PI / 2 - 0.001, Math.max(-1.5, Math.asin(offset.z / range) + polar));
    offset.set(Math.cos(angle) * Math.cos(up), Math.sin(angle) * Math.cos(up), Math.sin(up));
    this.camera.position.copy(this.target).addScaledVector(offset, range);
    this.aim();
  }

  /** Moves along the ground by shares of the distance to the target. */
  move(right, forward) {
    const ahead = this.target.clone().sub(this.camera.position);
    const range = ahead.length();
    ahead.setZ(0).normalize();
    this.shift(new Vector3(ahead.y, -ahead.x, 0).multiplyScalar(right * range)
        .addScaledVector(ahead, forward * range));
  }

  /** Moves the picture by pixels to the right and down, at the distance of the target. */
  pan(right, down) {
    const range = this.camera.position.distanceTo(this.target);
    const pixel = 2 * range * Math.tan(this.camera.fov * Math.PI / 360) / this.height;
    this.shift(new Vector3(-right, down, 0).multiplyScalar(pixel).applyQuaternion(this.camera.quaternion));
  }

  shift(step) {
    this.camera.position.add(step);
    this.target.add(step);
    this.aim();
  }

  /** Scales the distance to the target. @param at the place that stays where it is, from locate */
  zoom(factor, at = {x: 0, y: 0}) {
    const {position} = this.camera, {target} = this;
    const range = position.distanceTo(target);
    this.camera.updateMatrixWorld();
    const fixed = new Vector3(at.x, at.y, 0.5).unproject(this.camera).sub(position).setLength(range).add(position);
    position.lerp(fixed, 1 - factor);
    target.lerp(fixed, 1 - factor);
    this.aim();
  }

  /** Side, and place within it from -1 to 1, of a place on the canvas in its pixels. */
  locate(x, y) {
    const each = this.width / this.sides.length;
    const side = Math.max(0, Math.min(this.sides.length - 1, Math.floor(x / each)));
    return {side, x: 2 * (x - side * each) / each - 1, y: 1 - 2 * y / this.height, each};
  }

  mark(position) {
    this.chosen.visible = position !== null;
    if (position) this.chosen.position.set(...position);
    this.request();
  }
}
