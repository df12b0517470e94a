// The figures about time: when each stream has samples, how far rows are from raw samples, and
// figure 7 of the HFUT-MMD paper.
// SPDX-License-Identifier: Apache-2.0
import { scaleLinear } from "d3-scale";

import { addHatches, axes, chooser, dots, hatch, margin, path, rings, zoomButtons } from "./chart.js";
import { rowAt } from "./data.js";

const laneName = (lane) => (lane.part ? `${lane.stream} ${lane.part}` : lane.stream);

/// Draws one bar for each stream: measured parts are filled, inferred parts hatched, missing parts
/// empty.
export function laneFigure(take, view) {
  const row = 24, lanes = take.lanes;
  view.add("lanes", row * lanes.length, (svg, at, x) => {
    addHatches(svg);
    axes(svg, at, x, scaleLinear([0, 1], [at.top + at.height, at.top]), { x: "time / s", yTicks: 0 });
    const bins = lanes.length > 0 ? lanes[0].tracked.length : 0, step = take.length_s / Math.max(1, bins);
    lanes.forEach((lane, l) => {
      const top = at.top + l * row + 12, height = row - 14;
      svg.append("rect").attr("class", `lane-box ${lane.colour}`).attr("x", at.left).attr("y", top).attr("width", at.width).attr("height", height);
      for (const [shares, below, fill] of [[lane.tracked, null, null], [lane.inferred, lane.tracked, hatch(svg, lane.colour)]]) {
        let d = "";
        for (let b = 0; b < bins; ++b) {
          const from = Math.max(at.left, x(b * step)), to = Math.min(at.left + at.width, x((b + 1) * step));
          if (to <= from || shares[b] <= 0) continue;
          const h = shares[b] * height, base = top + height * (1 - (below ? below[b] : 0));
          d += `M${from.toFixed(1)} ${base.toFixed(1)}V${(base - h).toFixed(1)}H${to.toFixed(1)}V${base.toFixed(1)}Z`;
        }
        const bar = svg.append("path").attr("d", d);
        if (fill) bar.attr("fill", fill);
        else bar.attr("class", `fill ${lane.colour}`);
      }
      svg.append("text").attr("class", "name over").attr("x", at.left + 2).attr("y", top - 3).text(laneName(lane));
    });
    for (const mark of take.marks) {
      if (mark.seconds < view.domain[0] || mark.seconds > view.domain[1]) continue;
      svg.append("path").attr("class", "mark").attr("d", `M${x(mark.seconds)} ${at.top}v${at.height}`)
        .append("title").text(`${mark.kind} ${mark.text}`);
    }
  });
}

/// Draws the time to the nearest raw sample and the half-width of the stamps' intervals, in
/// milliseconds.
export function distanceFigure(take, view) {
  const lanes = take.lanes.filter((lane) => lane.resampled);
  if (lanes.length === 0) return;
  const largest = Math.max(1, ...lanes.flatMap((lane) => [...lane.nearest_raw_ms, ...(lane.interval_ms ?? [])]));
  view.add("distance", 150, (svg, at, x) => {
    const y = scaleLinear([0, Math.min(largest, 1000)], [at.top + at.height, at.top]).nice(4);
    axes(svg, at, x, y, { x: "time / s", y: "distance / ms" });
    const bins = lanes[0].tracked.length, step = take.length_s / bins;
    for (const lane of lanes) {
      const points = (values) =>
        values.map((v, b) => {
          const t = (b + 0.5) * step;
          return t < view.domain[0] || t > view.domain[1] || lane.tracked[b] + lane.inferred[b] === 0 ? null : [x(t), y(Math.min(v, 1000))];
        });
      svg.append("path").attr("class", `line ${lane.colour}`).attr("d", path(points(lane.nearest_raw_ms)));
      if (lane.interval_known) svg.append("path").attr("class", `line dashed ${lane.colour}`).attr("d", path(points(lane.interval_ms)));
    }
  });
}

/// Returns the arrays that figure 7 draws: those of the detail, or all rows if the page stores
/// every row.
function curveOf(take, detail) {
  const body = take.bodies[detail.body], space = take.spaces.find((s) => s.body === detail.body);
  if (detail.seconds) {
    const pairs = detail.onto_positions.length / detail.seconds.length / 3;
    return {
      body, space, seconds: detail.seconds,
      value: (row, joint, axis) => detail.positions[3 * (row * body.joints + joint) + axis],
      state: (row, joint) => detail.state[row * body.joints + joint],
      onto: (row, pair, axis) => detail.onto_positions[3 * (row * pairs + pair) + axis],
    };
  }
  const onto = space ? take.bodies[space.onto] : null;
  return {
    body, space, seconds: take.seconds,
    value: (row, joint, axis) => body.positions[3 * (row * body.joints + joint) + axis],
    state: (row, joint) => body.state[row * body.joints + joint],
    onto: (row, pair, axis) => onto.positions[3 * (row * onto.joints + space.pairs[pair][1]) + axis],
  };
}

/// Returns the length in seconds of the longest time without the joint, or null.
function longestGap(curve, joint) {
  let best = null, begin = null;
  for (let row = 0; row < curve.seconds.length; ++row) {
    if (curve.state(row, joint) !== 0) {
      begin = null;
      continue;
    }
    if (begin === null) begin = row;
    const length = curve.seconds[row] - curve.seconds[begin];
    if (best === null || length > best.length) best = { length, middle: (curve.seconds[row] + curve.seconds[begin]) / 2 };
  }
  return best;
}

/// Returns the raw samples of a joint in the visible time range: [seconds, value, state].
function rawOf(detail, curve, joint, axis, [begin, end]) {
  const out = [];
  if (detail.has_raw) {
    const joints = curve.body.joints;
    for (let r = 0; r < detail.raw_seconds.length; ++r) {
      const t = detail.raw_seconds[r], state = detail.raw_state[r * joints + joint];
      if (t < begin || t > end || state === 0) continue;
      out.push([t, detail.raw_positions[3 * (r * joints + joint) + axis], state]);
    }
    return out;
  }
  for (const t of detail.near_seconds) {
    if (t < begin || t > end) continue;
    const row = rowAt(curve.seconds, t + 1e-4), state = curve.state(row, joint);
    if (state !== 0) out.push([t, curve.value(row, joint, axis), state]);
  }
  return out;
}

/// Returns the visible time ranges in which the joint is missing.
function missing(curve, joint, first, last) {
  const out = [];
  let begin = null;
  for (let row = first; row <= last; ++row) {
    const gone = curve.state(row, joint) === 0;
    if (gone && begin === null) begin = row;
    if (begin !== null && (!gone || row === last)) {
      out.push([curve.seconds[Math.max(first, begin - 1)], curve.seconds[row]]);
      begin = null;
    }
  }
  return out;
}

/// Returns the index of a wrist, because wrists move most.
function usualJoint(names) {
  return ["WristRight", "HandRight", "RightHand"].map((name) => names.indexOf(name)).find((j) => j >= 0) ?? 0;
}

export function figure7(take, view) {
  if (take.details.length === 0) return;
  let detail = take.details[0], curve = curveOf(take, detail);
  const state = { joint: usualJoint(curve.body.joint_names), axis: 1 };
  const gap = longestGap(curve, state.joint);
  const middle = gap ? gap.middle : Math.min(detail.begin_s + 3, take.length_s / 2);
  const half = Math.min(3, Math.max(1, document.querySelector("#figure7 .plot").clientWidth / 300));
  if (take.length_s > 2 * half) view.show(middle - half, middle + half);
  const letters = ["x", "y (up)", "z"];
  const chart = view.add("figure7", 260, (svg, at, x) => {
    const [begin, end] = view.domain;
    const first = rowAt(curve.seconds, begin), last = Math.min(curve.seconds.length - 1, rowAt(curve.seconds, end) + 1);
    const stride = Math.max(1, Math.floor((last - first) / (2 * at.width)));
    const pair = curve.space ? curve.space.pairs.findIndex(([a]) => a === state.joint) : -1;
    const raw = rawOf(detail, curve, state.joint, state.axis, view.domain);
    const ours = [], theirs = [], values = raw.map((r) => r[1]);
    for (let row = first; row <= last; row += stride) {
      const t = curve.seconds[row];
      const value = curve.state(row, state.joint) === 0 ? null : curve.value(row, state.joint, state.axis);
      ours.push([t, value]);
      if (value !== null) values.push(value);
      if (pair < 0) continue;
      theirs.push([t, curve.onto(row, pair, state.axis)]);
      values.push(theirs[theirs.length - 1][1]);
    }
    const low = Math.min(...values), high = Math.max(...values), room = Math.max(0.01, 0.06 * (high - low));
    const y = scaleLinear(values.length ? [low - room, high + room] : [0, 1], [at.top + at.height, at.top]).nice(5);
    axes(svg, at, x, y, { x: "time / s", y: `${letters[state.axis]} / m`, yTicks: 6 });
    const clip = "figure7-inside";
    svg.append("clipPath").attr("id", clip).append("rect").attr("x", at.left).attr("y", at.top).attr("width", at.width).attr("height", at.height);
    const inside = svg.append("g").attr("clip-path", `url(#${clip})`);
    const own = curve.body.colour;
    for (const [from, to] of missing(curve, state.joint, first, last)) {
      inside.append("rect").attr("class", "gap").attr("x", x(from)).attr("width", Math.max(1, x(to) - x(from))).attr("y", at.top).attr("height", at.height);
    }
    const line = (points) => path(points.map(([t, v]) => (v === null ? null : [x(t), y(v)])));
    inside.append("path").attr("class", "line thin mocap").attr("d", line(theirs));
    inside.append("path").attr("class", `line ${own}`).attr("d", line(ours));
    const spacing = at.width / Math.max(1, raw.length), size = spacing > 6 ? 3 : spacing > 2 ? 2 : 1.2;
    const placed = (wanted) => raw.filter((r) => r[2] === wanted).map((r) => [x(r[0]), y(r[1])]);
    inside.append("path").attr("class", `dots ${own}`).attr("stroke-width", 2 * size).attr("d", dots(placed(2)));
    inside.append("path").attr("class", `rings ${own}`).attr("d", rings(placed(1), size + 0.5));
  });
  if (take.details.length > 1) {
    chooser("figure7", "Stream", take.details.map((d) => take.bodies[d.body].name), 0, (i) => {
      detail = take.details[i];
      curve = curveOf(take, detail);
      state.joint = usualJoint(curve.body.joint_names);
      offerJoints(curve.body.joint_names, state.joint);
      chart.redraw();
    });
  }
  const offerJoints = chooser("figure7", "Joint", curve.body.joint_names, state.joint, (joint) => {
    state.joint = joint;
    chart.redraw();
  });
  chooser("figure7", "Axis", letters, state.axis, (axis) => {
    state.axis = axis;
    chart.redraw();
  });
  zoomButtons("figure7", view);
}
