
// Drawing: a coarse picture at once, then the whole one tile by tile and sample by sample. A tile is drawn
// by passes, each of so few steps and pixels that it is short; a fence says when it is done.
const scene = JSON.parse(document.getElementById("scene").textContent);
const canvas = document.getElementById("canvas");
const word = document.getElementById("word");
const gl = canvas.getContext("webgl2", {antialias: false, alpha: false});
const params = scene.params, first = params.map(p => p.value.slice());
const home = {around: Math.atan2(scene.view.back[0], scene.view.back[2]),
  above: Math.asin(Math.max(-1, Math.min(1, scene.view.back[1]))), zoom: 1, x: scene.view.target[0], y: scene.view.target[1], z: scene.view.target[2]};
const camera = Object.assign({}, home);
const clock = {time: scene.start, speed: 1, playing: scene.animated};
const side = 512, unit = 25; // of a tile, pixels; what a draw should take, milliseconds
let most = 8;                // samples of a pixel
let made = null;             // programs and textures; null where there is no context
let cost = 0;                // milliseconds a pixel and draw; 0: not known yet
let job = null, lost = 0, samples = 0;

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const say = text => { if (word.textContent !== text) word.textContent = text; };

function begin_program(fragment) {
  const program = gl.createProgram(), all = [[gl.VERTEX_SHADER, shaders.corner], [gl.FRAGMENT_SHADER, fragment]].map(([kind, text]) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    return shader;
  });
  gl.linkProgram(program);
  return {program, all, at: {}};
}

// Empty, or what the driver says against it.
const wrong = p => gl.getProgramParameter(p.program, gl.LINK_STATUS) || gl.isContextLost() ? ""
  : p.all.map(s => gl.getShaderInfoLog(s)).join("") + gl.getProgramInfoLog(p.program) || "The driver refuses the shader.";

function set(p, name, v, whole) {
  if (!(name in p.at)) p.at[name] = gl.getUniformLocation(p.program, name);
  if (p.at[name] === null) return;
  if (whole) gl.uniform1i(p.at[name], v[0]);
  else gl["uniform" + v.length + "fv"](p.at[name], v);
}

function bind(p, name, place, texture, kind) {
  gl.activeTexture(gl.TEXTURE0 + place);
  gl.bindTexture(kind || gl.TEXTURE_2D, texture);
  set(p, name, [place], true);
}

function texture(width, height, kind) {
  const name = gl.createTexture(), target = kind || gl.TEXTURE_2D;
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(target, name);
  for (const how of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(target, how, gl.NEAREST);
  for (const how of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(target, how, gl.CLAMP_TO_EDGE);
  if (width) gl.texStorage2D(target, 1, gl.RGBA32F, width, height);
  return name;
}

function frame(textures) {
  const name = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, name);
  textures.forEach((t, i) => gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, t, 0));
  gl.drawBuffers(textures.map((t, i) => gl.COLOR_ATTACHMENT0 + i));
  return name;
}

async function unpack(sampler) {
  const bytes = Uint8Array.from(atob(sampler.data), c => c.charCodeAt(0));
  const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const buffer = await new Response(plain).arrayBuffer();
  if (!sampler.bytes) return new Float32Array(buffer);
  const table = Float32Array.from({length: 256}, (_, i) => decode(i / 255));
  return Float32Array.from(new Uint8Array(buffer), (b, i) => i % 4 === 3 ? b / 255 : table[b]);
}

function load(sampler) {
  const flat = sampler.size.length === 2, name = texture(0, 0, flat ? gl.TEXTURE_2D : gl.TEXTURE_3D);
  const [w, h, d] = sampler.size;
  if (flat) gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, w, h, 0, gl.RGBA, gl.FLOAT, sampler.values);
  else gl.texImage3D(gl.TEXTURE_3D, 0, gl.R32F, w, h, d, 0, gl.RED, gl.FLOAT, sampler.values);
  return name;
}

// When what was sent to the card is done.
function done() {
  const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  return new Promise(resolve => {
    const ask = () => {
      if (gl.isContextLost() || gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED) resolve();
      else setTimeout(ask, 1);
    };
    setTimeout(ask, 0);
  });
}

async function build() {
  if (!gl) return say("This page needs WebGL 2, which this browser does not offer.");
  if (!gl.getExtension("EXT_color_buffer_float"))
    return say("This page needs textures of floats to draw into, which this browser's WebGL 2 does not offer.");
  say("Compiling the scene…");
  const parallel = gl.getExtension("KHR_parallel_shader_compile");
  const field = begin_program(scene.fragment), left = begin_program(shaders.left), mean = begin_program(shaders.mean), show = begin_program(shaders.show);
  for (const s of scene.samplers) s.values = s.values || await unpack(s);
  while (parallel && !gl.isContextLost() && !gl.getProgramParameter(field.program, parallel.COMPLETION_STATUS_KHR)) await new Promise(r => setTimeout(r, 10));
  for (const p of [field, left, mean, show]) if (wrong(p)) return say(wrong(p));
  if (gl.isContextLost()) return;
  const sets = [0, 1].map(() => [0, 1, 2, 3].map(() => texture(side, side)));
  const kit = {field, left, mean, show, sets, frames: sets.map(frame), single: sets.map(s => frame([s[0]])), samplers: scene.samplers.map(load),
    query: gl.createQuery(), coarse: texture(side, side)};
  kit.coarse_frame = frame([kit.coarse]);
  if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE && !gl.isContextLost())
    return say("This browser's WebGL 2 cannot draw into textures of floats, which this page needs.");
  gl.bindVertexArray(gl.createVertexArray());
  made = kit;
  say("Preparing the first picture…");
  tile({width: 2, height: 2, x: 0, y: 0, w: 2, h: 2}, 0, false, view_now());
  await done();
  if (made === kit) { say(""); run(kit); }
}

function resize() {
  const ratio = window.devicePixelRatio || 1;
  const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  if (made.width === width && made.height === height) return;
  Object.assign(made, {width, height});
  canvas.width = width;
  canvas.height = height;
  for (const old of [made.picture]) if (old) gl.deleteTexture(old);
  if (made.picture_frame) gl.deleteFramebuffer(made.picture_frame);
  made.picture = texture(width, height);
  made.picture_frame = frame([made.picture]);
  changed();
}

function view_now() {
  const c = camera, back = [Math.cos(c.above) * Math.sin(c.around), Math.sin(c.above), Math.cos(c.above) * Math.cos(c.around)];
  const forward = back.map(v => -v), right = [Math.cos(c.around), 0, -Math.sin(c.around)];
  const tall = Math.max(1, canvas.clientHeight / Math.max(canvas.clientWidth, 1)); // what is framed stays in sight
  const focus = scene.view.focus * c.zoom * tall;
  return {forward, right, up: cross(right, forward), focus, origin: [c.x, c.y, c.z].map((t, i) => t + focus * back[i]),
    extent: scene.view.orthographic ? scene.view.extent * c.zoom * tall : scene.view.extent, time: clock.time, values: params.map(p => p.value.slice())};
}

// Draws a tile of a picture of that size into one of the two sets, by what the other one kept.
function tile(t, into, resumed, v, budget, offset) {
  const p = made.field;
  gl.bindFramebuffer(gl.FRAMEBUFFER, made.frames[into]);
  gl.viewport(0, 0, t.w, t.h);
  gl.useProgram(p.program);
  set(p, "fathom_resolution", [t.width, t.height]);
  set(p, "fathom_tile", [t.x, t.y]);
  set(p, "fathom_offset", offset || [0.5, 0.5]);
  for (const name of ["origin", "right", "up", "forward"]) set(p, "fathom_" + name, v[name]);
  for (const name of ["extent", "focus", "time"]) set(p, "fathom_" + name, [v[name]]);
  set(p, "fathom_sun", scene.sun);
  set(p, "fathom_orthographic", [scene.view.orthographic ? 1 : 0], true);
  set(p, "fathom_mode", [3], true);
  set(p, "fathom_turns", [scene.steps], true);
  set(p, "fathom_budget", [budget || scene.budget], true);
  set(p, "fathom_resumed", [resumed ? 1 : 0], true);
  params.forEach((q, i) => set(p, q.name, v.values[i], q.type === "int" || q.type === "bool"));
  [2, 0, 1, 3].forEach((kept, place) => bind(p, "fathom_kept_" + kept, place, made.sets[1 - into][place]));
  scene.samplers.forEach((s, i) => bind(p, s.name, 4 + i, made.samplers[i], s.size.length === 2 ? gl.TEXTURE_2D : gl.TEXTURE_3D));
  gl.drawArrays(gl.TRIANGLES, 0, 3);
}

function copy(from, to, t) {
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from);
  gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to);
  gl.blitFramebuffer(0, 0, t.w, t.h, t.x, t.y, t.x + t.w, t.y + t.h, gl.COLOR_BUFFER_BIT, gl.NEAREST);
}

function show() {
  const p = made.show;
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.viewport(0, 0, made.width, made.height);
  gl.useProgram(p.program);
  bind(p, "picture", 0, made.picture);
  bind(p, "coarse", 1, made.coarse);
  set(p, "size", [made.width, made.height]);
  set(p, "rough", made.rough || [1, 1]);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
}

// What is drawn is of another view, time or param.
function changed() { job = null; samples = 0; canvas.dataset.samples = 0; }

function* tiles(width, height) {
  for (let y = 0; y < height;) {
    const w = Math.min(side, width), h = Math.max(1, Math.min(side, height - y, Math.floor(cost ? unit / cost / w : 8)));
    for (let x = 0; x < width; x += w) yield {width, height, x, y, w: Math.min(w, width - x), h};
    y += h;
  }
}

// A picture of few pixels, whose rays may take as many steps as one draw gives: true when it is shown.
async function rough_picture(kit, wanted, v) {
  const scale = Math.min(1, side / made.width, side / made.height, Math.sqrt(wanted / (made.width * made.height)));
  const width = Math.max(1, Math.round(made.width * scale)), height = Math.max(1, Math.round(made.height * scale));
  const whole = made.picture_frame;
  for (const t of tiles(width, height)) {
    const from = performance.now();
    tile(t, 0, false, v, scene.steps);
    copy(made.single[0], made.coarse_frame, t);
    await done();
    if (made !== kit || made.picture_frame !== whole) return;
    learn(performance.now() - from, t);
  }
  made.rough = [width, height];
  gl.bindFramebuffer(gl.FRAMEBUFFER, whole);
  gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
  show();
}

const learn = (spent, t) => { const now = spent / Math.max(t.w * t.h, 256); cost = cost ? Math.max(0.7 * cost + 0.3 * now, 1e-7) : now; };

// One more sample of the whole picture; false where it is of no use any more.
async function sample(kit, mine, number, v) {
  const turn = x => x - Math.floor(x), offset = [turn(0.5 + 0.75487766624669276 * number), turn(0.5 + 0.56984029099805327 * number)];
  let shown = performance.now();
  for (const t of tiles(made.width, made.height)) {
    let into = 0;
    for (let pass = 0;; ++pass, into = 1 - into) {
      const from = performance.now();
      tile(t, into, pass > 0, v, 0, offset);
      gl.bindFramebuffer(gl.FRAMEBUFFER, made.single[1 - into]);
      gl.useProgram(made.left.program);
      bind(made.left, "tile", 0, made.sets[into][0]);
      gl.colorMask(false, false, false, false);
      gl.beginQuery(gl.ANY_SAMPLES_PASSED, made.query);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      gl.endQuery(gl.ANY_SAMPLES_PASSED);
      gl.colorMask(true, true, true, true);
      await done();
      if (made !== kit) return false;
      if (pass === 0) learn(performance.now() - from, t);
      while (!gl.getQueryParameter(made.query, gl.QUERY_RESULT_AVAILABLE)) {
        await new Promise(r => setTimeout(r, 1));
        if (made !== kit) return false;
      }
      resize();
      if (job !== mine) return false;
      if (!gl.getQueryParameter(made.query, gl.QUERY_RESULT)) break;
    }
    const p = made.mean;
    gl.bindFramebuffer(gl.FRAMEBUFFER, made.single[1 - into]);
    gl.useProgram(p.program);
    bind(p, "tile", 0, made.sets[into][0]);
    bind(p, "picture", 1, made.picture);
    set(p, "corner", [t.x, t.y]);
    set(p, "share", [1 / (number + 1)]);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    copy(made.single[1 - into], made.picture_frame, t);
    if (performance.now() - shown > 150) { show(); shown = performance.now(); }
  }
  show();
  return true;
}

async function run(kit) {
  let last = performance.now();
  while (made === kit) {
    resize();
    const now = performance.now();
    if (clock.playing) {
      clock.time = (clock.time + clock.speed * (now - last) / 1000) % scene.seconds;
      tick();
      changed();
    }
    last = now;
    if (job === null) {
      job = {};
      const mine = job, v = view_now(), pixels = made.width * made.height;
      const affordable = cost ? Math.max(40 / cost, 400) : 400;
      await rough_picture(kit, affordable, v);
      for (let more = 8 * affordable; made === kit && job === mine && !clock.playing && more < pixels / 2; more *= 8) await rough_picture(kit, more, v);
    } else if (samples < most) {
      const mine = job;
      if (await sample(kit, mine, samples, view_now()) && job === mine) canvas.dataset.samples = ++samples;
    }
    await new Promise(r => document.hidden ? setTimeout(r, 200) : requestAnimationFrame(r));
  }
}

canvas.addEventListener("webglcontextlost", e => {
  e.preventDefault();
  made = null;
  cost = 0;
  say(++lost < 4 ? "The graphics driver stopped this page. It begins again by itself." :
    "The graphics driver stops this page each time it draws. Reload it to try again.");
});
canvas.addEventListener("webglcontextrestored", () => { if (lost < 4) { changed(); build(); } });
