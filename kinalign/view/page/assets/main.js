// The script of a take's page. It reads the data, draws the figures, and connects player and
// keyboard to one time.
// SPDX-License-Identifier: Apache-2.0
import { redrawAll, TimeView } from "./chart.js";
import { PageClock } from "./clock.js";
import { readTake } from "./data.js";
import { nodeFigures } from "./node_figures.js";
import { Player } from "./player.js";
import { boneFigure, floorFigure, residualByJoint, residualOverTime, SpaceChoice, stateFigure, table5 } from "./space_figures.js";
import { distanceFigure, figure7, laneFigure } from "./time_figures.js";

const speeds = [0.1, 0.25, 0.5, 1, 2, 4];

function controls(take, clock, player) {
  const box = document.getElementById("player"), find = (name) => box.querySelector(name);
  const play = find(".play"), scrub = find(".scrub"), time = find(".time"), speed = find(".speed");
  scrub.max = take.length_s;
  scrub.step = 0.001;
  scrub.addEventListener("input", () => {
    clock.play(false);
    clock.go(Number(scrub.value));
  });
  play.addEventListener("click", () => clock.play(!clock.playing));
  speed.addEventListener("change", () => {
    clock.speed = Number(speed.value);
  });
  const told = () => {
    scrub.value = clock.now;
    time.textContent = `${clock.now.toFixed(2)} / ${take.length_s.toFixed(2)} s`;
    play.textContent = clock.playing ? "Pause" : "Play";
    box.dataset.seconds = clock.now.toFixed(3);
    box.dataset.playing = clock.playing;
  };
  clock.listen(told);
  told();
  for (const button of box.querySelectorAll("[data-view]")) {
    button.addEventListener("click", (event) => {
      if (player) player.look(button.dataset.view);
      if (event.detail > 0) button.blur();  // after a mouse click the space bar still plays
    });
  }
  for (const tick of box.querySelectorAll("[data-part]")) {
    tick.addEventListener("change", () => player && player.toggle(tick.dataset.part, tick.checked));
  }
  keyboard(take, clock, player, speed);
}

function keyboard(take, clock, player, speed) {
  const step = take.rows > 1 ? take.length_s / (take.rows - 1) : 0;
  const faster = (by) => {
    const now = speeds.indexOf(clock.speed), next = Math.min(speeds.length - 1, Math.max(0, now + by));
    clock.speed = speeds[next];
    speed.value = String(clock.speed);
  };
  const scrub = (by) => {
    clock.play(false);
    clock.go(clock.now + by);
  };
  const keys = {
    " ": () => clock.play(!clock.playing),
    ArrowLeft: (shift) => scrub(shift ? -1 : -step),
    ArrowRight: (shift) => scrub(shift ? 1 : step),
    Home: () => scrub(-take.length_s),
    End: () => scrub(take.length_s),
    ArrowUp: () => faster(1),
    ArrowDown: () => faster(-1),
    1: () => player && player.look("front"),
    2: () => player && player.look("side"),
    3: () => player && player.look("top"),
  };
  const typing = (event) => event.target instanceof Element && event.target.closest("select, input:not(.scrub), textarea, button, summary") !== null;
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || typing(event)) return;
    // The up and down keys scroll the page, unless the player has the focus.
    const vertical = event.key === "ArrowUp" || event.key === "ArrowDown" || event.key === "Home" || event.key === "End";
    if (vertical && !(event.target instanceof Element && event.target.closest("#player"))) return;
    const does = keys[event.key];
    if (does === undefined) return;
    event.preventDefault();
    does(event.shiftKey);
  });
}

function makePlayer(take, clock) {
  const box = document.getElementById("player"), probe = document.createElement("canvas");
  if (probe.getContext("webgl") === null || !take.bodies.some((body) => body.in_take_space)) {
    box.classList.add("without-webgl");
    return null;
  }
  return new Player(box.querySelector("canvas"), take, clock);
}

const pause = () => new Promise((resolve) => setTimeout(resolve));

/// Draws in steps: the verdict is shown first, then the player, then the figures.
async function main() {
  await pause();
  const take = readTake(), clock = new PageClock(take.length_s);
  const whole = new TimeView(clock), detail = new TimeView(clock), nodes = new TimeView(clock);
  const choice = new SpaceChoice(take);
  const player = makePlayer(take, clock);
  controls(take, clock, player);
  for (const figure of [
    () => laneFigure(take, whole),
    () => distanceFigure(take, whole),
    () => figure7(take, detail),
    () => table5(take, clock, choice),
    () => residualByJoint(choice),
    () => residualOverTime(take, whole, choice),
    () => choice.offer(),
    () => floorFigure(take, clock),
    () => stateFigure(take),
    () => boneFigure(take),
    () => nodeFigures(take, nodes),
  ]) {
    await pause();
    figure();
  }
  const paper = (on) => () => {
    document.documentElement.classList.toggle("printing", on);
    if (player) player.recolour();
    if (player && on) player.copyForPaper();
    redrawAll();
  };
  addEventListener("beforeprint", paper(true));
  addEventListener("afterprint", paper(false));
  document.body.dataset.ready = "true";
}

main();
