// Figures with axes as SVG. A figure is drawn again if its width changes. A figure over time shows
// the time of the page as a line. A click sets the time, dragging sideways zooms, and a double
// click shows the whole take.
// SPDX-License-Identifier: Apache-2.0
import { axisBottom, axisLeft } from "d3-axis";
import { scaleBand, scaleLinear } from "d3-scale";
import { select } from "d3-selection";

export const margin = { top: 8, right: 12, bottom: 36, left: 52 };

const redraws = [];

/// Draws all figures again, before printing or after it.
export function redrawAll() {
  for (const redraw of redraws) redraw();
}

/// Width of a column, or half of one, on A4 or Letter paper, in CSS pixels.
const paperWidth = (box) => (box.closest(".pair") === null ? 690 : 335);

/// Calls draw(svg, width) now and whenever the width of the figure's box changes. `seen` is called
/// when the figure becomes visible; `visible()` returns whether it is visible. While a take plays,
/// figures that are not visible are not drawn again.
export function drawn(id, draw, seen = () => {}) {
  const box = document.querySelector(`#${id} .plot`);
  if (box === null) return { redraw() {}, visible: () => false };
  const svg = select(box).append("svg").attr("role", "img");
  const caption = document.querySelector(`#${id} figcaption`);
  if (caption !== null) svg.attr("aria-label", caption.textContent.trim());
  let width = 0;
  const redraw = () => {
    const printing = document.documentElement.classList.contains("printing");
    width = printing ? paperWidth(box) : Math.max(280, Math.round(box.clientWidth));
    svg.selectAll("*").remove();
    const height = draw(svg, width);
    svg.attr("viewBox", `0 0 ${width} ${height}`).attr("height", height);
  };
  redraw();
  redraws.push(redraw);
  new ResizeObserver(() => {
    const printing = document.documentElement.classList.contains("printing");
    if (!printing && Math.abs(box.clientWidth - width) > 1 && box.clientWidth > 0) redraw();
  }).observe(box);
  let visible = false;
  new IntersectionObserver((entries) => {
    visible = entries[entries.length - 1].isIntersecting;
    if (visible) seen();
  }).observe(box);
  return { redraw, visible: () => visible };
}

/// An element that moves over a figure. It is separate, so that the figure is not painted again.
export function marker(id, kind) {
  const box = document.querySelector(`#${id} .plot`), made = document.createElement("div");
  made.className = kind;
  if (box !== null) box.append(made);
  return {
    size(top, height) {
      made.style.top = `${top}px`;
      made.style.height = `${height}px`;
    },
    move(x, y, shown) {
      made.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      made.style.visibility = shown ? "visible" : "hidden";
    },
  };
}

const hatchName = (svg, kind) => `hatch-${kind}-${svg.node().closest("figure").id}`;

/// Adds hatched and hollow fill patterns for each kind of stream. CSS sets their colours.
export function addHatches(svg) {
  const defs = svg.append("defs");
  for (const kind of ["mocap", "kinect", "imu"]) {
    const pattern = defs.append("pattern").attr("id", hatchName(svg, kind))
      .attr("width", 5).attr("height", 5).attr("patternUnits", "userSpaceOnUse").attr("patternTransform", "rotate(45)");
    pattern.append("line").attr("y2", 5).attr("class", `stroke ${kind}`).attr("stroke-width", 3);
  }
}
export const hatch = (svg, kind) => `url(#${hatchName(svg, kind)})`;

/// Draws the axes of a plot; `at` = {left, top, width, height}. Labels contain the units.
export function axes(svg, at, x, y, labels) {
  const ticks = Math.max(2, Math.floor(at.width / 90));
  svg.append("g").attr("class", "grid").attr("transform", `translate(${at.left},0)`)
    .call(axisLeft(y).ticks(labels.yTicks ?? 4).tickSize(-at.width).tickFormat(""));
  svg.append("g").attr("class", "axis").attr("transform", `translate(0,${at.top + at.height})`)
    .call(axisBottom(x).ticks(ticks).tickSizeOuter(0));
  svg.append("g").attr("class", "axis").attr("transform", `translate(${at.left},0)`)
    .call(axisLeft(y).ticks(labels.yTicks ?? 4).tickSizeOuter(0));
  if (labels.x) {
    svg.append("text").attr("class", "label").attr("x", at.left + at.width).attr("y", at.top + at.height + 31)
      .attr("text-anchor", "end").text(labels.x);
  }
  if (labels.y) {
    svg.append("text").attr("class", "label").attr("transform", `translate(13,${at.top + at.height / 2}) rotate(-90)`)
      .attr("text-anchor", "middle").text(labels.y);
  }
}

/// Returns the SVG path "M x y L x y ..." through points. The path is interrupted at points that
/// are null.
export function path(points) {
  let text = "", open = false;
  for (const p of points) {
    if (p === null) {
      open = false;
      continue;
    }
    text += `${open ? "L" : "M"}${p[0].toFixed(1)} ${p[1].toFixed(1)}`;
    open = true;
  }
  return text;
}

export const dots = (points) => points.map((p) => `M${p[0].toFixed(1)} ${p[1].toFixed(1)}h0`).join("");
export const rings = (points, r) =>
  points.map((p) => `M${(p[0] - r).toFixed(1)} ${p[1].toFixed(1)}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`).join("");

/// The time range that several figures show together.
export class TimeView {
  constructor(clock) {
    this.clock = clock;
    this.domain = [0, clock.length];
    this.charts = [];
    clock.listen(() => this.moveCursors());
  }
  show(begin, end) {
    const least = Math.min(0.2, this.clock.length);
    const middle = (begin + end) / 2, half = Math.max(least, end - begin) / 2;
    const low = Math.max(0, Math.min(middle - half, this.clock.length - 2 * half));
    this.domain = [low, Math.min(this.clock.length, low + 2 * half)];
    for (const chart of this.charts) chart.redraw();
  }
  zoom(factor) {
    const [a, b] = this.domain;
    const inside = this.clock.now >= a && this.clock.now <= b;
    const middle = inside ? this.clock.now : (a + b) / 2;
    this.show(middle - ((b - a) / 2) * factor, middle + ((b - a) / 2) * factor);
  }
  moveCursors() {
    for (const chart of this.charts) if (chart.place && chart.visible()) chart.place();
  }
  /// Adds a figure. draw(svg, at, x) draws the plot and returns nothing; `height` is the height of
  /// the plot.
  add(id, height, draw) {
    const chart = { place: null, visible: () => false }, line = marker(id, "cursor");
    const made = drawn(id, (svg, width) => {
      const own = typeof height === "function" ? height() : height;
      const at = { left: margin.left, top: margin.top, width: width - margin.left - margin.right, height: own };
      const x = scaleLinear(this.domain, [at.left, at.left + at.width]);
      draw(svg, at, x);
      line.size(at.top, at.height);
      chart.place = () => {
        const now = this.clock.now, [a, b] = this.domain;
        line.move(x(now), 0, now >= a && now <= b);
      };
      chart.place();
      this.follow(svg, at, x);
      return own + margin.top + margin.bottom;
    }, () => chart.place && chart.place());
    chart.redraw = made.redraw;
    chart.visible = made.visible;
    this.charts.push(chart);
    return chart;
  }
  follow(svg, at, x) {
    const node = svg.node();
    const chosen = svg.append("rect").attr("class", "chosen").attr("y", at.top).attr("height", at.height).attr("width", 0);
    const seconds = (event) => {
      const box = node.getBoundingClientRect();
      const px = ((event.clientX - box.left) / box.width) * (at.left + at.width + margin.right);
      return Math.min(Math.max(x.invert(px), this.domain[0]), this.domain[1]);
    };
    let from = null;
    const area = svg.append("rect").attr("class", "catch").attr("x", at.left).attr("y", at.top)
      .attr("width", at.width).attr("height", at.height).node();
    area.addEventListener("pointerdown", (event) => {
      from = seconds(event);
      area.setPointerCapture(event.pointerId);
    });
    area.addEventListener("pointermove", (event) => {
      if (from === null) return;
      const to = seconds(event), a = x(Math.min(from, to)), b = x(Math.max(from, to));
      chosen.attr("x", a).attr("width", b - a);
    });
    area.addEventListener("pointerup", (event) => {
      if (from === null) return;
      const to = seconds(event), begin = from;
      from = null;
      if (Math.abs(x(to) - x(begin)) < 6) {
        chosen.attr("width", 0);
        this.clock.go(to);
      } else {
        this.show(Math.min(begin, to), Math.max(begin, to));
      }
    });
    area.addEventListener("pointercancel", () => {
      from = null;
      chosen.attr("width", 0);
    });
    area.addEventListener("dblclick", () => this.show(0, this.clock.length));
  }
}

/// Adds buttons to a figure: zoom in, zoom out, show all.
export function zoomButtons(id, view) {
  const bar = document.querySelector(`#${id} .tools`);
  if (bar === null) return;
  for (const [text, title, does] of [
    ["+", "Show less time, larger", () => view.zoom(0.5)],
    ["−", "Show more time", () => view.zoom(2)],
    ["All", "Show the whole take", () => view.show(0, view.clock.length)],
  ]) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = text;
    button.title = title;
    button.addEventListener("click", does);
    bar.append(button);
  }
}

/// Adds a selection list before a figure's buttons; `names` in order. Returns a function that
/// replaces the names in the list.
export function chooser(id, label, names, chosen, does) {
  const bar = document.querySelector(`#${id} .tools`);
  if (bar === null) return () => {};
  const box = document.createElement("label");
  box.textContent = `${label} `;
  const list = document.createElement("select");
  const offer = (offered, now) => list.replaceChildren(...offered.map((name, i) => new Option(name, i, i === now, i === now)));
  offer(names, chosen);
  list.addEventListener("change", () => does(Number(list.value)));
  box.append(list);
  bar.append(box);
  return offer;
}

/// Draws horizontal bars, one for each name. `bars[i]` = {name, draw(g, y, height)}.
export function bars(svg, width, names, x, labels, draw) {
  const left = Math.min(150, Math.max(60, 7 * Math.max(...names.map((n) => n.length)) + 10)), row = 19;
  const at = { left, top: margin.top, width: width - left - margin.right, height: row * names.length };
  const scale = x.range([at.left, at.left + at.width]);
  const band = scaleBand(names.map((_, i) => i), [at.top, at.top + at.height]).padding(0.25);
  svg.append("g").attr("class", "grid").attr("transform", `translate(0,${at.top})`)
    .call(axisBottom(scale).ticks(Math.max(2, Math.floor(at.width / 80))).tickSize(at.height).tickFormat(""));
  names.forEach((name, i) => {
    svg.append("text").attr("class", "name").attr("x", at.left - 6).attr("y", band(i) + band.bandwidth() / 2)
      .attr("dy", "0.35em").attr("text-anchor", "end").text(name);
    draw(i, band(i), band.bandwidth(), scale);
  });
  svg.append("g").attr("class", "axis").attr("transform", `translate(0,${at.top + at.height})`)
    .call(axisBottom(scale).ticks(Math.max(2, Math.floor(at.width / 80))).tickSizeOuter(0));
  svg.append("text").attr("class", "label").attr("x", at.left + at.width).attr("y", at.top + at.height + 31)
    .attr("text-anchor", "end").text(labels.x);
  return at.top + at.height + margin.bottom;
}
