// Shows one take and the results of all methods for it, moving side by side. Each picture also
// shows the truth in the background. Dragging one picture rotates all pictures.
// SPDX-License-Identifier: Apache-2.0
import { unpacked } from "../../page/assets/data.js";
import { PageClock } from "../../page/assets/clock.js";

const heightOfView = 2.3; // m
const colourOf = { truth: "--mocap", kinect: "--kinect", imu: "--imu", method: "--ink", both: "--both" };

function readMotion(element) {
  const motion = JSON.parse(element.textContent);
  for (const body of motion.bodies) {
    body.joints = body.parents.length;
    body.positions = unpacked(body.positions);
    body.states = body.states && unpacked(body.states);
    body.cm = body.cm && unpacked(body.cm);
  }
  motion.rows = motion.bodies[0].positions.length / (3 * motion.bodies[0].joints);
  return motion;
}

/// Returns the middle of a body over all rows and its lowest joint. The camera looks at this point.
function middleOf(body) {
  const middle = [0, 0, 0], count = body.positions.length / 3;
  let lowest = Infinity;
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < 3; ++k) middle[k] += body.positions[3 * i + k] / count;
    lowest = Math.min(lowest, body.positions[3 * i + 1]);
  }
  return [middle[0], lowest, middle[2]];
}

/// Draws bodies as seen by a camera above the floor, at an angle about the vertical axis.
class StickView {
  constructor(motion, body, camera) {
    this.motion = motion;
    this.bodies = [motion.bodies[0], body];
    this.camera = camera;
    this.figure = document.createElement("figure");
    this.canvas = this.figure.appendChild(document.createElement("canvas"));
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${body.name}, moving`);
    this.label = this.figure.appendChild(document.createElement("figcaption"));
    this.name = this.label.appendChild(document.createElement("strong"));
    this.name.textContent = body.name;
    this.error = this.label.appendChild(document.createElement("span"));
  }
  spot(body, row, joint) {
    const i = 3 * (row * body.joints + joint), p = body.positions, { yaw, pitch, middle } = this.camera;
    const x = p[i] - middle[0], y = p[i + 1] - middle[1], z = p[i + 2] - middle[2];
    const right = Math.cos(yaw) * x - Math.sin(yaw) * z, near = Math.sin(yaw) * x + Math.cos(yaw) * z;
    const up = Math.cos(pitch) * y - Math.sin(pitch) * near;
    return [this.width / 2 + right * this.scale, 0.9 * this.height - up * this.scale];
  }
  draw(row) {
    const ratio = window.devicePixelRatio || 1;
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    this.scale = this.height / heightOfView;
    if (this.canvas.width !== Math.round(this.width * ratio)) this.canvas.width = Math.round(this.width * ratio);
    if (this.canvas.height !== Math.round(this.height * ratio)) this.canvas.height = Math.round(this.height * ratio);
    const pen = this.canvas.getContext("2d"), style = getComputedStyle(document.documentElement);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, this.width, this.height);
    pen.lineCap = "round";
    this.bodies.forEach((body, n) => {
      if (n === 0 && body === this.bodies[1]) return;
      pen.strokeStyle = style.getPropertyValue(colourOf[body.colour]).trim();
      pen.globalAlpha = n === 0 ? 0.38 : 1;
      pen.lineWidth = n === 0 ? 5 : 3;
      this.drawBones(pen, body, row);
    });
    pen.globalAlpha = 1;
    const cm = this.bodies[1].cm;
    this.error.textContent = cm ? ` ${cm[row].toFixed(1)} cm` : "";
  }
  drawBones(pen, body, row) {
    body.parents.forEach((parent, joint) => {
      if (parent < 0) return;
      const at = row * body.joints;
      const state = body.states ? Math.min(body.states[at + joint], body.states[at + parent]) : 2;
      if (state === 0) return;
      pen.setLineDash(state === 1 ? [4, 5] : []);
      pen.beginPath();
      pen.moveTo(...this.spot(body, row, parent));
      pen.lineTo(...this.spot(body, row, joint));
      pen.stroke();
    });
  }
}

/// Dragging or the arrow keys rotate the camera.
function turnBy(view, camera, draw) {
  const turn = (x, y) => {
    camera.yaw -= x;
    camera.pitch = Math.min(Math.max(camera.pitch + y, -0.3), 1.5);
    draw();
  };
  let last = null;
  view.canvas.addEventListener("pointerdown", (event) => {
    last = [event.clientX, event.clientY];
    view.canvas.setPointerCapture(event.pointerId);
  });
  view.canvas.addEventListener("pointermove", (event) => {
    if (last === null) return;
    turn(0.01 * (event.clientX - last[0]), 0.01 * (event.clientY - last[1]));
    last = [event.clientX, event.clientY];
  });
  for (const end of ["pointerup", "pointercancel"]) view.canvas.addEventListener(end, () => (last = null));
  view.canvas.tabIndex = 0;
  view.canvas.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
    if (!way) return;
    event.preventDefault();
    turn(...way);
  });
}

function start(section) {
  const motion = readMotion(document.getElementById("motion-data"));
  const degree = Math.PI / 180, camera = { yaw: 25 * degree, pitch: 8 * degree, middle: middleOf(motion.bodies[0]) };
  const clock = new PageClock((motion.rows - 1) / motion.rate_hz);
  const grid = section.querySelector(".side-by-side"), play = section.querySelector(".play");
  const scrub = section.querySelector(".scrub"), time = section.querySelector(".time");
  const views = [...motion.bodies.slice(1), motion.bodies[0]].map((body) => new StickView(motion, body, camera));
  const draw = () => {
    const row = Math.min(motion.rows - 1, Math.round(clock.now * motion.rate_hz));
    for (const view of views) view.draw(row);
    scrub.value = String(row);
    time.textContent = `${clock.now.toFixed(1)} s of ${clock.length.toFixed(1)} s`;
    play.textContent = clock.playing ? "Pause" : "Play";
  };
  for (const view of views) {
    grid.append(view.figure);
    turnBy(view, camera, draw);
  }
  scrub.max = String(motion.rows - 1);
  scrub.addEventListener("input", () => {
    clock.play(false);
    clock.go(Number(scrub.value) / motion.rate_hz);
  });
  play.addEventListener("click", () => clock.play(!clock.playing));
  clock.listen(draw);
  new ResizeObserver(draw).observe(grid);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  draw();
}

const section = document.getElementById("motion");
if (section) start(section);
