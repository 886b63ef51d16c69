// SPDX-License-Identifier: MIT
// The page: it shows what the panel says, and tells it what a person does. What that means is the
// panel's business. The messages: tools/live/README.md.

import { Display } from "./display.js";
import { Drives } from "./drives.js";
import { Keypad } from "./keypad.js";
import { connect } from "./link.js";
import { Telegrams } from "./telegrams.js";

const SAID_MAX = 100;
const REASONS = ["start", "length", "bcc", "address", "no_reply", "residual"];

const $ = (id) => document.getElementById(id);
const rom = await (await fetch("rom_a00.json")).json();
const display = new Display($("display"), $("display-text"), rom);
const telegrams = new Telegrams($("telegram-rows"), $("hold-telegrams"), $("show-hex"));
const said = [];
let asked = 0; // commands so far
let world = null; // the hello that was shown last

const TAKERS = {
  hello(message) {
    const text = JSON.stringify(message);
    if (world === text) return; // another page has come
    world = text;
    $("place").textContent = `${message.version} on ${message.place}, ${message.baud} baud`;
    keypad.show(message.keys, message.letters, message.behind_fn);
    drives.begin(message.drives, message.commands);
    telegrams.forget();
    $("arm").hidden = !message.real;
    $("speed").disabled = Boolean(message.real);
    $("line").hidden = !("line" in message.commands);
    $("command-names").replaceChildren(
      ...Object.values(message.commands).map((usage) => new Option(usage)),
    );
  },
  state(message) {
    display.show(message.lcd);
    keypad.lit(message.down);
    drives.select(message.shown);
    document.body.classList.toggle("doing", Boolean(message.doing));
  },
  time(message) {
    $("clock").textContent = clock(message.us);
    $("true-speed").textContent = `true x ${message.speed.toFixed(1)}`;
    if (document.activeElement !== $("speed")) $("speed").value = String(message.wanted);
    drives.time(message.us, message.wanted && message.speed);
  },
  drives: (message) => drives.show(message),
  telegram: (message) => telegrams.add(message),
  count(message) {
    const good = message.drives.reduce((sum, drive) => sum + drive.good, 0);
    const bad = REASONS.map((reason) => [
      reason.replace("_", " "),
      message.drives.reduce((sum, drive) => sum + drive[reason], 0),
    ]).filter(([, count]) => count);
    $("counts").textContent = [`good ${good}`, ...bad.map((pair) => pair.join(" "))].join(", ");
  },
  broken: (message) => message.text && note(`BROKEN: ${message.text}`),
  notice: (message) => note(message.text),
  done: (message) => message.out.forEach(note),
  error: (message) => note(message.text),
};

const link = connect({
  take: (message) => TAKERS[message.t]?.(message),
  tell(text, kind) {
    $("status").textContent = text;
    $("status").dataset.kind = kind;
  },
  gone() {
    keypad?.release();
    world = null;
  },
});
const keypad = new Keypad($("keys"), (message) => link.say(message));
const drives = new Drives($("drive-list"), act);

// A command of the script language.
function act(line) {
  asked += 1;
  note(`> ${line}`);
  link.say({ t: "do", n: asked, line });
}

function note(line) {
  said.push(line);
  said.splice(0, said.length - SAID_MAX);
  $("said").textContent = said.join("\n");
  $("said").scrollTop = $("said").scrollHeight;
}

function clock(us) {
  const tenths = Math.floor(us / 1e5);
  const two = (number) => String(number).padStart(2, "0");
  const [hours, minutes] = [Math.floor(tenths / 36_000), Math.floor(tenths / 600) % 60];
  return `${hours}:${two(minutes)}:${two(Math.floor(tenths / 10) % 60)}.${tenths % 10}`;
}

document.querySelectorAll("[data-do]").forEach((button) => {
  button.addEventListener("click", () => act(button.dataset.do));
});
$("arm").addEventListener("click", () => link.say({ t: "arm" }));
$("speed").addEventListener("change", () => {
  link.say({ t: "speed", x: Number($("speed").value) });
  $("speed").blur(); // the letters are keys again
});
$("command-form").addEventListener("submit", (event) => {
  event.preventDefault();
  if ($("command").value.trim()) act($("command").value);
  $("command").value = "";
});
