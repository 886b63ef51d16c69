// SPDX-License-Identifier: MIT
// The drives: a motor that turns, what it does in figures and over time, and faults for it.

import { Chart } from "./chart.js";

// A motor at 50 Hz makes so many turns a second here, so that the eye can follow.
const TURNS_PER_HZ = 0.03;
// What a person can do to a drive: the button, its command, whether it makes sense now.
const DEEDS = [
  ["Pull the cable", (a) => `unplug ${a}`, (drive) => drive.plugged],
  ["Plug it in", (a) => `plug ${a}`, (drive) => !drive.plugged],
  ["Trip", (a) => `fault ${a} F0001`, (drive) => drive.powered && !drive.fault],
  ["Mains off", (a) => `off ${a}`, (drive) => drive.powered],
  ["Mains on", (a) => `on ${a}`, (drive) => !drive.powered],
];

const MOTOR = `
  <svg class="motor" viewBox="-50 -50 100 100" aria-hidden="true">
    <path class="foot" d="M-34 47 L-26 30 H26 L34 47 Z"/>
    <circle class="body" r="40"/>
    <circle class="face" r="31"/>
    <g class="shaft">
      <path class="blade" d="M0 0 C-9 -9 -9 -22 0 -28 C9 -22 9 -9 0 0 Z"/>
      <path class="blade" d="M0 0 C-9 -9 -9 -22 0 -28 C9 -22 9 -9 0 0 Z" transform="rotate(120)"/>
      <path class="blade" d="M0 0 C-9 -9 -9 -22 0 -28 C9 -22 9 -9 0 0 Z" transform="rotate(240)"/>
      <circle class="hub" r="7"/>
      <circle class="mark" cy="-22" r="3"/>
    </g>
  </svg>`;

export class Drives {
  // root: the element for them. act(command): does a command of the script language.
  constructor(root, act) {
    this.root = root;
    this.act = act;
    this.cards = new Map();
    this.rate = 1; // of the panel's time
    this.us = 0;
    this.selected = null;
    this.seen = performance.now();
    this.isCalm = matchMedia("(prefers-reduced-motion: reduce)");
    this.isTurning = false;
  }

  // commands: {name: usage} that can be done here.
  begin(addresses, commands) {
    this.root.replaceChildren();
    this.cards.clear();
    for (const address of addresses) {
      const card = new Card(address, "fault" in commands, this.act);
      this.cards.set(address, card);
      this.root.append(card.element);
    }
  }

  show({ us, drives }) {
    this.us = us;
    drives.forEach((drive) => this.cards.get(drive.a)?.show(us, drive));
    this.select(this.selected);
    if (!this.isTurning && this.hasToTurn()) {
      this.isTurning = true;
      this.seen = performance.now();
      requestAnimationFrame(() => this.turn());
    }
  }

  hasToTurn() {
    return !this.isCalm.matches && [...this.cards.values()].some((card) => card.drive?.hz);
  }

  // The address of the drive that the panel shows.
  select(address) {
    this.selected = address;
    this.cards.forEach((card) => card.select(card.drive?.at === address));
  }

  // The panel's time now, and how fast it passes.
  time(us, rate) {
    this.us = us;
    this.rate = rate;
    this.cards.forEach((card) => card.chart.draw(us));
  }

  turn() {
    const now = performance.now();
    const seconds = Math.min(now - this.seen, 100) / 1000;
    this.seen = now;
    this.cards.forEach((card) => card.turn(seconds * this.rate));
    this.isTurning = this.hasToTurn();
    if (this.isTurning) requestAnimationFrame(() => this.turn());
  }
}

class Card {
  constructor(address, canBeHurt, act) {
    this.drive = null;
    this.angle = 0;
    this.element = document.createElement("article");
    this.element.className = "drive";
    this.element.setAttribute("aria-label", `Drive A${address}`);
    this.element.innerHTML = `${MOTOR}<div class="facts"><h3></h3><p class="state"></p></div>
      <div class="chart"><canvas role="img"></canvas></div><div class="deeds"></div>`;
    this.shaft = this.element.querySelector(".shaft");
    this.title = this.element.querySelector("h3");
    this.state = this.element.querySelector(".state");
    this.title.textContent = `A${address}`;
    this.chart = new Chart(this.element.querySelector("canvas"), `A${address}`);
    this.deeds = canBeHurt ? DEEDS.map((deed) => this.deed(address, deed, act)) : [];
  }

  deed(address, [name, command, fits], act) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = name;
    button.setAttribute("aria-label", `A${address}: ${name}`);
    button.addEventListener("click", () => act(command(address)));
    this.element.querySelector(".deeds").append(button);
    return { button, fits };
  }

  show(us, drive) {
    this.drive = drive;
    const { element } = this;
    element.dataset.state = drive.state;
    element.classList.toggle("ill", Boolean(drive.fault));
    element.classList.toggle("apart", !drive.plugged);
    this.title.textContent = drive.at === drive.a ? `A${drive.a}` : `A${drive.a}, now A${drive.at}`;
    this.state.textContent = told(drive);
    this.deeds.forEach(({ button, fits }) => {
      button.hidden = !fits(drive);
    });
    this.chart.add(us, drive);
  }

  select(isShown) {
    this.element.classList.toggle("shown", isShown);
    this.element.setAttribute("aria-current", String(isShown));
  }

  turn(seconds) {
    const hz = this.drive?.hz;
    if (!hz) return;
    this.angle = (this.angle + hz * TURNS_PER_HZ * 360 * seconds) % 360;
    this.shaft.setAttribute("transform", `rotate(${this.angle.toFixed(1)})`);
  }
}

// A drive in words and figures.
function told(drive) {
  const parts = [drive.state];
  if (drive.hz !== null) {
    const side = drive.hz > 0 ? " right" : drive.hz < 0 ? " left" : "";
    parts.push(`${Math.abs(drive.hz).toFixed(2)} Hz${side}`, `${drive.amps.toFixed(2)} A`);
  }
  if (drive.fault) parts.push(drive.fault);
  if (drive.warning) parts.push(drive.warning);
  if (!drive.powered) parts.push("mains off");
  else if (!drive.plugged) parts.push("unplugged");
  return parts.join(" · ");
}
