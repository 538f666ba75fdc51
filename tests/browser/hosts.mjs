// The pages of examples/hosts in Chromium: what they draw is the scene, and they say nothing on the console.
//   node hosts.mjs FATHOM
import {execFileSync} from "node:child_process";
import {copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {dirname, join} from "node:path";
import {fileURLToPath} from "node:url";
import {difference, launch, picture, serve} from "./chromium.mjs";

const here = dirname(fileURLToPath(import.meta.url)), root = join(here, "../.."), fathom = process.argv[2];
const folder = mkdtempSync(join(tmpdir(), "fathom-hosts-")), size = {width: 320, height: 180};
for (const file of ["examples/hosts/element.html", "examples/hosts/webgl.html", "examples/hosts/three.html", "web/fathom-view.js"]) copyFileSync(join(root, file), join(folder, file.split("/").pop()));
for (const file of ["three.module.js", "three.core.js"]) copyFileSync(join(here, "node_modules/three/build", file), join(folder, file));
writeFileSync(join(folder, "scene.sdf"), "param radius = 1 in 0.5..2 \"Radius\"\nbox(radius).rotate(0.4, axis: Y).paint(tomato)\nplane(Y, -0.6)\n");
const run = (...words) => execFileSync(fathom, words, {cwd: folder, stdio: "pipe"});
run("compile", "scene.sdf", "--target", "html", "-o", "scene.html");
run("compile", "scene.sdf", "--target", "es300", "-o", "scene.frag", "--reflect", "scene.json");
run("render", "scene.sdf", "--size", "320x180", "--samples", "1", "-o", "scene.png");
const expected = readFileSync(join(folder, "scene.png"));
const must = (holds, what) => { if (!holds) throw new Error(what); };

const browser = await launch(), site = await serve(folder);
async function near(page, shown, what) {
  const d = await difference(page, shown, expected);
  must(d < 0.5, what + ": " + d.toFixed(2) + " % of the pixels differ");
  must(page.said.length === 0, what + " says " + page.said.join("; "));
  console.log(what + ": " + d.toFixed(2) + " % of the pixels differ");
}
try {
  const three = await browser.open(size);
  await three.go(site.address + "three.html");
  await three.until(() => document.querySelector("canvas")?.width === 320, 20);
  await new Promise(r => setTimeout(r, 2000));
  await near(three, await three.shot(), "three.html");
  await three.close();

  const plain = await browser.open(size);
  await plain.go(site.address + "webgl.html");
  await plain.until(() => document.querySelector("canvas").width === 320 && document.querySelector("input"), 20);
  await plain.run(() => { document.querySelector("form").hidden = true; });
  await new Promise(r => setTimeout(r, 2000));
  await near(plain, await plain.shot(), "webgl.html");
  await plain.run(() => { const s = document.querySelector("input"); s.value = 0.5; s.dispatchEvent(new Event("input")); });
  await new Promise(r => setTimeout(r, 1000));
  must(await difference(plain, await plain.shot(), expected) > 2, "the slider of webgl.html sets no param");
  must(plain.said.length === 0, "webgl.html says " + plain.said.join("; "));
  await plain.close();

  const page = await browser.open({width: 800, height: 800});
  await page.go(site.address + "element.html");
  await page.run(() => { Object.assign(document.querySelector("fathom-view").style, {width: "320px", height: "180px", aspectRatio: "auto"}); });
  await page.until(() => document.querySelector("fathom-view").scene && document.querySelector("fathom-view").drawn >= 1, 20);
  await page.run(() => { document.querySelector("fathom-view").samples = 1; });
  await page.until(() => document.querySelector("fathom-view").drawn >= 1, 20);
  await near(page, await picture(page), "element.html");
  await page.run(() => { const s = document.querySelector("#sliders input"); s.value = 1.7; s.dispatchEvent(new Event("input")); });
  must(await page.run(() => document.querySelector("fathom-view").params.radius) === 1.7, "the page's slider sets no param");
  await page.close();
} finally {
  await browser.close();
  site.close();
  rmSync(folder, {recursive: true});
}
