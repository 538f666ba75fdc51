// The pages of some small scenes in Chromium, as people use them: part of ./fathom-test.
//   node short.mjs FATHOM MODULE.js [NAME…]      the tests of these names alone
// Prints a line a test; exit status 1 where one fails.
import {execFileSync, spawnSync} from "node:child_process";
import {copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {dirname, join, resolve} from "node:path";
import {difference, launch, picture, serve} from "./chromium.mjs";

const [fathom, module, ...wanted] = process.argv.slice(2).map((word, i) => i < 2 ? resolve(word) : word);
const folder = mkdtempSync(join(tmpdir(), "fathom-pages-")), size = {width: 320, height: 180};

const must = (holds, what) => { if (!holds) throw new Error(what); };
const same = (a, b, what) => must(JSON.stringify(a) === JSON.stringify(b), what + ": " + JSON.stringify(a) + ", not " + JSON.stringify(b));
const near = async (a, b, what) => { const d = await difference(blank, a, b); must(d < 0.5, what + ": " + d.toFixed(2) + " % of the pixels differ"); };
const apart = async (a, b, what) => must(await difference(blank, a, b) > 1, what);
const write = (name, text) => writeFileSync(join(folder, name), text);
const run = (...words) => execFileSync(fathom, words, {cwd: folder, stdio: "pipe"});
const compiled = (name, text) => { write(name + ".sdf", text); run("compile", name + ".sdf", "--target", "html", "-o", name + ".html"); };
const rendered = (name, ...more) => { run("render", name + ".sdf", "--size", size.width + "x" + size.height, "--samples", "1", "-o", name + ".png", ...more); return join(folder, name + ".png"); };
const bytes = file => readFileSync(file);

// Waits until the page's view has drawn `samples` of the present state.
const rest = (page, samples = 1) => page.until(n => { const v = document.querySelector("fathom-view"); return v.scene && v.drawn >= n; }, 60, samples);
const view = (page, what, ...values) => page.run("(" + what + ")(document.querySelector('fathom-view'), " + values.map(v => JSON.stringify(v)).join(", ") + ")");
const words = page => page.run(() => document.querySelector("fathom-view").shadowRoot.querySelector("[role=status]").textContent);
const middle = (page, selector) => page.run(selector => {
  const r = document.querySelector("fathom-view").shadowRoot.querySelector(selector).getBoundingClientRect();
  return [r.x + r.width / 2, r.y + r.height / 2];
}, selector);
const quiet = page => same(page.said, [], "the console");

const scene = `param radius = 1 in 0.5..1.5 "Radius"
param angle = 30deg in 0deg..90deg "Angle"
param tint = #d94f2b
param many = 2 in 1..3 "How many"
param holed = true
param far = 0 in 0.0..2.0
for i in 0..many { box(radius).rotate(angle, axis: Y).translate(x: 2 * i).paint(tint) }
if holed { sphere(0.4).translate(y: 1) } else { torus(1, 0.2).translate(y: 1) }
if far > 1.5 { sphere(0.2).translate(y: -2) }
sphere(0.6).translate(y: 1.6, z: 1).paint(material(texture: image("tiles.png")))
camera(at: [4, 3, 9], look_at: [1.5, 0, 0])
`;
const moving = "sphere(0.5).translate(x: sin(time))\nbox([4, 0.1, 4]).translate(y: -0.7)\ncamera(at: [0, 1, 5], look_at: [0, 0, 0])\n";

const tests = {
  async "a picture equals that of fathom render, with an image and params"() {
    compiled("scene", scene);
    const page = await fresh("scene.html#samples=1");
    await rest(page);
    await near(await picture(page), bytes(rendered("scene")), "the page and fathom render");
    quiet(page);
    must(await words(page) === "", "the page says " + await words(page));
    await page.close();
  },
  async "a param that decides what there is has a text for each value"() {
    compiled("scene", scene);
    const page = await fresh("scene.html#samples=1");
    await rest(page);
    const first = await picture(page), inputs = await view(page, v => v.inputs.map(p => [p.name, p.values]));
    same(inputs.filter(([, values]) => values).map(([name, values]) => [name, values.flat()]).sort(), [["far", [0]], ["holed", [0, 1]], ["many", [1, 2, 3]]], "the values");
    await view(page, v => { v.params = {many: 3, holed: false}; });
    await rest(page);
    await near(await picture(page), bytes(rendered("scene", "-D", "many=3", "-D", "holed=false")), "three with a torus");
    await apart(await picture(page), first, "three with a torus look like the first");
    const fixed = await view(page, v => [...v.shadowRoot.querySelectorAll("details p")].map(p => p.textContent));
    same(fixed, ["far = 0 (fixed here: each value is a scene of its own)"], "what is fixed");
    quiet(page);
    await page.close();
  },
  async "values that do not compile are left out, and said"() {
    write("broken.sdf", "param n = 2 in 1..3\nparam on = false\nif n == 3 { sphere(-1) } else { sphere(n) }\nif on and n == 1 { box(-1) } else { box(n) }\ncamera(at: [0, 2, 9], look_at: [0, 0, 0])\n");
    const said = spawnSync(fathom, ["compile", "broken.sdf", "--target", "html", "-o", "broken.html"], {cwd: folder});
    same(said.status, 0, "the exit status");
    for (const words of ["`n` = 3, `on` = false", "`n` = 3, `on` = true", "`n` = 1, `on` = true"]) must(said.stderr.toString().includes(words), words + " is not said: " + said.stderr);
    must(!said.stderr.toString().includes("`n` = 2"), "what compiles is said to fail");
    const page = await fresh("broken.html#samples=1");
    same(await view(page, v => v.inputs.map(p => p.values.flat())), [[1, 2], [0, 1]], "the values");
    await view(page, v => { v.params = {n: 1}; });
    await rest(page);
    await near(await picture(page), bytes(rendered("broken", "-D", "n=1")), "n = 1");
    await view(page, v => { v.params = {on: true}; });
    await page.until(() => document.querySelector("fathom-view").shadowRoot.querySelector("[role=status]").textContent.includes("does not compile"), 5);
    await view(page, v => { v.params = {n: 2}; });
    await rest(page);
    await near(await picture(page), bytes(rendered("broken", "-D", "n=2", "-D", "on=true")), "n = 2, on");
    must(await words(page) === "", "it still says " + await words(page));
    quiet(page);
    await page.close();
  },
  async "a slider and a list move what they name, and the address says it"() {
    compiled("scene", scene);
    const page = await fresh("scene.html#samples=1");
    await page.resize(900, 700);
    await view(page, v => { v.shadowRoot.querySelector("details").open = true; });
    await rest(page);
    const [x, y] = await middle(page, "input[type=range]");
    await page.mouse("mousePressed", x + 60, y);
    await page.mouse("mouseReleased", x + 60, y);
    const radius = await view(page, v => v.params.radius);
    must(radius > 1.05 && radius <= 1.5, "a click right of the middle gave " + radius);
    await page.until(r => location.hash.includes("param_radius=" + String(Number(r.toPrecision(4)))), 5, radius);
    await view(page, v => { const s = v.shadowRoot.querySelector("select"); s.selectedIndex = 0; s.dispatchEvent(new Event("input")); });
    await page.until(() => location.hash.includes("param_many=1"), 5);
    must(await view(page, v => [...v.shadowRoot.querySelectorAll("output")].some(o => o.textContent === "30 deg of 0 to 90 deg")), "the angle has no unit");
    const there = await page.run(() => location.hash), again = await fresh("scene.html" + there);
    same(await view(again, v => [v.params.many, v.params.radius]), [1, Number(radius.toPrecision(4))], "what the address opens");
    quiet(page), quiet(again);
    await page.close(), await again.close();
  },
  async "the mouse turns, the keys too, and the first view comes back"() {
    compiled("scene", scene);
    const page = await fresh("scene.html#samples=1");
    await rest(page);
    const first = await picture(page), camera = await view(page, v => v.camera);
    await page.mouse("mousePressed", 280, 90);
    await page.mouse("mouseMoved", 230, 90, {buttons: 1});
    await page.mouse("mouseReleased", 230, 90);
    const turned = await view(page, v => v.camera);
    must(Math.abs(turned.around - camera.around - 0.4) < 1e-6, "50 pixels turn by " + (turned.around - camera.around));
    await page.key("ArrowUp");
    must(Math.abs((await view(page, v => v.camera)).above - camera.above - 0.1) < 1e-6, "an arrow turns by a tenth");
    const seen = () => view(page, v => [v.camera.around, v.camera.above]);
    for (const [key, there] of [["1", [0, 0]], ["3", [Math.PI / 2, 0]], ["7", [0, 1.57]], ["R", [camera.around, camera.above]]]) {
      await page.key(key);
      same(await seen(), there, "the view of the key " + key);
    }
    must(!await view(page, v => !v.shadowRoot.querySelector("canvas").dispatchEvent(new KeyboardEvent("keydown", {key: "r", ctrlKey: true, cancelable: true}))), "the browser's own key is taken");
    await page.mouse("mouseWheel", 280, 90, {deltaX: 0, deltaY: 200});
    await page.until(z => document.querySelector("fathom-view").camera.zoom > z, 5, camera.zoom);
    await rest(page);
    await apart(await picture(page), first, "a turned picture looks like the first");
    await view(page, v => v.home());
    await rest(page);
    await near(await picture(page), first, "the first view");
    quiet(page);
    await page.close();
  },
  async "time plays, pauses and is in the address"() {
    compiled("moving", moving);
    const page = await fresh("moving.html#samples=1");
    await page.until(() => document.querySelector("fathom-view").time > 0.05);
    await page.mouse("mousePressed", 300, 150);
    await page.mouse("mouseReleased", 300, 150);
    await page.key(" ");
    must(!await view(page, v => v.playing), "the space bar does not pause");
    await view(page, v => { v.time = 1.5; });
    await rest(page);
    await near(await picture(page), bytes(rendered("moving", "--time", "1.5")), "1.5 s");
    const again = await fresh("moving.html#samples=1&time=1.5");
    await rest(again);
    same(await view(again, v => [v.time, v.playing]), [1.5, false], "the address' time");
    quiet(page), quiet(again);
    await page.close(), await again.close();
  },
  async "what is clicked: time, speed, a side, a picture to keep, and the full screen"() {
    compiled("moving", moving);
    const page = await browser.open({width: 340, height: 300});
    await page.go(site.address + "moving.html#samples=1");
    await view(page, v => { v.shadowRoot.querySelector("details").open = true; });
    const click = async ([x, y]) => { for (const type of ["mousePressed", "mouseReleased"]) await page.mouse(type, x, y); };
    const button = text => page.run(text => {
      const all = [...document.querySelector("fathom-view").shadowRoot.querySelectorAll("button")], r = all.find(b => b.textContent === text).getBoundingClientRect();
      return [r.x + r.width / 2, r.y + r.height / 2];
    }, text);
    await click(await middle(page, "[aria-label='Speed of the time']"));
    await view(page, v => v.shadowRoot.activeElement.select());
    await page.key("3");
    same(await view(page, v => [v.speed, v.playing]), [3, true], "the speed that is typed");
    await click(await middle(page, "[aria-label='Time, seconds']"));
    const time = await view(page, v => v.time);
    must(!await view(page, v => v.playing) && time > 25 && time < 35, "a click in the middle of a minute gave " + time);
    await click(await button("Play"));
    await page.until(time => document.querySelector("fathom-view").time > time, 5, time);
    await click(await button("Pause"));
    const before = await view(page, v => v.camera);
    await click(await button("Top"));
    same(await view(page, v => v.camera), {...before, around: 0, above: 1.57}, "the camera above");
    await page.until(() => location.hash.includes("view=0,1.57"), 5);
    await rest(page);
    await page.ask("Page.setDownloadBehavior", {behavior: "allow", downloadPath: join(folder, "kept")});
    await click(await button("Save picture"));
    const kept = join(folder, "kept", "moving.png"); // beside what the other tests render
    for (const end = Date.now() + 10000; !existsSync(kept); await new Promise(r => setTimeout(r, 20))) must(Date.now() < end, "no picture is kept");
    same(await difference(blank, bytes(kept), await picture(page)), 0, "the pixels of the kept picture that differ");
    await click(await button("Full screen"));
    await page.until(() => document.fullscreenElement === document.querySelector("fathom-view"), 5);
    await click(await button("Full screen"));
    await page.until(() => document.fullscreenElement === null, 5);
    quiet(page);
    await page.close();
  },
  async "one finger turns, two come nearer, and a phone's layout fits"() {
    compiled("scene", scene);
    const page = await fresh("scene.html#samples=1");
    await page.ask("Emulation.setTouchEmulationEnabled", {enabled: true, maxTouchPoints: 5});
    await page.resize(390, 700, true);
    await rest(page);
    const camera = await view(page, v => v.camera);
    await page.touch("touchStart", [200, 400]);
    await page.touch("touchMove", [250, 400]);
    await page.touch("touchMove", [260, 400]);
    await page.touch("touchEnd");
    const turned = await view(page, v => v.camera);
    must(turned.around < camera.around - 0.1, "a finger does not turn");
    await page.touch("touchStart", [150, 400], [250, 400]);
    await page.touch("touchMove", [100, 400], [300, 400]);
    await page.touch("touchEnd");
    must((await view(page, v => v.camera)).zoom < 0.7 * turned.zoom, "two fingers do not come nearer");
    must(await page.run(() => document.documentElement.scrollWidth <= 390), "it is wider than 390 pixels");
    must(!await view(page, v => v.shadowRoot.querySelector("details").open), "the panel covers a phone's picture");
    const ink = async scheme => {
      await page.ask("Emulation.setEmulatedMedia", {features: [{name: "prefers-color-scheme", value: scheme}]});
      return view(page, v => getComputedStyle(v).color);
    };
    same([await ink("light"), await ink("dark")], ["rgb(17, 17, 17)", "rgb(238, 238, 238)"], "the ink of the two themes");
    quiet(page);
    await page.close();
  },
  async "it follows its window, and draws again what the window lost"() {
    compiled("scene", scene);
    const page = await fresh("scene.html#samples=1");
    await rest(page);
    const first = await picture(page);
    await page.resize(200, 300);
    await page.until(() => document.querySelector("fathom-view").shadowRoot.querySelector("canvas").width === 200);
    await page.resize(size.width, size.height);
    await page.until(() => document.querySelector("fathom-view").shadowRoot.querySelector("canvas").width === 320);
    await rest(page);
    await near(await picture(page), first, "the old size again");
    quiet(page);
    await page.close();
  },
  async "a lost context says so and comes back, and gives up in words"() {
    compiled("scene", scene);
    const page = await fresh("scene.html#samples=1");
    await rest(page);
    const first = await picture(page);
    for (let time = 1; time <= 4; ++time) {
      await page.run(() => {
        const gl = document.querySelector("fathom-view").shadowRoot.querySelector("canvas").getContext("webgl2");
        window.lose = gl.getExtension("WEBGL_lose_context") || window.lose;
        window.lose.loseContext();
      });
      await page.until(() => document.querySelector("fathom-view").shadowRoot.querySelector("[role=status]").textContent.includes("driver"), 10);
      if (time === 4) break;
      await page.run(() => new Promise(r => setTimeout(() => { window.lose.restoreContext(); r(); }, 50)));
      await page.until(() => document.querySelector("fathom-view").shadowRoot.querySelector("[role=status]").textContent === "", 20);
      await rest(page);
      await near(await picture(page), first, "after the loss");
    }
    must((await words(page)).includes("Reload"), "the fourth time it says: " + await words(page));
    quiet(page);
    await page.close();
  },
  async "without WebGL 2 it says so"() {
    compiled("scene", scene);
    const page = await browser.open(size);
    await page.before("HTMLCanvasElement.prototype.getContext = () => null");
    await page.go(site.address + "scene.html");
    await page.until(() => document.querySelector("fathom-view").shadowRoot.querySelector("[role=status]").textContent.includes("WebGL 2"), 10);
    quiet(page);
    await page.close();
  },
  async "a page that holds it scrolls past it until it is clicked"() {
    compiled("scene", scene);
    write("blog.html", "<!doctype html><body style='margin: 0; height: 3000px'><iframe src=scene.html width=300 height=150></iframe>");
    const page = await fresh("blog.html");
    const inside = what => page.run("document.querySelector('iframe').contentDocument.querySelector('fathom-view')" + what);
    await page.until("(document.querySelector('iframe').contentDocument.querySelector('fathom-view')?.scene && document.querySelector('iframe').contentDocument.querySelector('fathom-view').drawn) > 0");
    await page.mouse("mouseWheel", 150, 75, {deltaX: 0, deltaY: 20});
    await page.until(() => scrollY > 0, 5);
    same(await inside(".camera.zoom"), 1, "the zoom after the page was scrolled");
    await page.run(() => scrollTo(0, 0));
    await page.mouse("mousePressed", 250, 75);
    await page.mouse("mouseReleased", 250, 75);
    await page.mouse("mouseWheel", 250, 75, {deltaX: 0, deltaY: 20});
    await page.until("document.querySelector('iframe').contentDocument.querySelector('fathom-view').camera.zoom > 1", 5);
    same(await page.run(() => scrollY), 0, "the page's scroll after the click");
    quiet(page);
    await page.close();
  },
  async "in a notebook's frame, which has no address, it works"() {
    compiled("scene", scene);
    write("notebook.html", "<!doctype html><iframe sandbox='allow-scripts' width=300 height=150></iframe>");
    const page = await fresh("notebook.html");
    const text = bytes(join(folder, "scene.html")).toString();
    const empty = await page.shot();
    await page.run(text => { document.querySelector("iframe").srcdoc = text; }, text);
    for (const end = Date.now() + 20000; await difference(blank, await page.shot(), empty) < 5;) must(Date.now() < end, "the frame stays empty");
    await page.mouse("mousePressed", 250, 75);
    await page.mouse("mouseMoved", 230, 75, {buttons: 1});
    await page.mouse("mouseReleased", 230, 75);
    await new Promise(r => setTimeout(r, 600));
    quiet(page);
    await page.close();
  },
  async "its policy lets nothing in and nothing out"() {
    compiled("scene", scene);
    const page = await fresh("scene.html");
    const [ran, sent, evaluated] = await page.run(async () => {
      const script = document.createElement("script");
      script.textContent = "window.ran = true";
      document.body.append(script);
      const image = new Image(), loaded = new Promise(r => { image.onload = () => r(true); image.onerror = () => r(false); });
      image.src = "/scene.png";
      document.body.setAttribute("onclick", "window.ran = true");
      document.body.click();
      return [Boolean(window.ran), await fetch("/scene.html").then(() => true, () => false) || await loaded, (() => { try { return new Function("return true")(); } catch { return false; } })()];
    });
    same([ran, sent, evaluated], [false, false, false], "a script ran, something was fetched, text was evaluated");
    must(page.said.length > 0 && page.said.every(s => s.includes("Content Security Policy")), "the console: " + page.said.join("; "));
    await page.close();
  },
  async "hostile names and labels change no markup"() {
    const bits = ["</script>", "<script>window.ran=1</script>", "<img src=x onerror=window.ran=1>", "\\\"", "'", "<!--", "-->", "]]>", "&lt;", "&#60;", "\\u{2028}", "javascript:", "</title>", "`", "${window.ran=1}", "$TITLE", "{}", "\\\\", "ä", "</fathom-view>"];
    let seed = 7;
    const random = n => { seed = (seed * 1103515245 + 12345) % 2147483648; return Math.floor(seed / 2147483648 * n); };
    const labels = Array.from({length: 60}, () => Array.from({length: 1 + random(6)}, () => bits[random(bits.length)]).join(""));
    const text = labels.map((l, i) => `param p${i} = 1 in 0.5..1.5 "${l.replaceAll("\\u{2028}", "\u2028")}"\n`).join("") +
      "sphere(" + labels.map((_, i) => "p" + i).join(" + ") + ")\n";
    const name = "x'\"><img src=x onerror=window.ran=1><script>window.ran=1<_script>&amp;$SCRIPT";
    compiled(name, text);
    compiled("plain", text.replace(/"[^\n]*"\n/g, "\"label\"\n"));
    const page = await fresh(encodeURIComponent(name + ".html").replaceAll("'", "%27")), plain = await fresh("plain.html");
    const markup = p => p.run(() => [document, document.querySelector("fathom-view").shadowRoot].map(d => [...d.querySelectorAll("*")].map(e => e.tagName).join(" ")));
    await rest(page), await rest(plain);
    same(await markup(page), await markup(plain), "the elements");
    same(await page.run(() => document.title), name, "the title");
    must(!await page.run(() => window.ran), "a label ran");
    const shown = await view(page, v => [...v.shadowRoot.querySelectorAll("label span")].map(s => s.textContent));
    must(shown.filter(s => s.includes("<")).length > 20 && shown.length === 60, "the labels are shown as they are: " + shown.length);
    quiet(page);
    await page.close(), await plain.close();
  },
  async "names that every object has are names of params like others, and hostile attributes do nothing"() {
    const names = ["__proto__", "toString", "constructor", "hasOwnProperty", "valueOf"];
    compiled("own", names.map(n => `param ${n} = 1 in 0.5..1.5\n`).join("") + "param many = 1 in 1..2\nfor i in 0..many { sphere(" + names.join(" * ") + ").translate(x: 2 * i) }\ncamera(at: [0, 1, 9], look_at: [0, 0, 0])\n");
    const page = await fresh("own.html#samples=1");
    await page.until(() => document.querySelector("fathom-view").drawn >= 1);
    const first = await picture(page);
    for (const [i, name] of names.entries()) {
      await view(page, (v, name) => { v.params = {[name]: 1.25}; }, name);
      same(await view(page, v => Object.values(v.params)), [...names.map((_, k) => k <= i ? 1.25 : 1), 1], "the params after " + name);
    }
    await rest(page);
    await near(await picture(page), bytes(rendered("own", ...names.flatMap(n => ["-D", n + "=1.25"]))), "all five");
    await apart(await picture(page), first, "the five change nothing");
    quiet(page);
    await page.close();

    const bad = "</script><img src=x onerror=window.ran=1>\"'`<!--${window.ran=1}";
    run("compile", "own.sdf", "--target", "es300", "-o", "own.frag", "--reflect", "own.json");
    copyFileSync(module, join(folder, "fathom-view.js"));
    write("bare.html", "<!doctype html><style>fathom-view { width: 320px; height: 180px; aspect-ratio: auto }</style><script type=module src=fathom-view.js></script><fathom-view controls></fathom-view>");
    const host = await fresh("bare.html");
    const markup = () => host.run(() => [document, document.querySelector("fathom-view").shadowRoot].map(d => [...d.querySelectorAll("*")].map(e => e.tagName).join(" ")));
    const give = (word) => host.run(async word => {
      const v = document.querySelector("fathom-view"), reflection = await fetch("own.json").then(r => r.json()), text = await fetch("own.frag").then(r => r.text());
      for (const u of [...reflection.uniforms, ...reflection.constants]) for (const k of ["param", "label", "unit", "meaning"]) if (u[k] !== undefined) u[k] = (k === "param" ? u.name : "") + word;
      v.scene = {title: word, variants: [{reflection, text}]};
      v.samples = 1;
    }, word);
    await give("plain");
    await rest(host);
    const expected = await markup(), shown = await picture(host);
    await give(bad);
    await rest(host);
    same(await markup(), expected, "the elements");
    await near(await picture(host), shown, "the picture");
    for (const src of ["javascript:window.ran=1", "data:text/html," + encodeURIComponent("<script>window.ran=1</script>"), bad, "//" + bad]) {
      await host.run(src => new Promise(r => { const v = document.querySelector("fathom-view"); v.addEventListener("error", r, {once: true}); v.src = src; }), src);
      must((await words(host)).length > 0, "nothing is said of " + src);
      same(await markup(), ["HTML HEAD STYLE SCRIPT BODY FATHOM-VIEW", "DIV"], "the elements of " + src);
    }
    must(!await host.run(() => window.ran), "a name ran");
    await host.close();
  },
  async "the element: a scene of a page and one of a shader, its properties and its events"() {
    compiled("scene", scene);
    run("compile", "scene.sdf", "--target", "es300", "-o", "textured.frag", "--reflect", "textured.json");
    compiled("scene", scene.replace(/.*tiles.png.*\n/g, ""));
    run("compile", "scene.sdf", "--target", "es300", "-o", "scene.frag", "--reflect", "scene.json");
    copyFileSync(module, join(folder, "fathom-view.js"));
    const host = attributes => `<!doctype html><script type=module src=fathom-view.js></script><fathom-view ${attributes} style="width: 320px; height: 180px; aspect-ratio: auto"></fathom-view>
<script>const told = []; for (const e of ["load", "draw", "rest", "change", "error"]) document.querySelector("fathom-view").addEventListener(e, x => told.push(e + (x.detail ? " " + JSON.stringify(x.detail) : "")));</script>`;
    write("host.html", host("src=scene.html controls"));
    write("shader.html", host("src=scene.json shader=scene.frag"));
    write("lost.html", host("src=nothing.html"));
    write("textured.html", host("src=textured.json shader=textured.frag"));
    const expected = bytes(rendered("scene"));
    for (const name of ["host.html", "shader.html"]) {
      const page = await fresh(name);
      await page.until(() => told.includes("load"));
      await view(page, v => { v.samples = 1; });
      await page.until(() => told.includes("rest"));
      await near(await picture(page), expected, name);
      await view(page, v => { v.params = {radius: 1.4, tint: [0, 0, 1]}; told.length = 0; });
      await page.until(() => told.includes("rest"));
      must(!(await page.run(() => told)).some(t => t.startsWith("change")), "what a program sets is told as a change");
      await apart(await picture(page), expected, name + " with another radius");
      same(await view(page, v => [v.params.radius, v.params.tint, v.params.holed]), [1.4, [0, 0, 1], true], "the params");
      for (const wrong of ["v.params = {radius: 9}", "v.params = {nothing: 1}", "v.params = {many: 7}", "v.params = {radius: 'a'}", "v.camera = {zoom: 0}", "v.camera = {x: NaN}", "v.samples = 0", "v.time = -1", "v.speed = 101"])
        same(await view(page, (v, wrong) => { try { new Function("v", wrong)(v); return "taken"; } catch (e) { return e.name; } }, wrong), "RangeError", wrong);
      await page.mouse("mousePressed", 300, 150);
      await page.mouse("mouseMoved", 250, 150, {buttons: 1});
      await page.mouse("mouseReleased", 250, 150);
      await page.until(() => told.includes('change {"what":"camera"}'), 5);
      await view(page, v => { const parent = v.parentNode; v.remove(); parent.append(v); told.length = 0; });
      await page.until(() => told.includes("rest"));
      must(await view(page, v => v.params.radius) === 1.4, "moved to another place it forgets its params");
      quiet(page);
      await page.close();
    }
    for (const [name, word] of [["lost.html", "404"], ["textured.html", "needs the texture"]]) {
      const page = await fresh(name);
      await page.until(word => told.some(t => t.startsWith("error") && t.includes(word)), 10, word);
      must((await words(page)).includes(word), "what is missing is not said");
      await page.close();
    }
  },
  async "an element made by a script, given another scene, and given two at once"() {
    write("one.sdf", "box(1)\n"), write("two.sdf", "sphere(1)\n");
    for (const name of ["one", "two"]) run("compile", name + ".sdf", "--target", "html", "-o", name + ".html");
    copyFileSync(module, join(folder, "fathom-view.js"));
    write("empty.html", "<!doctype html><style>fathom-view { width: 320px; height: 180px; aspect-ratio: auto }</style><script type=module>import * as module from './fathom-view.js'; window.module = module;</script>");
    const page = await fresh("empty.html");
    await page.run(async () => {
      const v = document.createElement("fathom-view");
      try { v.params; } catch (e) { window.early = e.message; }
      v.scene = await module.loadScene("one.html");
      document.body.append(v);
      v.samples = 1;
    });
    must(await page.run(() => early.includes("load")), "before there is a scene it says " + await page.run(() => window.early));
    await rest(page);
    await near(await picture(page), bytes(rendered("one")), "the first scene");
    await view(page, v => { v.src = "nothing.html"; v.src = "two.html"; v.addEventListener("load", () => { v.samples = 1; }); });
    await page.until(() => document.querySelector("fathom-view").scene?.title === "two", 10);
    await rest(page);
    await near(await picture(page), bytes(rendered("two")), "the second scene");
    await view(page, v => { v.src = "one.html"; v.remove(); });
    await new Promise(r => setTimeout(r, 300));
    same(page.said.filter(s => !s.includes("404")), [], "the console");
    await page.close();
  },
  async "a site shows the scene that is clicked, and a lost link is an error"() {
    const script = join(dirname(module), "../scripts/website.py"), out = join(folder, "site");
    write("one.sdf", "box(1)\n"), write("two.sdf", "sphere(1)\n");
    const made = () => spawnSync("python3", [script, fathom, out, "one.sdf", "two.sdf"], {cwd: folder});
    same(made().status, 0, "the exit status");
    const page = await fresh("site/index.html");
    must(await view(page, v => v.hidden && !v.scene), "a scene is loaded before it is wanted");
    await page.run(() => document.querySelector("a[href='two.html']").click());
    await rest(page);
    same(await view(page, v => [v.scene.title, v.hidden]), ["two", false], "what is shown");
    quiet(page);
    await page.close();
    writeFileSync(join(out, "more.html"), "<!doctype html><a href='one.html'>there</a> <a href='nowhere.html'>lost</a>");
    const lost = made();
    same([lost.status, lost.stderr.toString().trim()], [1, "more.html: nowhere.html leads nowhere"], "a lost link");
  },
  async "sines are as right as the proof supposes, whatever the driver's are"() {
    write("sines.sdf", "implicit(p => 0.2 * sin(p.x) * cos(p.y) - p.z, within: ball(9))\n");
    run("compile", "sines.sdf", "--target", "es300", "--field-only", "-o", "sines.frag");
    const ours = ["sine", "sin", "cos"].map(f => new RegExp("float fathom_" + f + "\\([^]*?\n}\n").exec(bytes(join(folder, "sines.frag")).toString())[0]).join("");
    const page = await browser.open(size);
    const wrong = await page.run(ours => {
      const gl = Object.assign(document.createElement("canvas"), {width: 256, height: 64}).getContext("webgl2"), program = gl.createProgram(), counted = 256 * 64;
      gl.getExtension("EXT_color_buffer_float");
      for (const [kind, source] of [[gl.VERTEX_SHADER, "#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1), 0.0, 1.0); }"],
        [gl.FRAGMENT_SHADER, "#version 300 es\nprecision highp float;\nout vec4 color;\n" + ours + "void main() { float i = gl_FragCoord.x - 0.5 + 256.0 * (gl_FragCoord.y - 0.5), x = (i - 8192.0) / 512.0 * (i < 4096.0 ? 1000.0 : 1.0); color = vec4(x, fathom_sin(x), fathom_cos(x), 1.0); }"]]) {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, source);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
        gl.attachShader(program, shader);
      }
      gl.linkProgram(program);
      gl.useProgram(program);
      gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
      gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, 256, 64);
      gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, gl.getParameter(gl.TEXTURE_BINDING_2D), 0);
      gl.viewport(0, 0, 256, 64);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      const v = new Float32Array(4 * counted);
      gl.readPixels(0, 0, 256, 64, gl.RGBA, gl.FLOAT, v);
      const wrong = [];
      for (let i = 0; i < v.length; i += 4) if (v[i + 3] !== 1 || [Math.sin, Math.cos].some((f, k) => !(Math.abs(v[i + 1 + k] - f(v[i])) <= 5e-7 + 1.2e-7 * Math.abs(v[i])))) wrong.push([...v.slice(i, i + 3)]);
      return wrong;
    }, ours);
    same(wrong.slice(0, 3), [], wrong.length + " of 16384 angles");
    await page.close();
  },
  async "on Shadertoy a click does not move the picture, and a drag does"() {
    write("toy.sdf", "param radius = 1 in 0.5..1.5 \"Radius\"\nbox(radius).paint(tomato)\nplane(Y, -1)\ncamera(at: [2, 5, 4], look_at: [0, 0, 0])\n");
    run("compile", "toy.sdf", "--target", "shadertoy", "-o", "toy.frag");
    const page = await browser.open(size), text = bytes(join(folder, "toy.frag")).toString();
    await page.run((text, width, height) => {
      const canvas = Object.assign(document.createElement("canvas"), {width, height}), gl = canvas.getContext("webgl2", {preserveDrawingBuffer: true}), program = gl.createProgram();
      const host = "#version 300 es\nprecision highp float;\nprecision highp int;\nuniform vec3 iResolution;\nuniform float iTime;\nuniform vec4 iMouse;\nuniform int iFrame;\nout vec4 color;\n" + text + "\nvoid main() { mainImage(color, gl_FragCoord.xy); }";
      const corner = "#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1), 0.0, 1.0); }";
      for (const [kind, source] of [[gl.VERTEX_SHADER, corner], [gl.FRAGMENT_SHADER, host]]) {
        const shader = gl.createShader(kind);
        gl.shaderSource(shader, source);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
        gl.attachShader(program, shader);
      }
      gl.linkProgram(program);
      gl.useProgram(program);
      gl.uniform3f(gl.getUniformLocation(program, "iResolution"), width, height, 1);
      window.drawn = (...mouse) => {
        gl.uniform4f(gl.getUniformLocation(program, "iMouse"), ...mouse);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        return canvas.toDataURL().split(",")[1];
      };
    }, text, size.width, size.height);
    const shown = async (...mouse) => Buffer.from(await page.run("drawn(" + mouse + ")"), "base64");
    const first = await shown(0, 0, 0, 0);
    await near(first, bytes(rendered("toy")), "shadertoy and fathom render");
    await near(await shown(250, 30, 250, 30), first, "a click");       // the button goes down
    await near(await shown(250, 30, -250, -30), first, "its release");
    await apart(await shown(250, 90, 250, -30), first, "a drag moves nothing");
    await page.close();
  },
  async "a page of a small scene is less than 50 KB"() {
    compiled("small", "sphere(1) | box([3, 0.2, 3]).translate(y: -1)\n");
    const small = statSync(join(folder, "small.html")).size;
    must(small < 50000, small + " bytes");
  },
};

const browser = await launch(), blank = await browser.open(size), site = await serve(folder);
async function fresh(path) {
  const page = await browser.open(size);
  await page.go(site.address + path);
  return page;
}
write("tiles.sdf", "box(1).paint(tomato)\n");
run("render", "tiles.sdf", "--size", "32x32", "--samples", "1", "-o", "tiles.png");
let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  if (wanted.length && !wanted.some(w => name.includes(w))) continue;
  const from = Date.now();
  try {
    await test();
    console.log("ok     " + name + " (" + ((Date.now() - from) / 1000).toFixed(1) + " s)");
  } catch (e) {
    ++failed;
    console.log("FAILED " + name + ": " + e.message + (e.stderr ? "\n" + e.stderr : ""));
  }
}
await browser.close();
site.close();
rmSync(folder, {recursive: true});
process.exit(failed ? 1 : 0);
