// Uses all that web/fathom-view.d.ts says; `tsc --noEmit` reads it. The lines below `@ts-expect-error` have to be wrong.
import {FathomView, cameraUniforms, firstCamera, loadScene} from "../../web/fathom-view.js";

const view: FathomView = document.createElement("fathom-view");
view.src = "scene.html";
view.addEventListener("change", e => { if (e.detail.what === "param") console.log(e.detail.name); });
view.addEventListener("error", e => console.log(e.detail.message));
view.addEventListener("load", () => {
  view.params = {radius: 1.5, tint: [1, 0, 0], holed: true};
  view.camera = {around: 0.5};
  view.time = 1;
  view.playing = false;
  view.speed = 2;
  view.samples = 4;
  const zoom: number = view.camera.zoom;
  view.home();
  view.look("top");
  console.log(zoom, view.drawn, view.animated, view.inputs.map(i => i.values ?? i.range));
});
view.picture().then((png: Blob) => png.size);
loadScene("scene.json", "scene.frag").then(scene => {
  view.scene = scene;
  const reflection = scene.variants[0].reflection;
  const origin: number[] = cameraUniforms(reflection, firstCamera(reflection), 16 / 9).fathom_origin;
  return origin;
});
// @ts-expect-error a param is no text
view.params = {radius: "1.5"};
// @ts-expect-error what is drawn is not set
view.drawn = 3;
// @ts-expect-error a camera has no roll
view.camera = {roll: 1};
// @ts-expect-error a side has a name
view.look("below it");
