// The clock: runs, stops, steps, loops. All parts of the page that show something are told of every change.

import { byId, iconButton, setIcon } from "./dom";
import { Motion } from "./motion";

export const speeds = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10];

export class Player {
  clock = 0;
  playing = false;
  loop = true;
  speed = 1;
  private motion!: Motion;
  private last = 0;
  private readonly playButton: HTMLButtonElement;
  private readonly loopButton: HTMLButtonElement;
  private readonly speedChoice: HTMLSelectElement;
  private readonly bar = byId<HTMLInputElement>("clock");
  private readonly text = byId<HTMLOutputElement>("clock-text");

  constructor(private readonly changed: () => void) {
    this.playButton = iconButton("play", "play or pause (space)", () => this.toggle());
    this.loopButton = iconButton("loop", "loop (l)", () => this.setLoop(!this.loop));
    this.speedChoice = document.createElement("select");
    this.speedChoice.setAttribute("aria-label", "speed");
    for (const speed of speeds) this.speedChoice.append(new Option(`${speed}×`, String(speed)));
    this.speedChoice.addEventListener("change", () => (this.speed = Number(this.speedChoice.value)));
    byId("buttons").append(
        iconButton("start", "to the start (home)", () => this.moveTo(this.motion.begin)),
        iconButton("back", "one row back (left)", () => this.step(-1)), this.playButton,
        iconButton("on", "one row on (right)", () => this.step(1)), this.loopButton, this.speedChoice);
    this.bar.addEventListener("input", () => {
      this.pause();
      this.moveTo(this.motion.begin + (Number(this.bar.value) / 1000) * (this.motion.end - this.motion.begin));
    });
    this.setLoop(true);
    this.setSpeed(1);
  }

  show(motion: Motion): void {
    this.motion = motion;
    this.bar.disabled = !motion.moves;
    // What takes hours or milliseconds is shown in some seconds.
    const seconds = motion.end - motion.begin;
    const natural = motion.timed && seconds > 0 ? seconds / 6 : 1;
    const away = (speed: number) => Math.abs(Math.log(speed / natural));
    const nearest = speeds.reduce((a, b) => (away(b) < away(a) ? b : a));
    this.setSpeed(seconds > 30 || seconds < 1 ? nearest : 1);
    this.moveTo(motion.begin);
  }

  setSpeed(speed: number): void {
    this.speed = speed;
    this.speedChoice.value = String(speed);
  }

  setLoop(loop: boolean): void {
    this.loop = loop;
    this.loopButton.setAttribute("aria-pressed", String(loop));
  }

  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }

  play(): void {
    if (!this.motion.moves || this.playing) return;
    if (this.clock >= this.motion.end && !this.loop) this.clock = this.motion.begin;
    this.playing = true;
    setIcon(this.playButton, "pause");
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  pause(): void {
    this.playing = false;
    setIcon(this.playButton, "play");
  }

  step(rows: number): void {
    this.pause();
    if (this.motion.shape >= 0) return this.moveTo((this.clock + 0.05 * rows + this.motion.end) % this.motion.end);
    const position = this.motion.position(this.clock);
    const next = rows > 0 ? Math.floor(position + 1e-9) + rows : Math.ceil(position - 1e-9) + rows;
    this.moveTo(this.motion.clockAt(Math.min(this.motion.count - 1, Math.max(0, next))));
  }

  moveTo(clock: number): void {
    this.clock = Math.min(this.motion.end, Math.max(this.motion.begin, clock));
    const span = this.motion.end - this.motion.begin;
    this.bar.value = String(span > 0 ? (1000 * (this.clock - this.motion.begin)) / span : 0);
    this.text.textContent = this.describe();
    this.bar.setAttribute("aria-valuetext", this.text.textContent);
    this.changed();
  }

  private describe(): string {
    if (this.motion.shape >= 0) return `mode ${this.motion.shape + 1}`;
    if (this.motion.timed) return `t = ${this.motion.units.text(this.clock, "s")}`;
    if (this.motion.count > 1) return `row ${this.motion.rowNumber(this.motion.nearestPose(this.clock))}`;
    return "at rest";
  }

  private tick(now: number): void {
    if (!this.playing) return;
    const { begin, end } = this.motion;
    // A page that was hidden goes on where it was.
    let next = this.clock + Math.min(0.25, (now - this.last) / 1000) * this.speed;
    this.last = now;
    if (next > end) {
      if (this.loop) {
        next = begin + ((next - begin) % (end - begin || 1));
      } else {
        next = end;
        this.pause();
      }
    }
    this.moveTo(next);
    if (this.playing) requestAnimationFrame((later) => this.tick(later));
  }
}
