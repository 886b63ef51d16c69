// SPDX-License-Identifier: MIT
// The way to the panel: a WebSocket to ./tools/panel --web, or a worker in which the panel runs.
//
//     const link = connect({ take, tell, gone });
//     link.say({ t: "down", key: "STOP" });
//
// take(message): what the panel says, tools/live/README.md. tell(text): how the connection is.
// gone(): whatever was held is not held any more.

const AGAIN_MS = [300, 1000, 3000];
const ALIVE_MS = 100; // the panel lets go of all keys after three of these
const POLICY = 1008;
const GOING_AWAY = 1001;

export const TEXTS = {
  connecting: "Connecting ...",
  connected: "Connected",
  again: "No connection to the panel. It lets go of all keys, and stops the drives if nobody else is there.",
  refused: "The panel does not let this page in. Open the link that ./tools/panel --web has printed.",
  loading: "Loading the panel ...",
  broken: "The panel has failed: ",
};

export function connect(handlers) {
  const kind = document.querySelector('meta[name="link"]').content;
  const way = kind === "worker" ? new WorkerWay(handlers) : new SocketWay(handlers);
  return new Link(way);
}

// Says that the page is there as long as somebody can see it.
class Link {
  constructor(way) {
    this.way = way;
    way.opened = () => this.greet();
    setInterval(() => this.isSeen() && way.say({ t: "alive" }), ALIVE_MS);
    document.addEventListener("visibilitychange", () => this.greet());
    window.addEventListener("pagehide", () => way.say({ t: "bye" }));
    window.addEventListener("pageshow", () => this.greet());
    way.open();
  }

  isSeen() {
    return document.visibilityState === "visible";
  }

  greet() {
    this.way.say(this.isSeen() ? { t: "hello", v: 1 } : { t: "bye" });
  }

  say(message) {
    this.way.say(message);
  }
}

class SocketWay {
  constructor(handlers) {
    this.handlers = handlers;
    this.tries = 0;
    this.wasLetIn = false;
    this.socket = null;
  }

  open() {
    const token = encodeURIComponent(location.hash.slice(1));
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(`${scheme}//${location.host}/panel?token=${token}`);
    socket.onopen = () => {
      this.wasLetIn = true;
      this.tries = 0;
      this.handlers.tell(TEXTS.connected, "good");
      this.opened();
    };
    socket.onmessage = (event) => {
      event.data.split("\n").forEach((line) => this.handlers.take(JSON.parse(line)));
    };
    socket.onclose = (event) => this.closed(event);
    this.socket = socket;
  }

  closed(event) {
    this.socket = null;
    this.handlers.gone();
    if (event.code === POLICY || event.code === GOING_AWAY) {
      this.handlers.tell(`Disconnected: ${event.reason}.`, "bad");
      return;
    }
    this.handlers.tell(this.wasLetIn ? TEXTS.again : TEXTS.refused, "bad");
    const again = AGAIN_MS[Math.min(this.tries, AGAIN_MS.length - 1)];
    this.tries += 1;
    setTimeout(() => this.open(), again);
  }

  say(message) {
    if (this.socket?.readyState === WebSocket.OPEN) {
      this.socket.send(JSON.stringify(message));
    }
  }
}

class WorkerWay {
  constructor(handlers) {
    this.handlers = handlers;
    this.worker = null;
  }

  open() {
    this.handlers.tell(TEXTS.loading, "");
    const worker = new Worker(new URL("worker.js", import.meta.url), {
      type: "module",
      name: location.search.slice(1), // its options
    });
    worker.onmessage = ({ data }) => {
      if (data.ready) {
        this.worker = worker;
        this.handlers.tell(TEXTS.connected, "good");
        this.opened();
      } else if (data.failed) {
        this.failed(data.failed);
      } else {
        data.lines.forEach((line) => this.handlers.take(JSON.parse(line)));
      }
    };
    worker.onerror = (event) => this.failed(event.message);
  }

  failed(text) {
    this.worker = null;
    this.handlers.gone();
    this.handlers.tell(TEXTS.broken + text, "bad");
  }

  say(message) {
    this.worker?.postMessage(JSON.stringify(message));
  }
}
