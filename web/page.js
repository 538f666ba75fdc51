
// ---- the page: its scene stands in it, its address says what differs from the first view ----

const view = document.querySelector("fathom-view"), page = new CSSStyleSheet();
page.replaceSync("html, body { margin: 0; height: 100%; overflow: hidden } fathom-view { height: 100%; aspect-ratio: auto }");
document.adoptedStyleSheets = [page];
let embedded = true, writing = 0;
try { embedded = window.top !== window.self; } catch (e) { /* another origin's page holds this one */ }
view.toggleAttribute("wheel", !embedded);

// Numbers that do not fit are left as they are.
function readAddress() {
  const attempt = act => { try { act(); } catch (e) { if (!(e instanceof RangeError)) throw e; } };
  view.home();
  for (const [key, text] of new URLSearchParams(location.hash.slice(1))) {
    const numbers = text.split(",").map(Number), p = view.inputs.find(p => "param_" + p.name === key), names = Object.keys(view.camera);
    if (key === "view" && numbers.length === names.length) attempt(() => { view.camera = Object.fromEntries(names.map((k, i) => [k, numbers[i]])); });
    else if (key === "time" && view.animated) attempt(() => { view.time = numbers[0]; view.playing = false; });
    else if (key === "samples") attempt(() => { view.samples = numbers[0]; });
    else if (p) attempt(() => { view.params = {[p.name]: p.range ? numbers.map((x, k) => clamp(x, p.range[0][k], p.range[1][k])) : numbers}; });
  }
}

function writeAddress() {
  clearTimeout(writing);
  writing = setTimeout(() => {
    const parts = [], camera = view.camera, first = firstCamera(view.scene.variants[0].reflection);
    if (Object.keys(first).some(k => camera[k] !== first[k])) parts.push("view=" + Object.keys(first).map(k => short(camera[k])).join(","));
    if (view.animated && !view.playing) parts.push("time=" + short(view.time));
    for (const p of view.inputs) {
      const value = [view.params[p.name]].flat().map(Number);
      if (value.some((x, k) => x !== p.first[k])) parts.push(encodeURIComponent("param_" + p.name) + "=" + value.map(short).join(","));
    }
    try { history.replaceState(null, "", "#" + parts.join("&")); } catch (e) { /* a page without an address of its own (srcdoc) */ }
  }, 300);
}

view.addEventListener("load", readAddress);
view.addEventListener("change", writeAddress);
window.addEventListener("hashchange", readAddress);
view.scene = JSON.parse(document.getElementById("fathom-scene").textContent);
