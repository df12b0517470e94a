// Compares a node's signals with the signals that follow from the mocap's motion of its bone.
// SPDX-License-Identifier: Apache-2.0
import { scaleLinear } from "d3-scale";

import { axes, chooser, dots, path, zoomButtons } from "./chart.js";
import { rowAt } from "./data.js";

const degrees = 180 / Math.PI;
const choices = [
  ["magnitude", (v, k) => Math.hypot(v[3 * k], v[3 * k + 1], v[3 * k + 2])],
  ["x", (v, k) => v[3 * k]],
  ["y", (v, k) => v[3 * k + 1]],
  ["z", (v, k) => v[3 * k + 2]],
];

/// Returns the raw samples [seconds, value] in a time range; none if there are more than `most`.
function rawWithin(raw, [begin, end], most) {
  if (!raw) return [];
  const first = rowAt(raw.seconds, begin), last = rowAt(raw.seconds, end), out = [];
  if (last - first > most) return [];
  for (let r = first; r <= last; ++r) {
    if (raw.seconds[r] >= begin && raw.seconds[r] <= end) out.push([raw.seconds[r], raw.value(r)]);
  }
  return out;
}

/// Draws two curves over time. Rows without a value of the node are null.
function compared(take, view, id, label, of) {
  view.add(id, 150, (svg, at, x) => {
    const first = rowAt(take.seconds, view.domain[0]), last = rowAt(take.seconds, view.domain[1]);
    const step = Math.max(1, Math.floor((last - first) / (3 * at.width)));
    const { valid, curves, raw } = of();
    const samples = rawWithin(raw, view.domain, at.width / 2);
    let low = Infinity, high = -Infinity;
    const lines = curves.map(({ colour, value }) => {
      const points = [];
      for (let k = first; k <= last; k += step) {
        if (valid[k] === 0) {
          points.push(null);
          continue;
        }
        const v = value(k);
        low = Math.min(low, v);
        high = Math.max(high, v);
        points.push([take.seconds[k], v]);
      }
      return { colour, points };
    });
    for (const [, v] of samples) {
      low = Math.min(low, v);
      high = Math.max(high, v);
    }
    if (low > high) [low, high] = [0, 1];
    // The axis begins at zero, unless that would hide small changes, as with gravity in an
    // acceleration.
    if (low > 0 && high - low > 0.3 * high) low = 0;
    const y = scaleLinear([low, high], [at.top + at.height, at.top]).nice(4);
    axes(svg, at, x, y, { x: "time / s", y: label });
    for (const { colour, points } of lines) {
      svg.append("path").attr("class", `line ${colour === "mocap" ? "thin" : ""} ${colour}`)
        .attr("d", path(points.map((p) => (p === null ? null : [x(p[0]), y(p[1])]))));
    }
    svg.append("path").attr("class", "dots imu").attr("stroke-width", samples.length > at.width / 6 ? 3 : 5)
      .attr("d", dots(samples.map(([t, v]) => [x(t), y(v)])));
  });
}

export function nodeFigures(take, view) {
  const nodes = take.nodes.filter((node) => node.rate || node.acceleration || node.orientation_error);
  if (nodes.length === 0) return;
  const chosen = { node: 0, part: 0 };
  const node = () => nodes[chosen.node], part = () => choices[chosen.part][1];
  const rawOf = (name, factor) => {
    const one = node();
    return one.raw_seconds ? { seconds: one.raw_seconds, value: (r) => factor * part()(one[name], r) } : null;
  };
  const both = (ours, theirs, factor) => () => ({
    raw: rawOf(`raw_${ours}`, factor),
    valid: node().valid,
    curves: [
      { colour: "mocap", value: (k) => factor * part()(node()[theirs], k) },
      { colour: "imu", value: (k) => factor * part()(node()[ours], k) },
    ],
  });
  if (nodes[0].rate) compared(take, view, "node-rate", "rate / (°/s)", both("rate", "mocap_rate", degrees));
  if (nodes[0].acceleration) compared(take, view, "node-acceleration", "acc. / (m/s²)", both("acceleration", "mocap_acceleration", 1));
  if (nodes[0].orientation_error) {
    compared(take, view, "node-orientation", "angle / °", () => ({
      valid: node().valid,
      curves: [{ colour: "imu", value: (k) => degrees * node().orientation_error[k] }],
    }));
  }
  const redraw = () => view.show(...view.domain);
  chooser("node-rate", "Node", nodes.map((n) => `${n.node} on ${n.joint}`), 0, (i) => {
    chosen.node = i;
    redraw();
  });
  chooser("node-rate", "Part", choices.map((c) => c[0]), 0, (i) => {
    chosen.part = i;
    redraw();
  });
  zoomButtons("node-rate", view);
}
