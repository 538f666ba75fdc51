// Opens the page of each scene in Chromium without a graphics card, compares what it draws with
// `fathom render` at the same size, one sample a pixel, and prints a table.
//   node pages.mjs FATHOM FOLDER SCENE.sdf… ENTRY…
// ENTRY is one of the library, whose example (`fathom doc ENTRY`) is the scene. FOLDER takes what is made.
// Exit status 1 where a page differs in 0.5 % of its pixels or more (by more than 8 of 255 in some
// channel), is not ready within `limit`, or says something on its console.
import {execFileSync, spawnSync} from "node:child_process";
import {readFileSync, writeFileSync} from "node:fs";
import {basename, join, resolve} from "node:path";
import {difference, launch, picture} from "./chromium.mjs";

const [fathom, given, ...scenes] = process.argv.slice(2);
const folder = resolve(given), size = {width: 320, height: 180}, limit = 120;

function fileOf(scene) {
  if (scene.endsWith(".sdf")) return scene;
  const example = /^Example: `(.*)`$/m.exec(execFileSync(fathom, ["doc", scene]).toString());
  if (!example) throw new Error(scene + " has no example");
  const file = join(folder, scene + ".sdf");
  writeFileSync(file, example[1] + "\n");
  return file;
}

let bad = 0;
const browser = await launch(), blank = await browser.open(size);
console.error(await browser.version());
console.log("| scene | KB | first picture, s | one sample, s | pixels that differ, % | said |\n| --- | --- | --- | --- | --- | --- |");
for (const scene of scenes) {
  const name = basename(scene, ".sdf"), html = join(folder, name + ".html"), png = join(folder, name + ".png");
  let said = [], first = "·", whole = "·", differs = "·", bytes = "·";
  try {
    const file = fileOf(scene);
    const {status, stderr} = spawnSync(fathom, ["compile", file, "--target", "html", "-o", html]);
    if (status !== 0) throw new Error(stderr.toString());
    execFileSync(fathom, ["render", file, "--size", size.width + "x" + size.height, "--samples", "1", "-o", png], {stdio: "pipe"});
    bytes = (readFileSync(html).length / 1000).toFixed(0);
    const page = await browser.open(size), from = Date.now(), since = () => ((Date.now() - from) / 1000).toFixed(1);
    said = page.said;
    await page.go("file://" + encodeURI(html) + "#samples=1&time=0");
    // `picture` is there from the first coarse one on.
    await page.until(() => document.querySelector("fathom-view").picture().then(() => true, () => false), limit);
    first = since();
    await page.until(() => document.querySelector("fathom-view").drawn >= 1, limit);
    whole = since();
    differs = (await difference(blank, await picture(page), readFileSync(png))).toFixed(2);
    if (process.env.FATHOM_SHOTS) writeFileSync(join(folder, name + ".page.png"), await page.shot());
    await page.close();
  } catch (e) {
    said = [...said, e.message.split("\n")[0]];
  }
  const good = said.length === 0 && Number(differs) < 0.5;
  if (!good) ++bad;
  console.log("| " + [name, bytes, first, whole, differs, said.join("; ").replaceAll("|", "/")].join(" | ") + " |");
}
await browser.close();
process.exit(bad ? 1 : 0);
