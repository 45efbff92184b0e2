// A browser under the control of a test: WebDriver (W3C) spoken with chromedriver, nothing but Node's own library.

import { spawn } from "node:child_process";
import { writeFileSync } from "node:fs";

const waitMilliseconds = 20000;

/** What a browser says because a test looks at its pixels, not because of the page. */
const ofTests = ["GPU stall", "Multiple readback operations using getImageData"];

export async function startBrowser({ driver, browser, width = 1280, height = 720, reducedMotion = false, phone = false }) {
  const process = spawn(driver, ["--port=0"], { stdio: ["ignore", "pipe", "inherit"] });
  const port = await new Promise((resolve, reject) => {
    let text = "";
    process.stdout.on("data", (data) => {
      text += data;
      const found = /successfully on port (\d+)/.exec(text);
      if (found) resolve(found[1]);
    });
    process.on("exit", (code) => reject(new Error(`${driver} ended with ${code}: ${text}`)));
    setTimeout(() => reject(new Error(`${driver} names no port: ${text}`)), waitMilliseconds);
  });
  const flags = ["--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--hide-scrollbars",
                 `--window-size=${width},${height}`];
  if (reducedMotion) flags.push("--force-prefers-reduced-motion");
  const options = { binary: browser, args: flags };
  // A window of the desktop is no narrower than 500 px.
  if (phone) options.mobileEmulation = { deviceMetrics: { width, height, pixelRatio: 3, touch: true } };
  const capabilities = { alwaysMatch: { browserName: "chrome", "goog:chromeOptions": options,
                                        "goog:loggingPrefs": { browser: "ALL" } } };
  const base = `http://127.0.0.1:${port}/session`;
  try {
    const session = await call("POST", base, { capabilities });
    return new Browser(`${base}/${session.sessionId}`, process);
  } catch (error) {
    process.removeAllListeners("exit");
    process.kill();
    throw error;
  }
}

async function call(method, address, body) {
  const answer = await fetch(address, { method, body: body === undefined ? undefined : JSON.stringify(body) });
  const { value } = await answer.json();
  if (!answer.ok) throw new Error(`${method} ${address}: ${value.error}: ${value.message}`);
  return value;
}

class Browser {
  constructor(session, process) {
    this.session = session;
    this.process = process;
  }

  post(path, body = {}) {
    return call("POST", this.session + path, body);
  }

  open(file) {
    return this.post("/url", { url: `file://${file}` });
  }

  /** Runs the body of a function in the page. */
  run(script, ...args) {
    return this.post("/execute/sync", { script, args });
  }

  runAsync(script, ...args) {
    return this.post("/execute/async", { script, args });
  }

  keys(text) {
    const actions = [...text].flatMap((value) => [{ type: "keyDown", value }, { type: "keyUp", value }]);
    return this.post("/actions", { actions: [{ type: "key", id: "keys", actions }] });
  }

  /** Moves the pointer over the page; presses it if asked. */
  point(x, y, press = false) {
    const actions = [{ type: "pointerMove", duration: 0, x: Math.round(x), y: Math.round(y) }];
    if (press) actions.push({ type: "pointerDown", button: 0 }, { type: "pointerUp", button: 0 });
    return this.post("/actions", { actions: [{ type: "pointer", id: "mouse", actions }] });
  }

  /** Errors and warnings of the console since the last call. */
  async complaints() {
    const entries = await this.post("/se/log", { type: "browser" });
    return entries.filter((entry) => entry.level === "SEVERE" || entry.level === "WARNING")
        .map((entry) => entry.message).filter((message) => !ofTests.some((words) => message.includes(words)));
  }

  async screenshot(file) {
    writeFileSync(file, Buffer.from(await call("GET", `${this.session}/screenshot`), "base64"));
  }

  async quit() {
    await call("DELETE", this.session).catch(() => undefined);
    this.process.removeAllListeners("exit");
    this.process.kill();
  }
}
