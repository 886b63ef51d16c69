// SPDX-License-Identifier: MIT
// The panel without a server: MicroPython in a worker runs the same files as ./tools/panel does.

import { loadMicroPython } from "./micropython.mjs";

const TURN_MS = 10;
const HEAP_BYTES = 16 * 1024 * 1024;
// What the address of the page may say: ?drives=1,2=g110&keys=compact
const OPTIONS = ["drives", "baud", "keys", "seed"];

async function begin() {
  const kit = await (await fetch("firmware.json")).json();
  const python = await loadMicroPython({
    url: new URL("micropython.wasm", import.meta.url).href,
    heapsize: HEAP_BYTES,
    stdout: (line) => console.log(line),
  });
  for (const [path, text] of Object.entries(kit.files)) {
    python.FS.mkdirTree(`/panel/${path}`.replace(/\/[^/]*$/, ""));
    python.FS.writeFile(`/panel/${path}`, text);
  }
  python.runPython('import sys; sys.path[:] = ["/panel", "/panel/firmware"]');
  python.runPython("from tools.live.in_browser import begin, take, turn");
  const name = (word) => python.globals.get(word);
  name("begin")(JSON.stringify(chosen(kit.options)));
  const [take, turn] = [name("take"), name("turn")];
  self.onmessage = ({ data }) => attempt(() => take(data));
  self.postMessage({ ready: true });
  const timer = setInterval(() => attempt(pass), TURN_MS);

  function pass() {
    const said = turn();
    if (said) self.postMessage({ lines: said.trimEnd().split("\n") });
  }

  // Whatever fails here has failed for good.
  function attempt(deed) {
    try {
      deed();
    } catch (error) {
      clearInterval(timer);
      self.onmessage = null;
      self.postMessage({ failed: String(error.message ?? error) });
    }
  }
}

function chosen(usual) {
  const asked = new URLSearchParams(self.name);
  const options = { ...usual };
  for (const name of OPTIONS) {
    const value = asked.get(name);
    if (value !== null) options[name] = /^\d+$/.test(value) && name !== "drives" ? Number(value) : value;
  }
  return options;
}

begin().catch((error) => self.postMessage({ failed: String(error.message ?? error) }));
