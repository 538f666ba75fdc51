const vertex = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1), 0.0, 1.0); }`;
const canvas = document.getElementById("canvas");
const word = document.getElementById("word");
const gl = canvas.getContext("webgl2", {antialias: false});
let program = null;

function build() {
  if (!gl) { word.textContent = "This page needs WebGL 2, which this browser does not offer."; return; }
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
      word.textContent = gl.getShaderInfoLog(shader);
  }
  gl.linkProgram(made);
  if (gl.getProgramParameter(made, gl.LINK_STATUS)) program = made;
  else word.textContent += gl.getProgramInfoLog(made);
}

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
let around = Math.atan2(view.back[0], view.back[2]);
let above = Math.asin(Math.max(-1, Math.min(1, view.back[1])));
let zoom = 1, dirty = true;

function set(name, type, v) {
  const at = gl.getUniformLocation(program, name);
  if (at === null) return;
  if (type === "int" || type === "bool") gl.uniform1i(at, v[0]);
  else gl["uniform" + v.length + "fv"](at, v);
}

function draw(now) {
  requestAnimationFrame(draw);
  const ratio = window.devicePixelRatio || 1;
  const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; dirty = true; }
  if (!program || !(dirty || animated) || !width || !height) return;
  dirty = false;
  const back = [Math.cos(above) * Math.sin(around), Math.sin(above), Math.cos(above) * Math.cos(around)];
  const forward = back.map(c => -c), right = [Math.cos(around), 0, -Math.sin(around)], up = cross(right, forward);
  const focus = view.focus * zoom;
  gl.viewport(0, 0, width, height);
  gl.useProgram(program);
  set("fathom_resolution", "vec2", [width, height]);
  set("fathom_offset", "vec2", [0.5, 0.5]);
  set("fathom_origin", "vec3", view.target.map((c, i) => c + focus * back[i]));
  set("fathom_right", "vec3", right);
  set("fathom_up", "vec3", up);
  set("fathom_forward", "vec3", forward);
  set("fathom_extent", "float", [view.orthographic ? view.extent * zoom : view.extent]);
  set("fathom_focus", "float", [focus]);
  set("fathom_orthographic", "int", [view.orthographic ? 1 : 0]);
  set("fathom_sun", "vec3", sun);
  set("fathom_mode", "int", [0]);
  set("fathom_time", "float", [now / 1000 % seconds]);
  for (const p of params) set(p.name, p.type, p.value);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
}

const encode = x => x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
const decode = x => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
for (const p of params) {
  const label = document.createElement("label");
  label.append(p.label + " ");
  const control = (type, place) => {
    const input = document.createElement("input");
    input.type = type;
    input.addEventListener("input", () => { place(input); dirty = true; });
    label.append(input);
    return input;
  };
  if (p.color) {
    const byte = x => Math.round(255 * Math.max(0, Math.min(1, encode(x)))).toString(16).padStart(2, "0");
    control("color", i => { p.value = [1, 3, 5].map(at => decode(parseInt(i.value.slice(at, at + 2), 16) / 255)); })
      .value = "#" + p.value.slice(0, 3).map(byte).join("");
  } else if (p.type === "bool") {
    control("checkbox", i => { p.value = [i.checked ? 1 : 0]; }).checked = p.value[0] !== 0;
  } else {
    p.value.forEach((value, k) => {
      const input = control(p.range ? "range" : "number", i => { p.value[k] = Number(i.value); });
      if (p.range) { input.min = p.lo[k]; input.max = p.hi[k]; }
      input.step = p.type === "int" ? 1 : "any";
      input.value = value;
    });
  }
  document.getElementById("controls").append(label);
}

const pointers = new Map();
canvas.addEventListener("pointerdown", e => { canvas.setPointerCapture(e.pointerId); pointers.set(e.pointerId, [e.clientX, e.clientY]); });
canvas.addEventListener("pointermove", e => {
  const old = pointers.get(e.pointerId);
  if (!old) return;
  around -= (e.clientX - old[0]) * 0.008 / pointers.size;
  above = Math.max(-1.57, Math.min(1.57, above + (e.clientY - old[1]) * 0.008 / pointers.size));
  pointers.set(e.pointerId, [e.clientX, e.clientY]);
  dirty = true;
});
for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, e => pointers.delete(e.pointerId));
canvas.addEventListener("wheel", e => { zoom *= Math.exp(e.deltaY * 0.001); dirty = true; e.preventDefault(); }, {passive: false});
canvas.addEventListener("keydown", e => {
  const turn = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]}[e.key];
  if (turn) { around += turn[0]; above = Math.max(-1.57, Math.min(1.57, above + turn[1])); }
  else if (e.key === "+") zoom *= 0.9;
  else if (e.key === "-") zoom /= 0.9;
  else return;
  dirty = true;
});
canvas.addEventListener("webglcontextlost", e => { e.preventDefault(); program = null; });
canvas.addEventListener("webglcontextrestored", () => { build(); dirty = true; });
build();
requestAnimationFrame(draw);
