// SPDX-License-Identifier: MIT
// The telegrams on the line, in words. One that says the same as the last one of its drive and
// direction counts there.

const ROWS_MAX = 120;
const DRAW_MS = 200;
const NODE = 0x1f;
const MIRROR_AND_BROADCAST = 0x60;

export class Telegrams {
  constructor(body, pause, showHex) {
    this.body = body;
    this.rows = [];
    this.latest = new Map(); // who talks to whom -> its row
    this.isHeld = false;
    this.changed = new Set(); // rows that are not drawn as they are
    pause.addEventListener("click", () => {
      this.isHeld = !this.isHeld;
      pause.setAttribute("aria-pressed", String(this.isHeld));
      pause.textContent = this.isHeld ? "Go on" : "Pause";
    });
    showHex.addEventListener("change", () => body.classList.toggle("with-hex", showHex.checked));
    setInterval(() => this.draw(), DRAW_MS);
  }

  forget() {
    this.rows = [];
    this.latest.clear();
    this.changed.clear();
    this.body.replaceChildren();
  }

  add(telegram) {
    const who = telegram.from + partner(telegram.hex);
    let row = this.latest.get(who);
    if (row?.hex === telegram.hex && this.rows.includes(row)) {
      row.times += 1;
      row.us = telegram.us;
    } else {
      row = { ...telegram, times: 1, element: null };
      this.latest.set(who, row);
      this.rows.push(row);
      if (this.rows.length > ROWS_MAX) this.changed.add(this.rows.shift());
    }
    this.changed.add(row);
  }

  // Touches what has changed alone: a table is dear.
  draw() {
    if (this.isHeld) return;
    for (const row of this.changed) {
      if (!this.rows.includes(row)) {
        row.element?.remove();
        continue;
      }
      if (!row.element) {
        row.element = element(row);
        this.body.prepend(row.element);
      }
      row.element.cells[0].textContent = (row.us / 1e6).toFixed(3);
      row.element.cells[3].textContent = row.times > 1 ? `${row.times} x` : "";
    }
    this.changed.clear();
  }
}

function element(row) {
  const line = document.createElement("tr");
  line.className = row.wrong ? "wrong" : `from-${row.from}`;
  line.insertCell();
  line.insertCell().textContent = row.from;
  const told = line.insertCell();
  told.textContent = row.text.replace(/ {2,}/g, "  ");
  const hex = document.createElement("code");
  hex.textContent = row.hex.replace(/..(?!$)/g, "$& ");
  told.append(hex);
  line.insertCell();
  return line;
}

// The drive that a telegram is for, or from.
function partner(hex) {
  const address = parseInt(hex.slice(4, 6), 16);
  return address & MIRROR_AND_BROADCAST ? address : address & NODE;
}
