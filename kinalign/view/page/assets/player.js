// SPDX-License-Identifier: Apache-2.0
// The 3D view: both skeletons, lines between paired joints, the nodes' axes, and the Kinect with
// its zones, on a floor with squares of 1 m. A hollow joint is inferred, or it is missing and drawn
// at its last seen position.
// SPDX-License-Identifier: Apache-2.0
import {
  AmbientLight, BufferGeometry, Color, CylinderBufferGeometry, DirectionalLight, EdgesGeometry, Float32BufferAttribute, Group, InstancedMesh,
  LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, Points, Quaternion,
  Scene, ShaderMaterial, Vector3, WebGLRenderer, BoxBufferGeometry, DoubleSide,
} from "three";

import { place, placeBetween, rowAt, stateOf, turned } from "./data.js";
import { facing } from "./space_figures.js";

const up = new Vector3(0, 1, 0);
const colourNames = ["--mocap", "--kinect", "--imu", "--ink", "--faint", "--paper", "--residual"];

/// Returns the page's colours as CSS defines them at this moment.
function colours() {
  const style = getComputedStyle(document.documentElement);
  return Object.fromEntries(colourNames.map((name) => [name.slice(2), new Color(style.getPropertyValue(name).trim())]));
}

/// Draws cylinders between pairs of points.
class Sticks {
  constructor(most, radius, scene) {
    this.material = new MeshLambertMaterial();
    this.mesh = new InstancedMesh(new CylinderBufferGeometry(radius, radius, 1, 8), this.material, Math.max(1, most));
    this.mesh.frustumCulled = false;
    this.count = 0;
    scene.add(this.mesh);
    this.matrix = new Matrix4();
    this.turn = new Quaternion();
    this.along = new Vector3();
    this.middle = new Vector3();
    this.size = new Vector3();
  }
  begin() {
    this.count = 0;
  }
  add(a, b) {
    this.along.set(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    const length = this.along.length();
    if (length < 1e-6) return;
    this.middle.set((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2);
    this.turn.setFromUnitVectors(up, this.along.divideScalar(length));
    this.matrix.compose(this.middle, this.turn, this.size.set(1, length, 1));
    this.mesh.setMatrixAt(this.count++, this.matrix);
  }
  end() {
    this.mesh.count = this.count;
    this.mesh.instanceMatrix.needsUpdate = true;
    this.mesh.visible = this.count > 0;
  }
}

/// Draws discs and rings at joints. Their size on the screen does not depend on the distance.
class JointDots {
  constructor(most, scene) {
    this.geometry = new BufferGeometry();
    this.places = new Float32BufferAttribute(new Float32Array(3 * most), 3);
    this.hollow = new Float32BufferAttribute(new Float32Array(most), 1);
    this.geometry.setAttribute("position", this.places);
    this.geometry.setAttribute("hollow", this.hollow);
    this.material = new ShaderMaterial({
      uniforms: { colour: { value: new Color() }, size: { value: 9 } },
      vertexShader:
        "attribute float hollow; varying float ring; uniform float size;" +
        "void main() { ring = hollow; gl_PointSize = hollow > 0.5 ? size * 1.4 : size;" +
        " gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
      fragmentShader:
        "varying float ring; uniform vec3 colour;" +
        "void main() { float r = length(gl_PointCoord - 0.5); if (r > 0.5 || (ring > 0.5 && r < 0.32)) discard;" +
        " gl_FragColor = vec4(colour, 1.0); }",
    });
    this.points = new Points(this.geometry, this.material);
    this.points.frustumCulled = false;
    scene.add(this.points);
    this.count = 0;
  }
  begin() {
    this.count = 0;
  }
  add(p, hollow) {
    this.places.setXYZ(this.count, p[0], p[1], p[2]);
    this.hollow.setX(this.count++, hollow ? 1 : 0);
  }
  end() {
    this.geometry.setDrawRange(0, this.count);
    this.places.needsUpdate = this.hollow.needsUpdate = true;
  }
}

/// Returns for each row the last row so far in which each joint was seen; -1: never.
function lastSeen(body, rows) {
  const seen = new Int32Array(rows * body.joints);
  for (let j = 0; j < body.joints; ++j) {
    let last = -1;
    for (let row = 0; row < rows; ++row) {
      if (stateOf(body, row, j) !== 0) last = row;
      seen[row * body.joints + j] = last;
    }
  }
  return seen;
}

class Body3D {
  constructor(body, rows, scene) {
    this.body = body;
    this.seen = lastSeen(body, rows);
    this.bones = new Sticks(body.joints, body.kind === "clip" ? 0.013 : 0.009, scene);
    this.unsure = new Sticks(body.joints, 0.0035, scene);
    this.dots = new JointDots(body.joints, scene);
  }
  colour(c) {
    for (const part of [this.bones, this.unsure]) part.material.color.copy(c[this.body.colour]);
    this.dots.material.uniforms.colour.value.copy(c[this.body.colour]);
  }
  show(row, share) {
    const { body } = this, at = (j) => placeBetween(body, row, j, share);
    for (const part of [this.bones, this.unsure, this.dots]) part.begin();
    for (let j = 0; j < body.joints; ++j) {
      const state = stateOf(body, row, j);
      if (state === 0) {
        const last = this.seen[row * body.joints + j];
        if (last >= 0) this.dots.add(place(body, last, j), true);
        continue;
      }
      const p = at(j), parent = body.parents[j];
      if (body.kind === "points") this.dots.add(p, state === 1);
      if (parent < 0 || stateOf(body, row, parent) === 0) continue;
      const sure = state === 2 && stateOf(body, row, parent) === 2;
      (sure ? this.bones : this.unsure).add(p, at(parent));
    }
    for (const part of [this.bones, this.unsure, this.dots]) part.end();
  }
}

/// Draws lines between the joints of each pair.
class Residuals3D {
  constructor(take, scene) {
    this.take = take;
    this.sticks = new Sticks(take.spaces.reduce((n, s) => n + s.pairs.length, 0), 0.005, scene);
  }
  show(row, share) {
    this.sticks.begin();
    for (const space of this.take.spaces) {
      const ours = this.take.bodies[space.body], theirs = this.take.bodies[space.onto];
      for (const [a, b] of space.pairs) {
        if (stateOf(ours, row, a) === 0 || stateOf(theirs, row, b) === 0) continue;
        this.sticks.add(placeBetween(ours, row, a, share), placeBetween(theirs, row, b, share));
      }
    }
    this.sticks.end();
  }
}

/// Draws the x, y and z axis of each node, from dark to light, at its bone.
class Axes3D {
  constructor(take, scene) {
    this.body = take.bodies[take.node_body];
    this.nodes = take.nodes.filter((node) => node.axes).map((node) => ({ node, joint: this.body.joint_names.indexOf(node.joint) }));
    this.parts = [0, 1, 2].map(() => new Sticks(this.nodes.length, 0.006, scene));
    this.hollow = new Sticks(3 * this.nodes.length, 0.002, scene);
  }
  colour(c) {
    this.parts.forEach((part, i) => part.material.color.copy(c.imu).lerp(c.paper, 0.32 * i));
    this.hollow.material.color.copy(c.imu);
  }
  show(row, share) {
    for (const part of [...this.parts, this.hollow]) part.begin();
    for (const { node, joint } of this.nodes) {
      if (joint < 0) continue;
      const from = this.middleOf(row, joint, share), q = node.axes.subarray(4 * row, 4 * row + 4);
      [[0.16, 0, 0], [0, 0.16, 0], [0, 0, 0.16]].forEach((axis, i) => {
        const to = turned(q, axis).map((v, k) => v + from[k]);
        (node.valid[row] ? this.parts[i] : this.hollow).add(from, to);
      });
    }
    for (const part of [...this.parts, this.hollow]) part.end();
  }
  /// Returns the middle of the bone that begins at the joint.
  middleOf(row, joint, share) {
    const child = this.body.parents.indexOf(joint), a = placeBetween(this.body, row, joint, share);
    if (child < 0) return a;
    const b = placeBetween(this.body, row, child, share);
    return a.map((v, k) => (v + b[k]) / 2);
  }
}

/// Returns the height of the floor. In 2 % of the rows the lowest joint is below it.
function floorHeight(take) {
  const body = take.bodies.find((b) => b.in_take_space && b.kind === "clip") ?? take.bodies[0];
  const lows = [];
  for (let row = 0; row < take.rows; row += Math.max(1, Math.floor(take.rows / 500))) {
    let low = Infinity;
    for (let j = 0; j < body.joints; ++j) if (stateOf(body, row, j) !== 0) low = Math.min(low, place(body, row, j)[1]);
    if (low < Infinity) lows.push(low);
  }
  lows.sort((a, b) => a - b);
  return lows.length === 0 ? 0 : lows[Math.floor(lows.length * 0.02)];
}

function lines(points, material, scene) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(points, 3));
  const made = new LineSegments(geometry, material);
  scene.add(made);
  return made;
}

class Floor3D {
  constructor(take, height, middle, scene) {
    this.grid = new LineBasicMaterial();
    this.zone = new LineBasicMaterial();
    this.fill = new MeshBasicMaterial({ transparent: true, opacity: 0.08, side: DoubleSide, depthWrite: false });
    this.zones = new Group();
    const points = [], half = 6, cx = Math.round(middle[0]), cz = Math.round(middle[2]);
    for (let i = -half; i <= half; ++i) {
      points.push(cx + i, height, cz - half, cx + i, height, cz + half, cx - half, height, cz + i, cx + half, height, cz + i);
    }
    lines(points, this.grid, scene);
    for (const floor of take.floors) this.addZones(floor, height);
    scene.add(this.zones);
  }
  addZones(floor, height) {
    const { camera, forward } = floor, right = [-forward[2], 0, forward[0]];
    const half = ((floor.field_deg / 2) * Math.PI) / 180, steps = 32;
    const at = (r, i) => {
      const angle = -half + (2 * half * i) / steps, ahead = r * Math.cos(angle), aside = r * Math.sin(angle);
      return [camera[0] + ahead * forward[0] + aside * right[0], height + 0.004, camera[2] + ahead * forward[2] + aside * right[2]];
    };
    const edges = [];
    for (const [near, far] of [floor.largest, floor.best]) {
      for (const r of [near, far]) for (let i = 0; i < steps; ++i) edges.push(...at(r, i), ...at(r, i + 1));
      for (const i of [0, steps]) edges.push(...at(near, i), ...at(far, i));
    }
    lines(edges, this.zone, this.zones);
    const faces = [], [near, far] = floor.best;
    for (let i = 0; i < steps; ++i) faces.push(...at(near, i), ...at(far, i), ...at(far, i + 1), ...at(near, i), ...at(far, i + 1), ...at(near, i + 1));
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(faces, 3));
    this.zones.add(new Mesh(geometry, this.fill));
    const kinect = new LineSegments(new EdgesGeometry(new BoxBufferGeometry(0.25, 0.07, 0.07)), this.zone);
    kinect.position.set(...camera);
    this.kinect = kinect;
    kinect.lookAt(camera[0] + forward[0], camera[1], camera[2] + forward[2]);
    this.zones.add(kinect);
  }
  colour(c) {
    this.grid.color.copy(c.faint);
    for (const part of [this.zone, this.fill]) part.color.copy(c.kinect);
  }
}

/// A camera that moves around a point. Dragging rotates the camera; a pinch, or the wheel with
/// Ctrl, changes its distance.
class Orbit {
  constructor(canvas, moved) {
    this.camera = new PerspectiveCamera(35, 1, 0.05, 100);
    this.target = new Vector3();
    this.azimuth = 0;
    this.height = 0.12;
    this.distance = 3.7;
    const pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      pointers.set(event.pointerId, event);
      canvas.setPointerCapture(event.pointerId);
    });
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => pointers.delete(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      const last = pointers.get(event.pointerId);
      if (last === undefined) return;
      const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY;
      if (pointers.size === 2) {
        const other = [...pointers.values()].find((p) => p.pointerId !== event.pointerId);
        const apart = (p) => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY);
        this.closer(apart(last) / Math.max(1, apart(event)));
      } else {
        this.azimuth -= dx * 0.008;
        this.height = Math.min(1.5, Math.max(-0.2, this.height + dy * 0.006));
      }
      pointers.set(event.pointerId, event);
      moved();
    });
    canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      this.closer(Math.exp(event.deltaY * 0.001));
      moved();
    }, { passive: false });
  }
  closer(factor) {
    this.distance = Math.min(20, Math.max(0.8, this.distance * factor));
  }
  place() {
    const flat = Math.cos(this.height) * this.distance;
    this.camera.position.set(
      this.target.x + flat * Math.sin(this.azimuth), this.target.y + this.distance * Math.sin(this.height),
      this.target.z + flat * Math.cos(this.azimuth));
    this.camera.lookAt(this.target);
  }
}

/// The player. Its constructor throws an exception if the browser has no WebGL.
export class Player {
  constructor(canvas, take, clock) {
    this.take = take;
    this.clock = clock;
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.scene = new Scene();
    this.scene.add(new AmbientLight(0xffffff, 0.88));
    const sun = new DirectionalLight(0xffffff, 0.3);
    sun.position.set(1, 3, 2);
    this.scene.add(sun);
    const drawnBodies = take.bodies.filter((body) => body.in_take_space);
    this.bodies = drawnBodies.map((body) => new Body3D(body, take.rows, this.scene));
    this.followed = drawnBodies[0];
    this.residuals = new Residuals3D(take, this.scene);
    const worn = take.nodes.length > 0 && take.bodies[take.node_body].in_take_space;
    this.axes = worn ? new Axes3D(take, this.scene) : null;
    const height = floorHeight(take);
    this.floor = new Floor3D(take, height, this.followed ? this.centre(0) : [0, 0, 0], this.scene);
    this.middleHeight = height + 0.92;
    this.orbit = new Orbit(canvas, () => this.draw());
    this.frames = 0;
    this.look("front");
    this.recolour();
    this.resize();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    clock.listen(() => this.show());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.recolour());
    this.show();
  }
  /// Returns the position of the first body's root joint in this row, or where it was last seen.
  centre(row) {
    const last = this.bodies[0].seen[row * this.followed.joints];
    return place(this.followed, last >= 0 ? last : row, 0);
  }
  look(from) {
    const [fx, , fz] = facing(this.take), front = Math.atan2(-fx, -fz);
    this.orbit.azimuth = front + (from === "side" ? Math.PI / 2 : 0);
    this.orbit.height = from === "top" ? 1.5 : 0.12;
    this.draw();
  }
  toggle(part, on) {
    if (part === "residuals") this.residuals.sticks.material.visible = on;
    if (part === "zones") this.floor.zones.visible = on;
    if (part === "axes" && this.axes) for (const s of [...this.axes.parts, this.axes.hollow]) s.material.visible = on;
    this.draw();
  }
  recolour() {
    const c = colours();
    this.renderer.setClearColor(c.paper);
    for (const body of this.bodies) body.colour(c);
    this.residuals.sticks.material.color.copy(c.residual);
    if (this.axes) this.axes.colour(c);
    this.floor.colour(c);
    this.draw();
  }
  /// Makes a copy for printing. WebGL shows its image only later, which is too late for a printer.
  copyForPaper() {
    const copy = this.canvas.parentElement.querySelector(".paper") ?? document.createElement("canvas");
    copy.className = "paper";
    copy.width = this.canvas.width;
    copy.height = this.canvas.height;
    copy.getContext("2d").drawImage(this.canvas, 0, 0);
    this.canvas.after(copy);
  }
  resize() {
    const box = this.canvas.parentElement, width = box.clientWidth, height = box.clientHeight;
    if (width === 0 || height === 0) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    for (const body of this.bodies) body.dots.material.uniforms.size.value = 7 * ratio;
    this.orbit.camera.aspect = width / height;
    this.orbit.camera.updateProjectionMatrix();
    this.draw();
  }
  show() {
    const { seconds, stride, rows } = this.take, row = rowAt(seconds, this.clock.now);
    // If the page does not store every row, joints move in a straight line between stored rows.
    const apart = row + 1 < rows ? seconds[row + 1] - seconds[row] : 0;
    const share = stride > 1 && apart > 0 ? Math.min(1, (this.clock.now - seconds[row]) / apart) : 0;
    if (row === this.row && share === this.share) return;
    this.row = row;
    this.share = share;
    for (const body of this.bodies) body.show(row, share);
    this.residuals.show(row, share);
    if (this.axes) this.axes.show(row, share);
    if (this.followed) {
      const [x, , z] = this.centre(row);
      this.orbit.target.set(x, this.middleHeight, z);
    }
    this.draw();
  }
  draw() {
    if (!this.orbit) return;
    this.orbit.place();
    // If the view is from the Kinect's position, the Kinect's box would hide the person.
    const kinect = this.floor.kinect;
    if (kinect) kinect.visible = kinect.position.distanceTo(this.orbit.camera.position) > 2;
    this.renderer.render(this.scene, this.orbit.camera);
    this.frames += 1;
    this.canvas.dataset.frames = this.frames;
  }
}
