// SPDX-License-Identifier: MIT
// The display, dot by dot, from the controller's memory: its ROM, and the characters that the
// firmware has drawn.

const COLUMNS = 16;
const ROWS = 2;
const WIDE = 5;
const HIGH = 8;
const OWN = 0x10; // codes below this have their dots in the controller's memory
const GAP = 1; // dots between two characters
const EDGE = 3; // around all of them
const DOT = 12; // pixels of the canvas; the browser makes it as large as there is room
const SPACE = 1; // of these between two dots

const LIT = { glass: "#a9c53f", off: "#9fba3a", dot: "#1b2a06" };
const DARK = { glass: "#5c6b2f", off: "#57652c", dot: "#161f06" };

const ACROSS = COLUMNS * (WIDE + GAP) - GAP + 2 * EDGE;
const DOWN = ROWS * (HIGH + GAP) - GAP + 2 * EDGE;

export class Display {
  // rom: {"41": [8 rows of 5 dots]}
  constructor(canvas, text, rom) {
    this.canvas = canvas;
    this.text = text;
    this.rom = rom;
    this.lcd = null;
    this.colours = null;
    this.drawn = new Map(); // place: the dots that are seen there
    canvas.width = DOT * ACROSS;
    canvas.height = DOT * DOWN;
    this.draw();
  }

  show(lcd) {
    this.lcd = lcd;
    const text = lcd.text.map((row) => row.trimEnd()).join("\n");
    if (this.text.textContent !== text) {
      this.text.textContent = text;
      this.canvas.setAttribute("aria-label", lcd.on ? `Display: ${text}` : "The display is off");
    }
    this.draw();
  }

  // Draws the characters that have changed.
  draw() {
    const { lcd } = this;
    const paint = this.canvas.getContext("2d");
    const colours = !lcd || lcd.lit ? LIT : DARK;
    if (this.colours !== colours) {
      this.colours = colours;
      this.drawn.clear();
      paint.fillStyle = colours.glass;
      paint.fillRect(0, 0, this.canvas.width, this.canvas.height);
    }
    for (let row = 0; row < ROWS; row += 1) {
      for (let column = 0; column < COLUMNS; column += 1) {
        const dots = this.dots(row, column);
        const place = row * COLUMNS + column;
        if (this.drawn.get(place) !== String(dots)) {
          this.drawn.set(place, String(dots));
          this.character(paint, row, column, dots);
        }
      }
    }
  }

  character(paint, row, column, dots) {
    for (let at = 0; at < WIDE * HIGH; at += 1) {
      const x = at % WIDE;
      const y = Math.floor(at / WIDE);
      paint.fillStyle = dots[y] & (16 >> x) ? this.colours.dot : this.colours.off;
      paint.fillRect(
        (EDGE + column * (WIDE + GAP) + x) * DOT,
        (EDGE + row * (HIGH + GAP) + y) * DOT,
        DOT - SPACE,
        DOT - SPACE,
      );
    }
  }

  dots(row, column) {
    const { lcd } = this;
    if (!lcd?.on) return [];
    const code = byte(lcd.codes[row], column);
    if (code >= OWN) return this.rom[hex(code)] ?? [];
    const first = (code & 7) * HIGH;
    return Array.from({ length: HIGH }, (_, at) => byte(lcd.glyphs, first + at));
  }
}

function byte(text, at) {
  return parseInt(text.slice(2 * at, 2 * at + 2), 16);
}

function hex(code) {
  return code.toString(16).toUpperCase().padStart(2, "0");
}
