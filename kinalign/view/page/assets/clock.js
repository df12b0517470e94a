// The present time of the page, which all figures and the player show.
// SPDX-License-Identifier: Apache-2.0

export class PageClock {
  constructor(length) {
    this.length = length;
    this.now = 0;
    this.speed = 1;
    this.playing = false;
    this.listeners = [];
  }
  listen(listener) {
    this.listeners.push(listener);
  }
  tell() {
    for (const listener of this.listeners) listener(this);
  }
  go(seconds) {
    this.now = Math.min(Math.max(seconds, 0), this.length);
    this.tell();
  }
  play(on) {
    if (on === this.playing) return;
    if (on && this.now >= this.length) this.now = 0;
    this.playing = on;
    if (on) {
      let last = performance.now();
      const frame = (at) => {
        if (!this.playing) return;
        this.now += (Math.max(0, at - last) / 1000) * this.speed;
        last = at;
        if (this.now >= this.length) {
          this.now = this.length;
          this.playing = false;
        }
        this.tell();
        if (this.playing) requestAnimationFrame(frame);
      };
      requestAnimationFrame(frame);
    }
    this.tell();
  }
}
