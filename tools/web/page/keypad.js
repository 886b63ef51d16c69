// SPDX-License-Identifier: MIT
// The keys, for the mouse, several fingers, and the keyboard. A key that is held stays down.

// The same arrangement as in the pictures of the manual. A key that stands there twice is wider.
const FOURTEEN = [
  ["START", "STOP", "STOP", "REVERSE"],
  ["JOG_LEFT", "JOG_RIGHT", "UP", "ADDRESS_UP"],
  ["PARAM", "EDIT", "DOWN", "ADDRESS_DOWN"],
  ["PREVIOUS", "NEXT", "SET", "SET"],
];
const EIGHT = [
  ["START", "STOP", "REVERSE", "JOG"],
  ["UP", "DOWN", "P", "FN"],
];
const COLOURS = { START: "start", STOP: "stop" };
const ARROWS = { ArrowUp: "UP", ArrowDown: "DOWN", ArrowRight: "NEXT", ArrowLeft: "PREVIOUS" };
const TAP_MS = 100;

export class Keypad {
  // root: the element for the keys. say: takes a message for the panel.
  constructor(root, say) {
    this.root = root;
    this.say = say;
    this.held = new Map(); // what holds it (a pointer, a key of the keyboard) -> key
    this.letters = new Map();
    document.querySelectorAll("[data-key]").forEach((button) => this.listen(button));
    document.addEventListener("keydown", (event) => this.type(event));
    document.addEventListener("keyup", (event) => this.let(event.code));
    window.addEventListener("blur", () => this.release());
    document.addEventListener("visibilitychange", () => this.release());
  }

  // Lays out the keys that this panel has.
  show(names, letters, behind) {
    this.names = names;
    this.letters = new Map(Object.entries(letters).map(([key, letter]) => [letter, key]));
    const rows = names.includes("FN") ? EIGHT : FOURTEEN;
    const buttons = [];
    for (const row of rows) {
      for (const key of new Set(row)) {
        if (names.includes(key)) {
          const wide = row.filter((other) => other === key).length > 1;
          buttons.push(this.button(key, letters[key], behind[key] ?? [], wide));
        }
      }
    }
    this.root.replaceChildren(...buttons);
  }

  // Shows which keys are down, whoever holds them.
  lit(down) {
    document.querySelectorAll("[data-key]").forEach((button) => {
      button.classList.toggle("down", down.includes(button.dataset.key));
    });
  }

  button(key, letter, behind, wide) {
    const button = document.createElement("button");
    button.type = "button";
    button.className = `key ${COLOURS[key] ?? ""} ${wide ? "wide" : ""}`;
    button.dataset.key = key;
    const name = document.createElement("span");
    name.textContent = key.replace("_", " ");
    button.append(name);
    behind.filter(Boolean).forEach((other, at) => {
      const small = document.createElement("small");
      small.textContent = `${"^".repeat(at + 1)} ${other.replace("_", " ")}`;
      button.append(small);
    });
    if (letter) {
      const mark = document.createElement("kbd");
      mark.textContent = letter;
      mark.setAttribute("aria-hidden", "true");
      button.append(mark);
      button.setAttribute("aria-keyshortcuts", letter);
    }
    this.listen(button);
    return button;
  }

  listen(button) {
    const key = button.dataset.key;
    button.addEventListener("pointerdown", (event) => {
      if (event.button === 0) {
        button.setPointerCapture(event.pointerId);
        this.hold(event.pointerId, key);
      }
    });
    for (const kind of ["pointerup", "pointercancel", "lostpointercapture"]) {
      button.addEventListener(kind, (event) => this.let(event.pointerId));
    }
    button.addEventListener("contextmenu", (event) => event.preventDefault());
    button.addEventListener("click", (event) => {
      if (event.detail === 0) this.tap(key); // of a screen reader
    });
  }

  type(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || isText(event.target)) return;
    const key = this.keyOf(event);
    if (!key) return;
    event.preventDefault();
    if (!event.repeat) this.hold(event.code, key);
  }

  keyOf(event) {
    if (event.key === " ") return "STOP";
    if (event.key === "Enter") return event.target.dataset?.key;
    if (event.target.matches?.("select, .scroll, pre") && event.key in ARROWS) return null;
    const key = ARROWS[event.key] ?? this.letters.get(event.key.toLowerCase());
    return this.names?.includes(key) ? key : null;
  }

  hold(by, key) {
    if (this.held.has(by)) return;
    const isDown = [...this.held.values()].includes(key);
    this.held.set(by, key);
    if (!isDown) this.say({ t: "down", key });
  }

  let(by) {
    const key = this.held.get(by);
    if (key === undefined) return;
    this.held.delete(by);
    if (![...this.held.values()].includes(key)) this.say({ t: "up", key });
  }

  tap(key) {
    const by = Symbol(key);
    this.hold(by, key);
    setTimeout(() => this.let(by), TAP_MS);
  }

  release() {
    if (this.held.size) this.say({ t: "release" });
    this.held.clear();
  }
}

// Whether what is typed there is text, and so never keys.
function isText(element) {
  return element.matches?.("input:not([type=checkbox]), textarea, [contenteditable]");
}
