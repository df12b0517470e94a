// The figures about space: both skeletons before and after alignment (table 5 of the HFUT-MMD
// paper), residuals, the floor with the Kinect's zones, shares of inferred joints, and bone
// lengths.
// SPDX-License-Identifier: Apache-2.0
import { scaleLinear } from "d3-scale";

import { addHatches, axes, bars, chooser, drawn, hatch, margin, marker, path } from "./chart.js";
import { boxOf, drawBody } from "./bodies.js";
import { beforeMove, distance, place, rowAt, stateOf } from "./data.js";

/// Returns the direction along the floor in which the Kinect looks. Without a Kinect, it is the
/// direction towards a person who faces +z.
export const facing = (take) => (take.floors.length > 0 ? take.floors[0].forward : [0, 0, -1]);

/// The view from the Kinect's position: x to the right, y up.
function frontOf(forward) {
  const [fx, , fz] = forward;
  return (p) => [-(p[0] * fz - p[2] * fx), p[1]];
}

const residualOf = (take, space, row, [a, b]) => {
  const ours = take.bodies[space.body], theirs = take.bodies[space.onto];
  if (stateOf(ours, row, a) === 0 || stateOf(theirs, row, b) === 0) return null;
  return distance(place(ours, row, a), place(theirs, row, b));
};

/// Draws a panel of table 5. `moved(body, point)` returns the position at which a point is drawn.
function panel(svg, box, take, bodies, row, moved, map) {
  const all = boxOf(bodies, row, (body, p) => map(moved(body, p)));
  if (all === null) return;
  const pad = 0.15, width = all[2] - all[0] + 2 * pad, height = all[3] - all[1] + 2 * pad;
  const scale = Math.min(box.width / width, box.height / height);
  const cx = (all[0] + all[2]) / 2, cy = (all[1] + all[3]) / 2;
  const to = ([x, y]) => [box.left + box.width / 2 + (x - cx) * scale, box.top + box.height / 2 - (y - cy) * scale];
  const g = svg.append("g");
  const metre = scale;
  g.append("path").attr("class", "ruler").attr("d", `M${box.left + 6} ${box.top + box.height - 8}v4h${metre.toFixed(1)}v-4`);
  g.append("text").attr("class", "label").attr("x", box.left + 10 ).attr("y", box.top + box.height - 9).text("1 m");
  for (const body of bodies) drawBody(g, body, row, (p) => to(map(moved(body, p))));
}

/// The moved body in figures 5 to 7. If no body has pairs of joints, `space` is not set.
export class SpaceChoice {
  constructor(take) {
    this.spaces = take.spaces.filter((space) => space.pairs.length > 0);
    this.space = this.spaces[0];
    this.changed = [];
  }
  /// If there are several moved bodies, adds a list to choose one.
  offer() {
    if (this.spaces.length < 2) return;
    chooser("table5", "Stream", this.spaces.map((space) => `${space.stream} on ${space.onto_stream}`), 0, (i) => {
      this.space = this.spaces[i];
      for (const change of this.changed) change();
    });
  }
}

/// Returns the panels of table 5. Each has a name, the positions of a body's points, and a viewing
/// direction.
function panelsOf(take, space) {
  const moved = take.bodies[space.body], front = frontOf(facing(take)), above = (p) => [p[0], -p[2]];
  const before = (body, p) => (body === moved ? beforeMove(space, p) : p), after = (_, p) => p;
  const panels = [["after, front", after, front], ["after, from above", after, above]];
  return space.once_per_take ? [["before, front", before, front], ["before, from above", before, above], ...panels] : panels;
}

export function table5(take, clock, choice) {
  if (!choice.space) return;
  let row = seenRow(take, choice.space);
  const figure = drawn("table5", (svg, width) => {
    const space = choice.space, bodies = [take.bodies[space.onto], take.bodies[space.body]], panels = panelsOf(take, space);
    const columns = width < 560 ? 2 : panels.length, height = 240;
    panels.forEach(([name, moved, map], i) => {
      const w = width / columns, left = (i % columns) * w, top = Math.floor(i / columns) * (height + 24);
      svg.append("rect").attr("class", "panel").attr("x", left + 2).attr("y", top + 20).attr("width", w - 4).attr("height", height);
      svg.append("text").attr("class", "name").attr("x", left + 6).attr("y", top + 14).text(name);
      panel(svg, { left: left + 2, top: top + 20, width: w - 4, height }, take, bodies, row, moved, map);
    });
    return Math.ceil(panels.length / columns) * (height + 24);
  });
  const stamp = document.querySelector("#table5 .at");
  const tell = () => {
    if (stamp !== null) stamp.textContent = `${take.seconds[row].toFixed(2)} s`;
  };
  tell();
  choice.changed.push(() => {
    row = seenRow(take, choice.space);
    figure.redraw();
    tell();
  });
  let touched = false;
  clock.listen(() => {
    touched = touched || clock.now > 0;
    const now = rowAt(take.seconds, clock.now);
    if (!touched || now === row || !figure.visible()) return;
    // Drawing four skeletons takes longer than a frame of the player, so they are drawn ten times
    // per second.
    if (clock.playing && Math.abs(take.seconds[now] - take.seconds[row]) < 0.1 * clock.speed) return;
    row = now;
    figure.redraw();
    tell();
  });
}

/// Returns a row near one third of the take in which all paired joints are tracked.
function seenRow(take, space) {
  const ours = take.bodies[space.body], start = Math.floor(take.rows / 3);
  for (let i = 0; i < take.rows; ++i) {
    const row = (start + i) % take.rows;
    if (space.pairs.every(([a]) => stateOf(ours, row, a) === 2)) return row;
  }
  return start;
}

export function residualByJoint(choice) {
  if (!choice.space) return;
  const figure = drawn("residual", (svg, width) => {
    const space = choice.space;
    const most = Math.max(...space.joints.map((j) => j.after_m)) * 100;
    const names = space.joints.map((j) => j.joint);
    return bars(svg, width, names, scaleLinear().domain([0, 1.1 * most]), { x: "distance, rms / cm" }, (i, y, height, x) => {
      const value = 100 * space.joints[i].after_m;
      svg.append("rect").attr("class", "fill kinect").attr("x", x(0)).attr("y", y).attr("width", x(value) - x(0)).attr("height", height);
      svg.append("text").attr("class", "value").attr("x", x(value) + 4).attr("y", y + height / 2).attr("dy", "0.35em").text(value.toFixed(1));
    });
  });
  choice.changed.push(figure.redraw);
}

/// Returns the distance of each pair over time, in cm: the rms of all pairs and the worst pair.
function residualsOf(take, space) {
  const rms = new Array(take.rows), worst = new Array(take.rows);
  for (let row = 0; row < take.rows; ++row) {
    let sum = 0, count = 0, most = 0;
    for (const pair of space.pairs) {
      const d = residualOf(take, space, row, pair);
      if (d === null) continue;
      sum += d * d;
      count += 1;
      most = Math.max(most, d);
    }
    rms[row] = count === 0 ? null : 100 * Math.sqrt(sum / count);
    worst[row] = count === 0 ? null : 100 * most;
  }
  return { rms, worst };
}

export function residualOverTime(take, view, choice) {
  if (!choice.space) return;
  let { rms, worst } = residualsOf(take, choice.space);
  const chart = view.add("residual-time", 170, (svg, at, x) => {
    const first = rowAt(take.seconds, view.domain[0]), last = rowAt(take.seconds, view.domain[1]);
    const step = Math.max(1, (last - first + 1) / (2 * at.width));
    const points = { rms: [], worst: [] };
    let high = 1;
    for (let from = first; from <= last; from += step) {
      const a = Math.floor(from), b = Math.min(last + 1, Math.max(a + 1, Math.floor(from + step)));
      let r = null, w = null;
      for (let row = a; row < b; ++row) {
        if (rms[row] === null) continue;
        r = Math.max(r ?? 0, rms[row]);
        w = Math.max(w ?? 0, worst[row]);
      }
      points.rms.push(r === null ? null : [take.seconds[a], r]);
      points.worst.push(w === null ? null : [take.seconds[a], w]);
      high = Math.max(high, w ?? 0);
    }
    const y = scaleLinear([0, high], [at.top + at.height, at.top]).nice(4);
    axes(svg, at, x, y, { x: "time / s", y: "distance / cm" });
    const line = (list) => path(list.map((p) => (p === null ? null : [x(p[0]), y(p[1])])));
    svg.append("path").attr("class", "line thin faint kinect").attr("d", line(points.worst));
    svg.append("path").attr("class", "line kinect").attr("d", line(points.rms));
  });
  choice.changed.push(() => {
    ({ rms, worst } = residualsOf(take, choice.space));
    chart.redraw();
  });
}

/// Draws the floor from above: paths of the root joints, the Kinect and its zones.
export function floorFigure(take, clock) {
  const bodies = take.bodies.filter((body) => body.in_take_space);
  if (bodies.length === 0) return;
  const floor = take.floors[0];
  const forward = facing(take), right = [-forward[2], 0, forward[0]];
  const origin = floor ? floor.camera : [0, 0, 0];
  // The Kinect is at the bottom and looks upwards.
  const flat = (p) => [(p[0] - origin[0]) * right[0] + (p[2] - origin[2]) * right[2], (p[0] - origin[0]) * forward[0] + (p[2] - origin[2]) * forward[2]];
  const ways = bodies.map((body) => {
    const way = [];
    for (let row = 0; row < take.rows; ++row) way.push(stateOf(body, row, 0) === 0 ? null : flat(place(body, row, 0)));
    return way;
  });
  const seen = ways.flat().filter((p) => p !== null);
  if (seen.length === 0) return;
  let low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  const include = ([x, y]) => {
    low = [Math.min(low[0], x), Math.min(low[1], y)];
    high = [Math.max(high[0], x), Math.max(high[1], y)];
  };
  seen.forEach(include);
  if (floor) [[0, 0], [-floor.largest[1] * 0.6, floor.largest[1]], [floor.largest[1] * 0.6, floor.largest[1]]].forEach(include);
  const pad = 0.4;
  let to = null;
  const dots = bodies.map((body) => marker("floor", `now ${body.colour}`));
  const now = () => {
    const row = rowAt(take.seconds, clock.now);
    ways.forEach((way, i) => dots[i].move(...(way[row] === null ? [0, 0] : to(way[row])), way[row] !== null));
  };
  const figure = drawn("floor", (svg, width) => {
    const span = [high[0] - low[0] + 2 * pad, high[1] - low[1] + 2 * pad];
    const plot = Math.min(width - margin.left - margin.right, 560);
    const scale = Math.min(plot / span[0], 380 / span[1]);
    const at = { left: margin.left, top: margin.top, width: span[0] * scale, height: span[1] * scale };
    const x = scaleLinear([low[0] - pad, high[0] + pad], [at.left, at.left + at.width]);
    const y = scaleLinear([low[1] - pad, high[1] + pad], [at.top + at.height, at.top]);
    to = ([a, b]) => [x(a), y(b)];
    axes(svg, at, x, y, { x: "to the right / m", y: floor ? "from the Kinect / m" : "z / m", yTicks: Math.ceil(span[1]) });
    if (floor) drawZones(svg, floor, to);
    const lines = { mocap: "line mocap", kinect: "line thin kinect" };
    ways.forEach((way, i) => svg.append("path").attr("class", lines[bodies[i].colour]).attr("d", path(way.map((p) => (p === null ? null : to(p))))));
    now();
    return at.top + at.height + margin.bottom;
  }, () => to && now());
  clock.listen(() => figure.visible() && now());
}

function drawZones(svg, floor, to) {
  const half = ((floor.field_deg / 2) * Math.PI) / 180;
  const arc = (r) => Array.from({ length: 25 }, (_, i) => {
    const angle = -half + (2 * half * i) / 24;
    return to([r * Math.sin(angle), r * Math.cos(angle)]);
  });
  for (const [name, [near, far]] of [["largest", floor.largest], ["best", floor.best]]) {
    const outline = [...arc(near), ...arc(far).reverse()];
    svg.append("path").attr("class", `zone ${name}`).attr("d", `${path(outline)}Z`);
    const [lx, ly] = to([0, far]);
    svg.append("text").attr("class", "zone-name").attr("x", lx).attr("y", ly + 13).attr("text-anchor", "middle")
      .text(`${name === "best" ? "best" : "largest"} ${near} to ${far} m`);
  }
  const [kx, ky] = to([0, 0]);
  svg.append("rect").attr("class", "fill kinect").attr("x", kx - 8).attr("y", ky - 3).attr("width", 16).attr("height", 6);
  svg.append("text").attr("class", "name").attr("x", kx + 12).attr("y", ky + 4).text("Kinect");
}

/// Draws for each joint the shares of tracked, inferred and missing rows.
export function stateFigure(take) {
  const points = take.bodies.filter((b) => b.kind === "points");
  const kinect = points.findIndex((b) => b.colour === "kinect");
  let body = points[Math.max(0, kinect)];
  if (!body) return;
  const figure = drawn("states", (svg, width) => {
    const shares = take.joint_states[take.bodies.indexOf(body)].map((c) => {
      const all = Math.max(1, c[0] + c[1] + c[2]);
      return { missing: (100 * c[0]) / all, inferred: (100 * c[1]) / all };
    });
    const order = shares.map((_, j) => j).sort((a, b) => shares[b].inferred + shares[b].missing - shares[a].inferred - shares[a].missing);
    const most = Math.max(1, ...shares.map((s) => s.inferred + s.missing));
    addHatches(svg);
    return bars(svg, width, order.map((j) => body.joint_names[j]), scaleLinear().domain([0, 1.15 * most]), { x: "of all rows / %" }, (i, y, height, x) => {
      const s = shares[order[i]];
      svg.append("rect").attr("fill", hatch(svg, body.colour)).attr("x", x(0)).attr("y", y).attr("width", x(s.inferred) - x(0)).attr("height", height);
      svg.append("rect").attr("class", `lane-box ${body.colour}`).attr("x", x(s.inferred)).attr("y", y).attr("width", x(s.missing) - x(0)).attr("height", height);
      svg.append("text").attr("class", "value").attr("x", x(s.inferred + s.missing) + 4).attr("y", y + height / 2).attr("dy", "0.35em")
        .text((s.inferred + s.missing).toFixed(1));
    });
  });
  if (points.length < 2) return;
  chooser("states", "Stream", points.map((one) => one.name), points.indexOf(body), (i) => {
    body = points[i];
    figure.redraw();
  });
}

/// Draws the mean length of each bone, with standard deviation and range as differences from the
/// mean.
export function boneFigure(take) {
  const bones = take.bones;
  if (bones.length === 0) return;
  const order = [...bones].sort((a, b) => b.deviation_m - a.deviation_m);
  const most = 100 * Math.max(...order.map((b) => 3 * b.deviation_m));
  const several = bones.some((b) => b.body !== bones[0].body);
  const name = (b) => (several ? `${take.bodies[b.body].name} ` : "") + take.bodies[b.body].joint_names[b.joint];
  drawn("bones", (svg, width) =>
    bars(svg, width, order.map(name), scaleLinear().domain([-most, most]), { x: "length minus its mean / cm" }, (i, y, height, x) => {
      const b = order[i], clamp = (v) => Math.max(-most, Math.min(most, v)), middle = y + height / 2;
      const shortest = clamp(100 * (b.shortest_m - b.mean_m)), longest = clamp(100 * (b.longest_m - b.mean_m));
      svg.append("path").attr("class", "line thin kinect").attr("d", `M${x(shortest)} ${middle}H${x(longest)}`);
      const d = 100 * b.deviation_m;
      svg.append("rect").attr("class", "fill kinect").attr("x", x(-d)).attr("y", y).attr("width", x(d) - x(-d)).attr("height", height)
        .append("title").text(`${(100 * b.mean_m).toFixed(1)} ± ${d.toFixed(1)} cm`);
    }),
  );
}
