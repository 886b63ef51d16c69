// SPDX-License-Identifier: MIT
// The last half minute of a drive: setpoint and actual value in hertz, current in amperes.

const SPAN_US = 30_000_000;
const POINTS_MAX = 1000;
const LEAST_HZ = 10;
const LEAST_AMPS = 2;
const EDGE = 4;
const HEADROOM = 1.15; // the highest value is not at the very edge
// What is drawn: the field, its name, its unit, the colour, a dashed line.
const CURVES = [
  ["set_hz", "setpoint", "Hz", "--curve-setpoint", [4, 3]],
  ["hz", "actual", "Hz", "--curve-actual", []],
  ["amps", "current", "A", "--curve-current", [1, 2]],
];

export class Chart {
  constructor(canvas, name) {
    this.canvas = canvas;
    this.name = name;
    this.points = [];
    this.us = 0;
    this.isSeen = true;
    new IntersectionObserver((entries) => {
      this.isSeen = entries.at(-1).isIntersecting;
    }).observe(canvas);
    const legend = document.createElement("p");
    legend.className = "legend";
    for (const [field, text, unit] of CURVES) {
      const item = document.createElement("span");
      item.className = `curve ${field}`;
      item.textContent = `${text}, ${unit}`;
      legend.append(item);
    }
    canvas.after(legend);
  }

  add(us, drive) {
    if (drive.hz === null) return;
    if (us < (this.points.at(-1)?.us ?? 0)) this.points = []; // another panel
    this.points.push({ us, set_hz: drive.set_hz, hz: drive.hz, amps: drive.amps });
    // The last point before the span stays: its value holds until the next one.
    while (this.points.length > POINTS_MAX || this.points[1]?.us < us - SPAN_US) {
      this.points.shift();
    }
    const figures = CURVES.map(([field, text, unit]) => `${text} ${drive[field].toFixed(1)} ${unit}`);
    this.canvas.setAttribute("aria-label", `${this.name}: ${figures.join(", ")}`);
  }

  // us: the panel's time now.
  draw(us) {
    this.us = us;
    const { canvas } = this;
    if (!this.isSeen || !canvas.clientWidth) return;
    const scale = devicePixelRatio;
    const [wide, high] = [canvas.clientWidth * scale, canvas.clientHeight * scale];
    if (canvas.width !== Math.round(wide) || canvas.height !== Math.round(high)) {
      [canvas.width, canvas.height] = [wide, high];
    }
    const paint = canvas.getContext("2d");
    const style = getComputedStyle(canvas);
    paint.clearRect(0, 0, wide, high);
    const reach = {
      Hz: Math.max(LEAST_HZ, ...this.points.flatMap((p) => [Math.abs(p.hz), Math.abs(p.set_hz)])),
      A: Math.max(LEAST_AMPS, ...this.points.map((p) => p.amps)),
    };
    this.frame(paint, style, wide, high, scale, reach);
    for (const [field, , unit, colour, dashes] of CURVES) {
      paint.strokeStyle = style.getPropertyValue(colour);
      paint.setLineDash(dashes.map((length) => length * scale));
      paint.lineWidth = (field === "hz" ? 2 : 1.5) * scale;
      this.curve(paint, field, reach[unit], wide, high, scale);
    }
  }

  frame(paint, style, wide, high, scale, reach) {
    paint.setLineDash([]);
    paint.lineWidth = scale;
    paint.strokeStyle = style.getPropertyValue("--edge");
    paint.beginPath();
    paint.moveTo(0, high / 2);
    paint.lineTo(wide, high / 2);
    paint.stroke();
    paint.fillStyle = style.getPropertyValue("--faint");
    paint.font = `${10 * scale}px sans-serif`;
    paint.textBaseline = "top";
    paint.fillText(`${Math.round(reach.Hz * HEADROOM)} Hz`, EDGE * scale, EDGE * scale);
    paint.textBaseline = "bottom";
    paint.fillText(`-${Math.round(reach.Hz * HEADROOM)} Hz`, EDGE * scale, high - EDGE * scale);
    paint.textAlign = "right";
    paint.fillText("30 s", wide - EDGE * scale, high - EDGE * scale);
    paint.textBaseline = "top";
    paint.fillText(`${(reach.A * HEADROOM).toFixed(1)} A`, wide - EDGE * scale, EDGE * scale);
    paint.textAlign = "left";
  }

  curve(paint, field, reach, wide, high, scale) {
    const room = high / 2 - EDGE * scale;
    const x = (us) => wide - ((this.us - us) / SPAN_US) * wide;
    const y = (value) => high / 2 - (value / reach / HEADROOM) * room;
    paint.beginPath();
    this.points.forEach((point, at) => {
      const [px, py] = [Math.max(0, x(point.us)), y(point[field])];
      if (at === 0) {
        paint.moveTo(px, py);
        return;
      }
      // Nothing was told because nothing changed: the value held until just before this one.
      const before = this.points[at - 1];
      if (point.us - before.us > 150_000) paint.lineTo(px - 1, y(before[field]));
      paint.lineTo(px, py);
    });
    const last = this.points.at(-1);
    if (last) paint.lineTo(wide, y(last[field]));
    paint.stroke();
  }
}
