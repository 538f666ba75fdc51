// Chromium without a window and without a graphics card (SwiftShader), driven over its own protocol by
// a pipe; and a server for the files that pages load. Needs node alone.
import {spawn} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync} from "node:fs";
import {createServer} from "node:http";
import {tmpdir} from "node:os";
import {join, normalize} from "node:path";

const program = process.env.FATHOM_CHROMIUM || "chromium";

export async function launch() {
  const profile = mkdtempSync(join(tmpdir(), "fathom-browser-"));
  const flags = ["--headless=new", "--remote-debugging-pipe", "--user-data-dir=" + profile, "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-dev-shm-usage", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--hide-scrollbars"];
  if (process.getuid() === 0) flags.push("--no-sandbox"); // Chromium asks for that of root
  const child = spawn(program, [...flags, "about:blank"], {stdio: ["ignore", "ignore", "pipe", "pipe", "pipe"]});
  let words = "", rest = "", next = 1, over = null;
  const answers = new Map(), listeners = new Map();
  child.stderr.on("data", d => { words = (words + d).slice(-4000); });
  const ended = new Promise(resolve => {
    const end = why => {
      over = new Error(why);
      for (const {reject} of answers.values()) reject(over);
      resolve();
    };
    child.on("exit", status => end(program + " ended with " + status + ": " + words));
    child.on("error", e => end(program + " cannot be run (" + e.message + "); FATHOM_CHROMIUM names another"));
  });
  child.stdio[3].on("error", () => {}); // it ended: `exit` tells
  child.stdio[4].on("data", data => {
    const parts = (rest + data).split("\0");
    rest = parts.pop();
    for (const m of parts.map(p => JSON.parse(p))) {
      const a = answers.get(m.id);
      if (!a) { for (const f of listeners.get(m.sessionId) || []) f(m.method, m.params); continue; }
      answers.delete(m.id);
      if (m.error) a.reject(new Error(a.method + ": " + m.error.message));
      else a.resolve(m.result);
    }
  });
  child.stdio[4].setEncoding("utf8");
  const send = (method, params = {}, sessionId) => new Promise((resolve, reject) => {
    if (over) return reject(over);
    const id = next++;
    answers.set(id, {resolve, reject, method});
    child.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + "\0");
  });
  return {
    version: async () => (await send("Browser.getVersion")).product,
    open: size => open(send, listeners, size),
    async close() {
      await send("Browser.close").catch(() => {});
      await ended;
      rmSync(profile, {recursive: true, force: true, maxRetries: 20, retryDelay: 100});
    }
  };
}

// A page of that size. `said`: what stood on its console, and what was thrown in it.
async function open(send, listeners, {width, height, mobile = false}) {
  const {targetId} = await send("Target.createTarget", {url: "about:blank", newWindow: true});
  const {sessionId} = await send("Target.attachToTarget", {targetId, flatten: true});
  const ask = (method, params) => send(method, params, sessionId), said = [], heard = [];
  listeners.set(sessionId, [(method, p) => {
    if (method === "Runtime.consoleAPICalled") said.push(p.args.map(a => a.value ?? a.description).join(" "));
    if (method === "Runtime.exceptionThrown") said.push(p.exceptionDetails.exception?.description || p.exceptionDetails.text);
    if (method === "Log.entryAdded" && !(p.entry.url || "").endsWith("/favicon.ico")) said.push(p.entry.text);
    for (const h of [...heard]) if (h.method === method) { heard.splice(heard.indexOf(h), 1); h.resolve(p); }
  }]);
  const hear = method => new Promise(resolve => heard.push({method, resolve}));
  for (const domain of ["Page", "Runtime", "Log"]) await ask(domain + ".enable");
  const page = {
    said, ask,
    resize: (width, height, mobile = false) => ask("Emulation.setDeviceMetricsOverride", {width, height, deviceScaleFactor: 1, mobile}),
    before: source => ask("Page.addScriptToEvaluateOnNewDocument", {source}),
    async go(url) {
      const loaded = hear("Page.loadEventFired"), {errorText} = await ask("Page.navigate", {url});
      if (errorText) throw new Error(url + ": " + errorText);
      await loaded;
    },
    // What a function of the page gives for arguments of JSON.
    async run(what, ...values) {
      const expression = typeof what === "string" ? what : "(" + what + ")(" + values.map(v => JSON.stringify(v)).join(", ") + ")";
      const {result, exceptionDetails: wrong} = await ask("Runtime.evaluate", {expression, awaitPromise: true, returnByValue: true, userGesture: true});
      if (wrong) throw new Error(wrong.exception?.description || wrong.text);
      return result.value;
    },
    async until(what, seconds = 60, ...values) {
      for (const end = Date.now() + 1000 * seconds;;) {
        const value = await page.run(what, ...values);
        if (value) return value;
        if (Date.now() > end) throw new Error("not within " + seconds + " s: " + what + (said.length ? "; said: " + said.join("; ") : ""));
        await new Promise(r => setTimeout(r, 20));
      }
    },
    mouse: (type, x, y, more = {}) => ask("Input.dispatchMouseEvent", {type, x, y, button: type === "mouseMoved" || type === "mouseWheel" ? "none" : "left",
      clickCount: type === "mouseWheel" ? 0 : 1, ...more}),
    touch: (type, ...points) => ask("Input.dispatchTouchEvent", {type, touchPoints: points.map(([x, y], id) => ({x, y, id}))}),
    async key(key) { for (const type of ["keyDown", "keyUp"]) await ask("Input.dispatchKeyEvent", {type, key, text: type === "keyDown" && key.length === 1 ? key : undefined}); },
    async shot() { return Buffer.from((await ask("Page.captureScreenshot", {format: "png"})).data, "base64"); },
    async close() { await send("Target.closeTarget", {targetId}); listeners.delete(sessionId); }
  };
  await page.resize(width, height, mobile);
  return page;
}

// Per cent of the pixels of two PNGs (bytes) that differ by more than 8 of 255 in some channel; `page` decodes them.
export const difference = (page, a, b) => page.run(async (a, b) => {
  const pixels = async bytes => {
    const image = new Image();
    image.src = "data:image/png;base64," + bytes;
    await image.decode();
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height);
  };
  const x = await pixels(a), y = await pixels(b);
  if (x.width !== y.width || x.height !== y.height) throw new Error("the sizes differ: " + [x.width, x.height, y.width, y.height]);
  let differing = 0;
  for (let i = 0; i < x.data.length; i += 4) if ([0, 1, 2].some(k => Math.abs(x.data[i + k] - y.data[i + k]) > 8)) ++differing;
  return 400 * differing / x.data.length;
}, a.toString("base64"), b.toString("base64"));

// The picture that the page's view shows, as the bytes of a PNG.
export const picture = async page => Buffer.from(await page.run(async () => {
  const blob = await document.querySelector("fathom-view").picture(), bytes = new Uint8Array(await blob.arrayBuffer());
  let text = "";
  for (const b of bytes) text += String.fromCharCode(b);
  return btoa(text);
}), "base64");

// Files of a folder, to this machine alone: {address, close}.
export const serve = folder => new Promise(resolve => {
  const kinds = {html: "text/html", js: "text/javascript", json: "application/json", png: "image/png"};
  const server = createServer((asked, answer) => {
    const file = join(folder, normalize(decodeURIComponent(new URL(asked.url, "http://a").pathname)));
    try {
      const bytes = readFileSync(file);
      answer.writeHead(200, {"Content-Type": kinds[file.split(".").pop()] || "text/plain"});
      answer.end(bytes);
    } catch { answer.writeHead(404); answer.end(); }
  });
  server.listen(0, "127.0.0.1", () => resolve({address: "http://127.0.0.1:" + server.address().port + "/",
    close() { server.closeAllConnections(); server.close(); }}));
});
