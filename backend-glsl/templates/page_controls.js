
// What the user moves: the camera, the params, the time. The address says what differs from the first view.
const encode = x => x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
const decode = x => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
const panel = document.getElementById("controls"), refresh = [];
let embedded = true, taken = false, written = 0;
try { embedded = window.top !== window.self; } catch (e) { /* another origin's page holds this one */ }

const make = (kind, text, parent) => { const e = document.createElement(kind); e.textContent = text; parent.append(e); return e; };
const short = x => String(Number(x.toPrecision(4)));

function address() {
  clearTimeout(written);
  written = setTimeout(() => {
    const parts = [];
    if (Object.keys(home).some(k => camera[k] !== home[k])) parts.push("view=" + Object.keys(home).map(k => short(camera[k])).join(","));
    if (scene.animated && !clock.playing) parts.push("time=" + short(clock.time));
    params.forEach((p, i) => { if (p.value.some((v, k) => v !== first[i][k])) parts.push(encodeURIComponent(p.name) + "=" + p.value.map(short).join(",")); });
    history.replaceState(null, "", "#" + parts.join("&"));
  }, 300);
}

// Numbers that do not fit are left as they are.
function read_address() {
  for (const [key, text] of new URLSearchParams(location.hash.slice(1))) {
    const numbers = text.split(",").map(Number);
    if (!numbers.every(Number.isFinite)) continue;
    const p = params.find(q => q.name === key), names = Object.keys(home);
    if (key === "view" && numbers.length === names.length && numbers[2] > 0) names.forEach((k, i) => { camera[k] = numbers[i]; });
    else if (key === "time" && numbers[0] >= 0 && numbers[0] < scene.seconds) { clock.time = numbers[0]; clock.playing = false; }
    else if (key === "samples" && numbers[0] >= 1) most = Math.min(256, Math.floor(numbers[0]));
    else if (p && numbers.length === p.value.length) p.value = numbers.map((v, k) => p.range ? Math.max(p.lo[k], Math.min(p.hi[k], v)) : v);
  }
  refresh.forEach(f => f());
  changed();
}

const moved = () => { changed(); address(); };

function control(label, type, place) {
  const input = document.createElement("input");
  input.type = type;
  input.addEventListener("input", () => { if (place(input) !== false) moved(); });
  label.append(input);
  return input;
}

params.forEach((p, i) => {
  const label = document.createElement("label");
  make("span", p.label, label);
  const value = make("output", "", label);
  let update;
  if (p.color) {
    const byte = x => Math.round(255 * Math.max(0, Math.min(1, encode(x)))).toString(16).padStart(2, "0");
    const input = control(label, "color", e => { p.value = [1, 3, 5].map(at => decode(parseInt(e.value.slice(at, at + 2), 16) / 255)).concat(p.value.slice(3)); });
    update = () => { input.value = "#" + p.value.slice(0, 3).map(byte).join(""); };
  } else if (p.type === "bool") {
    const input = control(label, "checkbox", e => { p.value = [e.checked ? 1 : 0]; });
    update = () => { input.checked = p.value[0] !== 0; };
  } else {
    const say_value = () => { value.textContent = p.value.map(short).join(", ") + (p.range ? " of " + p.lo.map(short).join(", ") + " to " + p.hi.map(short).join(", ") : ""); };
    const inputs = p.value.map((v, k) => {
      const input = control(label, p.range ? "range" : "number", e => {
        if (e.value === "" || !Number.isFinite(Number(e.value))) return false;
        p.value[k] = Number(e.value);
        say_value();
      });
      input.setAttribute("aria-label", p.label + (p.value.length > 1 ? " " + "xyzw"[k] : ""));
      if (p.range) { input.min = p.lo[k]; input.max = p.hi[k]; }
      input.step = p.type === "int" ? 1 : "any";
      return input;
    });
    update = () => { inputs.forEach((input, k) => { input.value = p.value[k]; }); say_value(); };
  }
  refresh.push(update);
  panel.append(label);
});
for (const f of scene.fixed) make("p", f.label + " = " + f.value + " (fixed in this page: it decides what there is)", panel);

let tick = () => {};
if (scene.animated) {
  const label = document.createElement("label"), end = Math.min(scene.seconds, 60);
  make("span", "Time", label);
  const value = make("output", "", label), scrub = control(label, "range", e => { clock.time = Number(e.value); clock.playing = false; refresh.forEach(f => f()); });
  Object.assign(scrub, {min: 0, max: end, step: "any"});
  scrub.setAttribute("aria-label", "Time, seconds");
  panel.append(label);
  const play = make("button", "Pause", panel), rate = document.createElement("label");
  play.addEventListener("click", () => { clock.playing = !clock.playing; refresh.forEach(f => f()); address(); });
  make("span", "Speed", rate);
  const speed = control(rate, "number", e => { const s = Number(e.value); if (!(s >= 0 && s <= 100)) return false; clock.speed = s; });
  Object.assign(speed, {min: 0, max: 100, step: 0.1, value: 1});
  panel.append(rate);
  tick = () => { if (document.activeElement !== scrub) scrub.value = clock.time % end; value.textContent = clock.time.toFixed(1) + " s"; };
  refresh.push(() => { scrub.value = clock.time; play.textContent = clock.playing ? "Pause" : "Play"; tick(); });
}

const button = (text, act) => make("button", text, panel).addEventListener("click", act);
button("First view", () => { Object.assign(camera, home); params.forEach((p, i) => { p.value = first[i].slice(); }); refresh.forEach(f => f()); moved(); });
button("Save picture", () => {
  if (!made) return;
  show();
  canvas.toBlob(blob => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = scene.title + ".png";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
});
if (document.fullscreenEnabled) button("Full screen", () => document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen());

// A page that holds this one scrolls past it until it is clicked.
const take = on => { taken = on; canvas.classList.toggle("taken", on || !embedded); };
take(false);
canvas.addEventListener("blur", () => take(false));

function turn(x, y) {
  camera.around -= x;
  camera.above = Math.max(-1.57, Math.min(1.57, camera.above + y));
}
function pan(x, y) { // in pixels of the page
  const v = view_now(), size = 2 * v.extent * (scene.view.orthographic ? 1 : v.focus) / canvas.clientHeight;
  ["x", "y", "z"].forEach((k, i) => { camera[k] += size * (y * v.up[i] - x * v.right[i]); });
}
const come = factor => { camera.zoom = Math.max(0.01, Math.min(100, camera.zoom * factor)); };

const pointers = new Map();
canvas.addEventListener("pointerdown", e => { canvas.focus(); take(true); canvas.setPointerCapture(e.pointerId); pointers.set(e.pointerId, [e.clientX, e.clientY]); });
canvas.addEventListener("pointermove", e => {
  const old = pointers.get(e.pointerId);
  if (!old) return;
  const x = e.clientX - old[0], y = e.clientY - old[1];
  const other = [...pointers].filter(([id]) => id !== e.pointerId).map(([, at]) => at)[0];
  if (other) {
    come(Math.hypot(old[0] - other[0], old[1] - other[1]) / Math.max(Math.hypot(e.clientX - other[0], e.clientY - other[1]), 1));
    pan(x / 2, y / 2);
  } else if (e.shiftKey || e.buttons & 6) pan(x, y);
  else turn(0.008 * x, 0.008 * y);
  pointers.set(e.pointerId, [e.clientX, e.clientY]);
  moved();
});
for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, e => pointers.delete(e.pointerId));
canvas.addEventListener("contextmenu", e => e.preventDefault());
canvas.addEventListener("wheel", e => {
  if (embedded && !taken) return;
  come(Math.exp(0.001 * e.deltaY));
  moved();
  e.preventDefault();
}, {passive: false});
canvas.addEventListener("keydown", e => {
  const act = {ArrowLeft: () => turn(0.1, 0), ArrowRight: () => turn(-0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
    "+": () => come(0.9), "-": () => come(1 / 0.9), " ": () => { clock.playing = scene.animated && !clock.playing; refresh.forEach(f => f()); }}[e.key];
  if (!act) return;
  act();
  moved();
  e.preventDefault();
});
window.addEventListener("hashchange", read_address);
if (innerWidth > 600) document.getElementById("panel").open = true;
read_address();
build();
