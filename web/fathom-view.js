// <fathom-view>: a compiled scene in any page, by WebGL 2. One file, no dependencies. Its types are in
// fathom-view.d.ts; docs/web.md says how it is used. The page of `fathom compile --target html` holds it.

// ---- numbers ----

// Names that a scene gives are keys: of such objects `__proto__` and `toString` are keys like others.
const bare = pairs => Object.assign(Object.create(null), Object.fromEntries(pairs));

const encode = x => x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
const decode = x => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const clamp = (x, low, high) => Math.max(low, Math.min(high, x));
const short = x => String(Number(x.toPrecision(4)));
const tell = (view, kind, detail) => view.dispatchEvent(new CustomEvent(kind, {detail}));
const wait = (ms = 0) => new Promise(r => setTimeout(r, ms));

// ---- scenes ----

// A scene from the page that `--target html` wrote; or, with `shader`, from a reflection and its es300 text.
export async function loadScene(address, shader) {
  const get = async url => {
    const answer = await fetch(url);
    if (!answer.ok) throw new Error(url + ": " + answer.status + " " + answer.statusText);
    return answer.text();
  };
  const text = await get(address);
  if (shader) return {title: shader.split("/").pop().replace(/\..*/, ""), variants: [{reflection: JSON.parse(text), text: await get(shader)}]};
  const data = new DOMParser().parseFromString(text, "text/html").getElementById("fathom-scene");
  if (!data) throw new Error(address + " is no page of fathom compile --target html");
  return JSON.parse(data.textContent);
}

async function unpack(text) {
  if (typeof DecompressionStream !== "function") throw new Error("This browser has no DecompressionStream, which the scene needs.");
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

const textOf = async variant => variant.packed === undefined ? variant.text : new TextDecoder().decode(await unpack(variant.packed));

// The numbers of a texture: linear floats.
async function numbersOf(scene, variant, u) {
  const t = (variant.textures || []).find(t => t.name === u.name);
  if (!t) throw new Error("The scene needs the texture " + u.name + ", which was not given.");
  if (t.values) return t.values;
  const buffer = await unpack(scene.data[t.data]);
  if (!t.bytes) return new Float32Array(buffer);
  const table = Float32Array.from({length: 256}, (_, i) => decode(i / 255));
  return Float32Array.from(new Uint8Array(buffer), (b, i) => i % 4 === 3 ? b / 255 : table[b]);
}

// The params of all variants. `values`: of one that decides what there is, the values that have a variant.
function inputsOf(scene) {
  const found = new Map();
  for (const {reflection, values = {}} of scene.variants)
    for (const u of [...reflection.uniforms, ...reflection.constants]) {
      if (u.param === undefined) continue;
      const value = u.value || u.default;
      if (!found.has(u.param)) found.set(u.param, {name: u.param, uniform: u.name, label: u.label || u.param, type: u.type,
        color: u.color, unit: u.unit || "", range: u.range, first: value, values: u.value && [value]});
      const p = found.get(u.param);
      if (p.values && Object.hasOwn(values, u.param) && !p.values.some(v => v.every((x, i) => x === value[i]))) p.values.push(value);
    }
  for (const p of found.values()) if (p.values) p.values.sort((a, b) => a[0] - b[0]);
  return [...found.values()];
}

const variantFor = (scene, params) => scene.variants.find(v => Object.entries(v.values || {}).every(([name, value]) => value.every((x, i) => x === params[name][i])));

// ---- the camera ----

const defaultsOf = reflection => Object.fromEntries(reflection.uniforms.filter(u => u.default).map(u => [u.name, u.default]));

// The first view's camera: it stands at the angles `around` and `above` its target x, y, z (radians), `zoom` times
// as far off as the scene says.
export function firstCamera(reflection) {
  const d = defaultsOf(reflection), back = d.fathom_forward.map(v => -v);
  const [x, y, z] = d.fathom_origin.map((c, i) => c - d.fathom_focus[0] * back[i]);
  return {around: Math.atan2(back[0], back[2]), above: Math.asin(clamp(back[1], -1, 1)), zoom: 1, x, y, z};
}

// The uniforms of a camera, by name. `aspect`: the picture's width over its height; where it is taller than wide
// the camera stands farther off, so that what is framed stays in sight.
export function cameraUniforms(reflection, camera, aspect) {
  const d = defaultsOf(reflection), {around, above} = camera, scale = camera.zoom * Math.max(1, 1 / aspect);
  const back = [Math.cos(above) * Math.sin(around), Math.sin(above), Math.cos(above) * Math.cos(around)];
  const forward = back.map(v => -v), right = [Math.cos(around), 0, -Math.sin(around)], focus = d.fathom_focus[0] * scale;
  return {fathom_origin: [camera.x, camera.y, camera.z].map((t, i) => t + focus * back[i]), fathom_right: right,
    fathom_up: cross(right, forward), fathom_forward: forward, fathom_focus: [focus],
    fathom_extent: [d.fathom_extent[0] * (d.fathom_orthographic[0] ? scale : 1)]};
}

// Where a side is seen from; its keys are the viewer's.
const sides = {front: {key: "1", at: {around: 0, above: 0}}, right: {key: "3", at: {around: Math.PI / 2, above: 0}}, top: {key: "7", at: {around: 0, above: 1.57}}};

// ---- shaders of our own ----

// A tile's pixels have an alpha of 2 where a ray goes on in the next draw; the picture's have 0 where nothing is drawn yet.
const head = "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n";
const shaders = {
  corner: "#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1), 0.0, 1.0); }",
  left: head + `uniform sampler2D tile;
out vec4 color;
void main() {
  if (texelFetch(tile, ivec2(gl_FragCoord.xy), 0).a < 1.5) discard;
  color = vec4(1.0);
}`,
  mean: head + `uniform sampler2D tile, picture;
uniform vec2 corner;
uniform float share;
out vec4 color;
void main() {
  vec3 now = texelFetch(tile, ivec2(gl_FragCoord.xy), 0).rgb;
  vec3 before = texelFetch(picture, ivec2(gl_FragCoord.xy + corner), 0).rgb;
  color = vec4(before + (now - before) * share, 1.0);
}`,
  show: head + `uniform sampler2D picture, coarse;
uniform vec2 size, rough; // of the canvas, and of what is drawn of the coarse picture
out vec4 color;
vec3 at(ivec2 place) { return texelFetch(coarse, clamp(place, ivec2(0), ivec2(rough) - 1), 0).rgb; }
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 fine = texelFetch(picture, pixel, 0);
  vec3 c = fine.rgb;
  if (fine.a < 0.5) {
    vec2 place = gl_FragCoord.xy * rough / size - 0.5;
    ivec2 low = ivec2(floor(place));
    vec2 t = fract(place);
    c = mix(mix(at(low), at(low + ivec2(1, 0)), t.x), mix(at(low + ivec2(0, 1)), at(low + 1), t.x), t.y);
  }
  c = clamp(c, 0.0, 1.0);
  ivec2 cell = ivec2(pixel.x, int(size.y) - 1 - pixel.y);
  int order = 0;
  for (int bit = 0; bit < 3; ++bit) order = order * 4 + (((cell.x ^ cell.y) >> bit & 1) * 2 + (cell.y >> bit & 1));
  float dither = (0.02 + 0.96 / 63.0 * float(order) - 0.5) / 255.0;
  color = vec4(mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308))) + dither, 1.0);
}`
};

// ---- drawing ----

// Draws a scene into a canvas until it is stopped: a coarse picture at once, then the whole one tile by tile and sample
// by sample. A tile is drawn by passes, each of so few steps and pixels that it is short; a fence says when it is done.
// `state`: {camera, params (arrays by name), time, speed, playing, samples, drawn}; it may change at any time, and
// `changed()` says so. `say(text, failed)` is told what goes on, `happened(event)` of draw and rest, `tick()` of the time.
function drawing(canvas, scene, state, {say, happened, tick}) {
  const gl = canvas.getContext("webgl2", {antialias: false, alpha: false});
  const side = 512, unit = 25; // of a tile, pixels; what a draw should take, milliseconds
  let made = null;             // programs and textures; null where there are none
  let building = null;         // who builds them
  let cost = 0;                // milliseconds a pixel and draw; 0: not known yet
  let job = null, lost = 0, seen = true, shownVariant = null, stopped = false;

  function beginProgram(fragment) {
    const program = gl.createProgram(), all = [[gl.VERTEX_SHADER, shaders.corner], [gl.FRAGMENT_SHADER, fragment]].map(([kind, text]) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    });
    gl.linkProgram(program);
    return {program, all, at: bare([])};
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

  function bind(p, name, place, texture, kind = gl.TEXTURE_2D) {
    gl.activeTexture(gl.TEXTURE0 + place);
    gl.bindTexture(kind, texture);
    set(p, name, [place], true);
  }

  function texture(width, height, kind = gl.TEXTURE_2D) {
    const name = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(kind, name);
    for (const how of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(kind, how, gl.NEAREST);
    for (const how of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(kind, how, gl.CLAMP_TO_EDGE);
    if (width) gl.texStorage2D(kind, 1, gl.RGBA32F, width, height);
    return name;
  }

  function frame(textures) {
    const name = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, name);
    textures.forEach((t, i) => gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, t, 0));
    gl.drawBuffers(textures.map((t, i) => gl.COLOR_ATTACHMENT0 + i));
    return name;
  }

  function load({name, size: [w, h, d], format}, values) {
    const kind = format === "R32F" ? gl.TEXTURE_3D : gl.TEXTURE_2D, at = texture(0, 0, kind);
    if (kind === gl.TEXTURE_2D) gl.texImage2D(kind, 0, gl.RGBA32F, w, h, 0, gl.RGBA, gl.FLOAT, values);
    else gl.texImage3D(kind, 0, gl.R32F, w, h, d, 0, gl.RED, gl.FLOAT, values);
    return {name, kind, at};
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

  function drop(kit) {
    for (const t of [...kit.sets.flat(), kit.coarse, kit.picture, ...kit.textures.map(t => t.at)]) gl.deleteTexture(t);
    for (const f of [...kit.frames, ...kit.single, kit.coarseFrame, kit.pictureFrame]) gl.deleteFramebuffer(f);
    for (const p of [kit.field, kit.left, kit.mean, kit.show]) gl.deleteProgram(p.program);
  }

  // Makes the programs and textures of the variant that the params ask for, then draws by them.
  async function build() {
    const variant = variantFor(scene, state.params), mine = building = {};
    if (made) drop(made);
    made = null;
    cost = 0;
    shownVariant = variant;
    changed();
    if (!variant) return say("The scene does not compile for these values.", true);
    say("Compiling the scene…");
    const {reflection} = variant, inputs = reflection.uniforms.filter(u => u.size);
    const text = await textOf(variant), numbers = [];
    for (const u of inputs) numbers.push(await numbersOf(scene, variant, u));
    if (building !== mine || gl.isContextLost()) return;
    const parallel = gl.getExtension("KHR_parallel_shader_compile");
    const programs = [text, shaders.left, shaders.mean, shaders.show].map(beginProgram), [field, left, mean, show] = programs;
    while (parallel && !gl.isContextLost() && !gl.getProgramParameter(field.program, parallel.COMPLETION_STATUS_KHR)) await wait(10);
    if (building !== mine || gl.isContextLost()) return;
    const why = programs.map(wrong).find(w => w);
    if (why) return say(why, true);
    const sets = [0, 1].map(() => [0, 1, 2, 3].map(() => texture(side, side)));
    const kit = {variant, reflection, field, left, mean, show, sets, frames: sets.map(frame), single: sets.map(s => frame([s[0]])),
      textures: inputs.map((u, i) => load(u, numbers[i])), query: gl.createQuery(), coarse: texture(side, side),
      fixed: reflection.uniforms.filter(u => u.default && u.param === undefined), params: reflection.uniforms.filter(u => u.param !== undefined)};
    kit.coarseFrame = frame([kit.coarse]);
    if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE && !gl.isContextLost())
      return say("This browser's WebGL 2 cannot draw into textures of floats, which the scene needs.", true);
    gl.bindVertexArray(gl.createVertexArray());
    made = kit;
    say("Preparing the first picture…");
    tile({width: 2, height: 2, x: 0, y: 0, w: 2, h: 2}, 0, false, viewNow());
    await done();
    if (made === kit) {
      say("");
      await run(kit);
    }
  }

  const start = () => build().catch(e => say(e.message, true));

  function resize() {
    const ratio = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (made.width === width && made.height === height) return;
    Object.assign(made, {width, height});
    canvas.width = width;
    canvas.height = height;
    gl.deleteTexture(made.picture || null);
    gl.deleteFramebuffer(made.pictureFrame || null);
    made.picture = texture(width, height);
    made.pictureFrame = frame([made.picture]);
    changed();
  }

  // All uniforms of one picture.
  function viewNow() {
    const v = bare(made.fixed.map(u => [u.name, u.default]));
    Object.assign(v, cameraUniforms(made.reflection, state.camera, canvas.clientWidth / Math.max(canvas.clientHeight, 1)),
      {fathom_time: [state.time], fathom_mode: [3]});
    for (const u of made.params) v[u.name] = state.params[u.param].slice();
    return v;
  }

  // Draws a tile of a picture of that size into one of the two sets, by what the other one kept.
  function tile(t, into, resumed, v, budget, offset = [0.5, 0.5]) {
    const p = made.field, passes = made.variant.passes;
    gl.bindFramebuffer(gl.FRAMEBUFFER, passes ? made.frames[into] : made.single[into]);
    gl.viewport(0, 0, t.w, t.h);
    gl.useProgram(p.program);
    for (const u of [...made.fixed, ...made.params]) set(p, u.name, v[u.name], u.type === "int" || u.type === "bool");
    set(p, "fathom_resolution", [t.width, t.height]);
    set(p, "fathom_offset", [offset[0] + t.x, offset[1] - t.y]);
    if (passes) {
      set(p, "fathom_turns", [passes.steps], true);
      set(p, "fathom_budget", [budget || passes.budget], true);
      set(p, "fathom_resumed", [resumed ? 1 : 0], true);
      [2, 0, 1, 3].forEach((kept, place) => bind(p, "fathom_kept_" + kept, place, made.sets[1 - into][place]));
    }
    made.textures.forEach((s, i) => bind(p, s.name, 4 + i, s.at, s.kind));
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
  function changed() {
    job = null;
    state.drawn = 0;
    if (!gl.isContextLost() && variantFor(scene, state.params) !== shownVariant) start();
  }

  function* tiles(width, height) {
    for (let y = 0; y < height;) {
      const w = Math.min(side, width), h = Math.max(1, Math.min(side, height - y, Math.floor(cost ? unit / cost / w : 8)));
      for (let x = 0; x < width; x += w) yield {width, height, x, y, w: Math.min(w, width - x), h};
      y += h;
    }
  }

  const learn = (spent, t) => { const now = spent / Math.max(t.w * t.h, 256); cost = cost ? Math.max(0.7 * cost + 0.3 * now, 1e-7) : now; };

  // A picture of few pixels, whose rays may take as many steps as one draw gives.
  async function roughPicture(kit, wanted, v) {
    const scale = Math.min(1, side / made.width, side / made.height, Math.sqrt(wanted / (made.width * made.height)));
    const width = Math.max(1, Math.round(made.width * scale)), height = Math.max(1, Math.round(made.height * scale));
    const whole = made.pictureFrame;
    for (const t of tiles(width, height)) {
      const from = performance.now();
      tile(t, 0, false, v, made.variant.passes && made.variant.passes.steps);
      copy(made.single[0], made.coarseFrame, t);
      await done();
      if (made !== kit || made.pictureFrame !== whole) return;
      learn(performance.now() - from, t);
    }
    made.rough = [width, height];
    gl.bindFramebuffer(gl.FRAMEBUFFER, whole);
    gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    show();
  }

  // Whether a tile's rays go on.
  async function goesOn(kit, into) {
    gl.bindFramebuffer(gl.FRAMEBUFFER, made.single[1 - into]);
    gl.useProgram(made.left.program);
    bind(made.left, "tile", 0, made.sets[into][0]);
    gl.colorMask(false, false, false, false);
    gl.beginQuery(gl.ANY_SAMPLES_PASSED, made.query);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.endQuery(gl.ANY_SAMPLES_PASSED);
    gl.colorMask(true, true, true, true);
    await done();
    while (made === kit && !gl.getQueryParameter(made.query, gl.QUERY_RESULT_AVAILABLE)) await wait(1);
    return made === kit && gl.getQueryParameter(made.query, gl.QUERY_RESULT);
  }

  // One more sample of the whole picture; false where it is of no use any more.
  async function sample(kit, mine, number, v) {
    const turn = x => x - Math.floor(x), offset = [turn(0.5 + 0.75487766624669276 * number), turn(0.5 + 0.56984029099805327 * number)];
    let shown = performance.now();
    for (const t of tiles(made.width, made.height)) {
      let into = 0;
      for (let pass = 0;; ++pass, into = 1 - into) {
        const from = performance.now();
        tile(t, into, pass > 0, v, 0, offset);
        const more = await goesOn(kit, into);
        if (made !== kit) return false;
        if (pass === 0) learn(performance.now() - from, t);
        resize();
        if (job !== mine) return false;
        if (!more) break;
      }
      const p = made.mean;
      gl.bindFramebuffer(gl.FRAMEBUFFER, made.single[1 - into]);
      gl.useProgram(p.program);
      bind(p, "tile", 0, made.sets[into][0]);
      bind(p, "picture", 1, made.picture);
      set(p, "corner", [t.x, t.y]);
      set(p, "share", [1 / (number + 1)]);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      copy(made.single[1 - into], made.pictureFrame, t);
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
      if (state.playing && seen) {
        state.time = (state.time + state.speed * (now - last) / 1000) % kit.reflection.time_end;
        tick();
        changed();
      }
      last = now;
      if (!seen) await wait(100);
      else if (job === null) {
        const mine = job = {}, v = viewNow(), pixels = made.width * made.height, affordable = cost ? Math.max(40 / cost, 400) : 400;
        for (let some = affordable;; some *= 8) {
          await roughPicture(kit, some, v);
          if (made === kit && made.rough && some === affordable) happened("draw");
          if (made !== kit || job !== mine || state.playing || 8 * some >= pixels / 2) break;
        }
      } else if (state.drawn < state.samples) {
        const mine = job;
        if (await sample(kit, mine, state.drawn, viewNow()) && job === mine && ++state.drawn >= state.samples) happened("rest");
      }
      await new Promise(r => document.hidden ? setTimeout(r, 200) : requestAnimationFrame(r));
    }
  }

  const nothing = {changed() {}, stop() {}, show() { return false; }};
  if (!gl) {
    say("This browser has no WebGL 2, or it is switched off.", true);
    return nothing;
  }
  if (!gl.getExtension("EXT_color_buffer_float")) {
    say("This browser's WebGL 2 cannot draw into textures of floats, which the scene needs.", true);
    return nothing;
  }
  canvas.addEventListener("webglcontextlost", e => {
    e.preventDefault();
    made = building = null;
    if (stopped) return;
    if (++lost < 4) say("The browser or its graphics driver stopped this picture. It begins again as soon as it may.");
    else say("The graphics driver stops this picture each time it is drawn. Reload the page to try again.", true);
  });
  canvas.addEventListener("webglcontextrestored", () => {
    if (stopped || lost > 3) return;
    gl.getExtension("EXT_color_buffer_float");
    start();
  });
  const watch = new IntersectionObserver(entries => { seen = entries.at(-1).isIntersecting; });
  watch.observe(canvas);
  start();
  return {
    changed,
    show() { if (made && made.rough) show(); return Boolean(made && made.rough); },
    stop() {
      stopped = true;
      watch.disconnect();
      made = building = null;
      const lose = gl.getExtension("WEBGL_lose_context");
      if (lose) lose.loseContext();
    }
  };
}

// ---- what the user moves ----

const make = (kind, text, parent) => { const e = document.createElement(kind); e.textContent = text; parent.append(e); return e; };

// A control for each param, the time and the buttons, in `panel`. Returns what shows the present state in them.
function controls(view, panel, state, inputs, animated, end) {
  const refresh = [], pick = (name, value) => { view.params = {[name]: value.length > 1 ? value : value[0]}; tell(view, "change", {what: "param", name}); };

  function control(label, type, place) {
    const input = make("input", "", label);
    input.type = type;
    input.addEventListener("input", () => place(input));
    return input;
  }

  function choice(p, label, value) {
    const input = make("select", "", label), words = p.values.map(v => p.type === "bool" ? (v[0] ? "yes" : "no") : v.map(short).join(", "));
    words.forEach(w => make("option", w, input));
    input.setAttribute("aria-label", p.label);
    input.addEventListener("input", () => pick(p.name, p.values[input.selectedIndex]));
    value.remove();
    return () => { input.selectedIndex = p.values.findIndex(v => v.every((x, i) => x === state.params[p.name][i])); };
  }

  function numbers(p, label, value) {
    const scale = {deg: 180 / Math.PI, turn: 0.5 / Math.PI}[p.unit] || 1, unit = p.unit ? " " + p.unit : "", say = v => v.map(x => short(scale * x)).join(", ");
    const inputs = p.first.map((_, k) => {
      const input = control(label, p.range ? "range" : "number", e => {
        if (e.value === "" || !Number.isFinite(Number(e.value))) return;
        const now = state.params[p.name].slice();
        now[k] = Number(e.value) / scale;
        if (p.range) now[k] = clamp(now[k], p.range[0][k], p.range[1][k]);
        pick(p.name, now);
      });
      input.setAttribute("aria-label", p.label + (p.first.length > 1 ? " " + "xyzw"[k] : ""));
      if (p.range) [input.min, input.max] = [scale * p.range[0][k], scale * p.range[1][k]];
      input.step = p.type === "int" ? 1 : "any";
      return input;
    });
    return () => {
      const now = state.params[p.name];
      inputs.forEach((input, k) => { if (input !== input.getRootNode().activeElement) input.value = scale * now[k]; });
      value.textContent = say(now) + unit + (p.range ? " of " + say(p.range[0]) + " to " + say(p.range[1]) + unit : "");
    };
  }

  function color(p, label) {
    const byte = x => Math.round(255 * clamp(encode(x), 0, 1)).toString(16).padStart(2, "0");
    const input = control(label, "color", e => pick(p.name, [1, 3, 5].map(at => decode(parseInt(e.value.slice(at, at + 2), 16) / 255)).concat(state.params[p.name].slice(3))));
    input.setAttribute("aria-label", p.label);
    return () => { input.value = "#" + state.params[p.name].slice(0, 3).map(byte).join(""); };
  }

  function check(p, label) {
    const input = control(label, "checkbox", e => pick(p.name, [e.checked ? 1 : 0]));
    return () => { input.checked = state.params[p.name][0] !== 0; };
  }

  for (const p of inputs) {
    if (p.values && p.values.length === 1) {
      const fixed = p.type === "bool" ? String(p.first[0] !== 0) : p.first.map(short).join(", ");
      make("p", p.label + " = " + fixed + " (fixed here: each value is a scene of its own)", panel);
      continue;
    }
    const label = make("label", "", panel);
    make("span", p.label, label);
    const value = make("output", "", label);
    refresh.push((p.values ? choice : p.color ? color : p.type === "bool" ? check : numbers)(p, label, value));
  }

  const button = (text, act) => { const b = make("button", text, panel); b.addEventListener("click", act); return b; };
  if (animated) {
    const label = make("label", "", panel), last = Math.min(end, 60);
    make("span", "Time", label);
    const value = make("output", "", label), scrub = control(label, "range", e => { view.time = Math.min(Number(e.value), last * 0.999999); view.playing = false; tell(view, "change", {what: "time"}); });
    Object.assign(scrub, {min: 0, max: last, step: "any"});
    scrub.setAttribute("aria-label", "Time, seconds");
    const play = button("", () => { view.playing = !view.playing; tell(view, "change", {what: "time"}); }), rate = make("label", "", panel);
    make("span", "Speed", rate);
    const speed = control(rate, "number", e => { const s = Number(e.value); if (e.value !== "" && s >= 0 && s <= 100) view.speed = s; });
    Object.assign(speed, {min: 0, max: 100, step: 0.1});
    speed.setAttribute("aria-label", "Speed of the time");
    refresh.push(() => {
      scrub.value = state.time % last;
      value.textContent = state.time.toFixed(1) + " s";
      if (speed !== speed.getRootNode().activeElement) speed.value = state.speed;
      play.textContent = state.playing ? "Pause" : "Play";
    });
  }
  button("First view", () => { view.home(); tell(view, "change", {what: "camera"}); });
  for (const side in sides) button(side[0].toUpperCase() + side.slice(1), () => { view.look(side); tell(view, "change", {what: "camera"}); }).title = "From the " + side + " (key " + sides[side].key + ")";
  button("Save picture", async () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(await view.picture());
    link.download = view.scene.title + ".png";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
  if (document.fullscreenEnabled) button("Full screen", () => document.fullscreenElement ? document.exitFullscreen() : view.requestFullscreen());
  return () => refresh.forEach(f => f());
}

// The pointer, the wheel and the keys. A page that holds the view scrolls past it until it is clicked.
function gestures(view, canvas, state) {
  const pointers = new Map(), camera = state.camera;
  let taken = false;
  const take = on => { taken = on; canvas.classList.toggle("taken", on || view.hasAttribute("wheel")); };
  const turn = (x, y) => { camera.around -= x; camera.above = clamp(camera.above + y, -1.57, 1.57); };
  const come = factor => { camera.zoom = clamp(camera.zoom * factor, 0.01, 100); };
  const pan = (x, y) => { // in pixels of the page
    const {reflection} = view.scene.variants[0], v = cameraUniforms(reflection, camera, canvas.clientWidth / canvas.clientHeight);
    const size = 2 * v.fathom_extent[0] * (defaultsOf(reflection).fathom_orthographic[0] ? 1 : v.fathom_focus[0]) / canvas.clientHeight;
    ["x", "y", "z"].forEach((k, i) => { camera[k] += size * (y * v.fathom_up[i] - x * v.fathom_right[i]); });
  };
  const moved = () => { view.camera = camera; tell(view, "change", {what: "camera"}); };
  take(false);
  canvas.addEventListener("blur", () => take(false));
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
    if (!taken && !view.hasAttribute("wheel")) return;
    come(Math.exp(0.001 * e.deltaY));
    moved();
    e.preventDefault();
  }, {passive: false});
  const keys = {ArrowLeft: () => turn(0.1, 0), ArrowRight: () => turn(-0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
    "+": () => come(0.9), "-": () => come(1 / 0.9), r: () => Object.assign(camera, firstCamera(view.scene.variants[0].reflection))};
  for (const {key, at} of Object.values(sides)) keys[key] = () => Object.assign(camera, at);
  canvas.addEventListener("keydown", e => {
    if (e.ctrlKey || e.metaKey || e.altKey) return; // the browser's own
    const key = e.key.length === 1 ? e.key.toLowerCase() : e.key;
    if (key === " " && view.animated) {
      view.playing = !view.playing;
      tell(view, "change", {what: "time"});
    } else if (Object.hasOwn(keys, key)) {
      keys[key]();
      moved();
    } else return;
    e.preventDefault();
  });
}

// ---- the element ----

const style = new CSSStyleSheet();
style.replaceSync(`:host { display: block; position: relative; aspect-ratio: 16 / 9; overflow: hidden; color-scheme: light dark; font: 14px system-ui, sans-serif;
  --back: light-dark(#e8e8e8, #1c1c1c); --ink: light-dark(#111, #eee); --panel: light-dark(#fffd, #000b); background: var(--back); color: var(--ink); }
:host([hidden]) { display: none; }
canvas { position: absolute; width: 100%; height: 100%; display: block; touch-action: pan-y; outline-offset: -2px; }
canvas.taken { touch-action: none; }
details, [role=status]:not(:empty) { position: absolute; background: var(--panel); border-radius: 6px; padding: 8px; }
details { top: 8px; left: 8px; max-width: min(22em, calc(100% - 16px)); max-height: calc(100% - 16px); overflow: auto; box-sizing: border-box; }
label { display: grid; grid-template-columns: 1fr auto; gap: 2px 8px; margin: 8px 0; align-items: center; }
input[type=range], input[type=number] { grid-column: 1 / 3; width: 100%; box-sizing: border-box; margin: 0; min-height: 24px; }
button, summary, select { min-height: 28px; margin: 2px 4px 2px 0; font: inherit; cursor: pointer; }
[role=status] { left: 8px; right: 8px; bottom: 8px; white-space: pre-wrap; pointer-events: none; width: fit-content; max-width: calc(100% - 32px); }`);

const sizeOf = type => Number(type.slice(-1)) || 1; // vec3: 3; float, int, bool: 1

export class FathomView extends HTMLElement {
  static observedAttributes = ["src", "shader", "controls"];
  #scene = null; #inputs = []; #state = null; #drawing = null; #canvas = null; #refresh = () => {}; #asked = 0;
  #root = this.attachShadow({mode: "open"});

  connectedCallback() {
    this.#root.adoptedStyleSheets = [style];
    if (this.#scene) this.#begin();
    else this.#load();
  }
  disconnectedCallback() {
    ++this.#asked;
    this.#end();
  }
  attributeChangedCallback(name) {
    if (!this.isConnected) return;
    if (name === "controls") this.#panel();
    else this.#load();
  }

  get src() { return this.getAttribute("src") || ""; }
  set src(value) { this.setAttribute("src", value); }
  get scene() { return this.#scene; }
  set scene(value) {
    ++this.#asked;
    this.#end();
    this.#scene = value;
    this.#state = null;
    if (value && this.isConnected) this.#begin();
  }
  get inputs() { return this.#inputs; }
  get animated() { return Boolean(this.#scene && this.#scene.variants.some(v => v.reflection.reads_time)); }

  get params() {
    const {params} = this.#there();
    return Object.fromEntries(this.#inputs.map(p => [p.name, this.#given(p, params[p.name])]));
  }
  set params(values) {
    const state = this.#there(), next = bare([]);
    for (const [name, value] of Object.entries(values)) {
      const p = this.#inputs.find(p => p.name === name), list = [value].flat().map(Number);
      if (!p) throw new RangeError("The scene has no param " + name + ".");
      const fits = list.length === sizeOf(p.type) && list.every((x, k) => Number.isFinite(x) && (!p.range || (x >= p.range[0][k] && x <= p.range[1][k]))
        && (p.type !== "int" || Number.isInteger(x)) && (p.type !== "bool" || x === 0 || x === 1));
      if (!fits || (p.values && !p.values.some(v => v.every((x, k) => x === list[k]))))
        throw new RangeError(name + " cannot be " + JSON.stringify(value) + (p.range ? "; its range is " + JSON.stringify(p.range) : "") + (p.values ? "; it can be " + JSON.stringify(p.values.flat()) : "") + ".");
      next[name] = list;
    }
    Object.assign(state.params, next);
    this.#changed();
  }
  #given(p, value) { return p.type === "bool" ? value[0] !== 0 : value.length > 1 ? value.slice() : value[0]; }

  get camera() { return {...this.#there().camera}; }
  set camera(values) {
    const camera = this.#there().camera;
    for (const [name, value] of Object.entries(values))
      if (!(name in camera) || !Number.isFinite(value) || (name === "zoom" && !(value > 0))) throw new RangeError("A camera's " + name + " cannot be " + value + ".");
    Object.assign(camera, values);
    this.#changed();
  }

  get time() { return this.#there().time; }
  set time(seconds) {
    const end = this.#scene.variants[0].reflection.time_end;
    if (!(seconds >= 0 && seconds < end)) throw new RangeError("The time is from 0 to " + end + " s, not " + seconds + ".");
    this.#there().time = seconds;
    this.#changed();
  }
  get playing() { return this.#there().playing; }
  set playing(on) { this.#there().playing = Boolean(on) && this.animated; this.#refresh(); }
  get speed() { return this.#there().speed; }
  set speed(factor) {
    if (!(factor >= 0 && factor <= 100)) throw new RangeError("The speed is from 0 to 100, not " + factor + ".");
    this.#there().speed = factor;
    this.#refresh();
  }
  get samples() { return this.#there().samples; }
  set samples(count) {
    if (!(Number.isInteger(count) && count >= 1 && count <= 256)) throw new RangeError("A pixel has 1 to 256 samples, not " + count + ".");
    this.#there().samples = count;
    this.#changed();
  }
  get drawn() { return this.#there().drawn; }

  home() {
    const state = this.#there();
    Object.assign(state.camera, firstCamera(this.#scene.variants[0].reflection));
    for (const p of this.#inputs) state.params[p.name] = p.first.slice();
    this.#changed();
  }
  look(side) {
    if (!Object.hasOwn(sides, side)) throw new RangeError("A view is from the " + Object.keys(sides).join(", ") + ", not from " + side + ".");
    this.camera = sides[side].at;
  }
  picture() {
    if (!this.#drawing || !this.#drawing.show()) return Promise.reject(new Error("There is no picture yet."));
    return new Promise(resolve => this.#canvas.toBlob(resolve));
  }

  #there() {
    if (!this.#state) throw new Error("The view has no scene yet; its event `load` says when.");
    return this.#state;
  }
  #changed() {
    this.#refresh();
    if (this.#drawing) this.#drawing.changed();
  }
  async #load() {
    const mine = ++this.#asked, shader = this.getAttribute("shader");
    if (!this.src) return;
    this.#end();
    this.#scene = this.#state = null;
    this.#status("Loading the scene…");
    try {
      const scene = await loadScene(this.src, shader);
      if (mine === this.#asked) this.scene = scene;
    } catch (e) {
      if (mine === this.#asked) this.#status(e.message, true);
    }
  }
  #status(text, failed) {
    const old = this.#root.querySelector("[role=status]"), word = old || make("div", "", this.#root);
    word.setAttribute("role", "status");
    if (word.textContent !== text) word.textContent = text;
    if (failed) tell(this, "error", {message: text});
  }
  #end() {
    if (this.#drawing) this.#drawing.stop();
    this.#drawing = this.#canvas = null;
    this.#refresh = () => {};
    this.#root.replaceChildren();
  }
  #begin() {
    this.#end();
    const {reflection} = this.#scene.variants[0];
    this.#inputs = inputsOf(this.#scene);
    this.#state = this.#state || {camera: firstCamera(reflection), params: bare(this.#inputs.map(p => [p.name, p.first.slice()])),
      time: (defaultsOf(reflection).fathom_time || [0])[0], speed: 1, playing: this.animated, samples: 8, drawn: 0};
    this.#canvas = make("canvas", "", this.#root);
    Object.assign(this.#canvas, {tabIndex: 0, role: "img"});
    this.#canvas.setAttribute("aria-label", this.#scene.title + ": drag to turn, wheel to come nearer; keys: arrows turn, plus and minus come nearer, 1, 3 and 7 look from the front, the right and the top, R from where the scene says");
    this.#status("");
    this.#panel();
    gestures(this, this.#canvas, this.#state);
    tell(this, "load");
    this.#drawing = drawing(this.#canvas, this.#scene, this.#state,
      {say: (text, failed) => this.#status(text, failed), happened: kind => tell(this, kind), tick: () => this.#refresh()});
  }
  #panel() {
    const old = this.#root.querySelector("details");
    if (old) old.remove();
    this.#refresh = () => {};
    if (!this.hasAttribute("controls") || !this.#canvas) return;
    const panel = make("details", "", this.#root);
    make("summary", "Controls", panel);
    panel.open = this.clientWidth > 600;
    this.#refresh = controls(this, panel, this.#state, this.#inputs, this.animated, this.#scene.variants[0].reflection.time_end);
    this.#refresh();
  }
}

if (!customElements.get("fathom-view")) customElements.define("fathom-view", FathomView);
