// Draws skeletons as SVG, from the front and from above.
// SPDX-License-Identifier: Apache-2.0
import { place, stateOf } from "./data.js";

/// Draws the bones and joints of a body in a row. `to` converts a point to [x, y] of the figure.
export function drawBody(g, body, row, to) {
  const solid = [], dashed = [], full = [], hollow = [];
  for (let j = 0; j < body.joints; ++j) {
    const state = stateOf(body, row, j);
    if (state === 0) continue;
    const p = to(place(body, row, j));
    if (body.kind === "points") (state === 2 ? full : hollow).push(p);
    const parent = body.parents[j];
    if (parent < 0 || stateOf(body, row, parent) === 0) continue;
    const q = to(place(body, row, parent));
    const sure = state === 2 && stateOf(body, row, parent) === 2;
    (sure ? solid : dashed).push(`M${p[0].toFixed(1)} ${p[1].toFixed(1)}L${q[0].toFixed(1)} ${q[1].toFixed(1)}`);
  }
  g.append("path").attr("class", `bone ${body.colour}`).attr("d", solid.join(""));
  g.append("path").attr("class", `bone dashed ${body.colour}`).attr("d", dashed.join(""));
  g.append("path").attr("class", `joint ${body.colour}`)
    .attr("d", full.map((p) => `M${p[0].toFixed(1)} ${p[1].toFixed(1)}h0`).join(""));
  g.append("path").attr("class", `rings ${body.colour}`)
    .attr("d", hollow.map((p) => `M${(p[0] - 2.5).toFixed(1)} ${p[1].toFixed(1)}a2.5 2.5 0 1 0 5 0a2.5 2.5 0 1 0 -5 0`).join(""));
}

/// Returns the smallest box around the visible joints of the bodies in a row, after `map`; null: no
/// joint is visible.
export function boxOf(bodies, row, map) {
  let box = null;
  for (const body of bodies) {
    for (let j = 0; j < body.joints; ++j) {
      if (stateOf(body, row, j) === 0) continue;
      const [x, y] = map(body, place(body, row, j));
      if (box === null) box = [x, y, x, y];
      box = [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)];
    }
  }
  return box;
}
