// SPDX-License-Identifier: MIT
// Drives a real Chromium for tests in Python: a call a line on standard input, as JSON,
//
//     {"page": 1, "do": "click", "with": ["#stop"]}
//
// and an answer a line on standard output: {"value": ...} or {"error": "..."}. One call after the
// other. The first argument is the path of Chromium, the second the folder of the npm packages.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { createInterface } from "node:readline";

const [chromium, packages] = process.argv.slice(2);
const require = createRequire(`${packages}/`);
const { chromium: browsers, devices } = require("playwright-core");
const AXE = require.resolve("axe-core/axe.min.js");

const PATIENCE_MS = 30_000;
const SIZES = {
  desktop: { viewport: { width: 1280, height: 800 } },
  phone: devices["Pixel 7"],
};
const FLAGS = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];
// Timers go on as in a window that somebody looks at, whatever the other pages do.
const UNTHROTTLED = [
  "--disable-background-timer-throttling",
  "--disable-backgrounding-occluded-windows",
  "--disable-renderer-backgrounding",
];

const browser = await browsers.launch({
  executablePath: chromium,
  args: [...FLAGS, ...UNTHROTTLED],
});
const pages = new Map();
let made = 0;

async function open(url, size, motion) {
  const context = await browser.newContext({ ...SIZES[size], reducedMotion: motion });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  const complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  made += 1;
  const session = await context.newCDPSession(page);
  pages.set(made, { page, context, session, complaints });
  await page.goto(url);
  return made;
}

// As it is, or with one blank between two words, on across several lines.
const shows = ([selector, text]) =>
  [...document.querySelectorAll(selector)].some(({ textContent }) =>
    [textContent, textContent.split(/\s+/).join(" ")].some((one) => one.includes(text)),
  );

// Closes what a test has left open.
async function sweep() {
  for (const { context } of pages.values()) await context.close();
  pages.clear();
}

const DEEDS = {
  goto: ({ page }, url) => page.goto(url),
  reload: ({ page }) => page.reload(),
  close: ({ context }) => context.close(),
  click: ({ page }, selector) => page.click(selector),
  fill: ({ page }, selector, text) => page.fill(selector, text),
  choose: ({ page }, selector, value) => page.selectOption(selector, value),
  tap: ({ page }, selector) => page.tap(selector),
  keyDown: ({ page }, key) => page.keyboard.down(key),
  keyUp: ({ page }, key) => page.keyboard.up(key),
  async hold({ page }, selector) {
    await page.hover(selector);
    await page.mouse.down();
  },
  letGo: ({ page }) => page.mouse.up(),
  // Fingers on these; none: they are lifted.
  async touch({ page, session }, ...selectors) {
    const touchPoints = [];
    for (const selector of selectors) {
      const box = await page.locator(selector).boundingBox();
      touchPoints.push({ x: box.x + box.width / 2, y: box.y + box.height / 2 });
    }
    const type = selectors.length ? "touchStart" : "touchEnd";
    await session.send("Input.dispatchTouchEvent", { type, touchPoints });
  },
  shows: async ({ page }, selector, text, patience) => {
    await page.waitForFunction(shows, [selector, text], { polling: 50, timeout: patience });
  },
  text: ({ page }, selector) => page.textContent(selector),
  visible: ({ page }, selector) => page.isVisible(selector),
  run: ({ page }, source) => page.evaluate(source),
  cut: ({ context }, isCut) => context.setOffline(isCut),
  shot: ({ page }, path, fullPage) => page.screenshot({ path, fullPage }),
  complaints: ({ complaints }) => complaints,
  async axe({ page, session }) {
    // In this way it may run, although the page allows no scripts but its own.
    await session.send("Runtime.evaluate", { expression: readFileSync(AXE, "utf8") });
    const found = await page.evaluate(() => window.axe.run());
    return found.violations.map(({ id, nodes }) => `${id}: ${nodes.map((n) => n.html).join(" ")}`);
  },
};

for await (const line of createInterface({ input: process.stdin })) {
  const call = JSON.parse(line);
  let answer;
  try {
    const value =
      call.page === null
        ? await { open, sweep }[call.do](...call.with)
        : await DEEDS[call.do](pages.get(call.page), ...call.with);
    answer = { value: ["goto", "reload"].includes(call.do) ? null : (value ?? null) };
  } catch (error) {
    answer = { error: String(error.message ?? error) };
  }
  process.stdout.write(`${JSON.stringify(answer)}\n`);
}
await browser.close();
