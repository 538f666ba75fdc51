// Opens the page of each scene in Chromium without a graphics card (SwiftShader), compares what it
// draws with `fathom render` at the same size, one sample a pixel, and prints a table.
//   node pages.mjs FATHOM FOLDER SCENE.sdf…
// FOLDER takes what is made. Exit status 1 where a page differs in 0.5 % of its pixels or more (by more
// than 8 of 255 in some channel), is not ready within `limit`, or says something on its console.
import {chromium} from "playwright-core";
import {execFileSync} from "node:child_process";
import {readFileSync} from "node:fs";
import {basename, join} from "node:path";

const [fathom, folder, ...scenes] = process.argv.slice(2);
const width = 320, height = 180, limit = 120, most = 0.5;

export const launch = () => chromium.launch({executablePath: process.env.FATHOM_CHROMIUM || "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]});

const data = file => "data:image/png;base64," + readFileSync(file).toString("base64");

// Per cent of the pixels of two pictures, as data: addresses, that differ.
const difference = (page, a, b) => page.evaluate(async ([a, b]) => {
  const pixels = async url => {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height).getContext("2d");
    canvas.drawImage(image, 0, 0);
    return canvas.getImageData(0, 0, image.width, image.height);
  };
  const [x, y] = [await pixels(a), await pixels(b)];
  if (x.width !== y.width || x.height !== y.height) return 100;
  let differing = 0;
  for (let i = 0; i < x.data.length; i += 4)
    if ([0, 1, 2].some(k => Math.abs(x.data[i + k] - y.data[i + k]) > 8)) ++differing;
  return 400 * differing / x.data.length;
}, [a, b]);

let bad = 0;
const browser = await launch();
const blank = await browser.newPage();
console.log("| scene | KB | first picture, s | one sample, s | pixels that differ, % | said |\n| --- | --- | --- | --- | --- | --- |");
for (const scene of scenes) {
  const name = basename(scene, ".sdf"), html = join(folder, name + ".html"), png = join(folder, name + ".png");
  const said = [];
  let first = "·", whole = "·", differs = "·", size = "·";
  try {
    execFileSync(fathom, ["compile", scene, "--target", "html", "-o", html], {stdio: "pipe"});
    execFileSync(fathom, ["render", scene, "--size", width + "x" + height, "--samples", "1", "-o", png], {stdio: "pipe"});
    size = (readFileSync(html).length / 1024).toFixed(0);
    const page = await browser.newPage({viewport: {width, height}});
    page.on("console", m => said.push(m.text()));
    page.on("pageerror", e => said.push(e.message));
    const from = Date.now(), since = () => ((Date.now() - from) / 1000).toFixed(1);
    await page.goto("file://" + html + "#samples=1&time=0");
    await page.waitForFunction(() => made && made.rough, null, {timeout: 1000 * limit, polling: 50});
    first = since();
    await page.waitForFunction(() => canvas.dataset.samples === "1", null, {timeout: 1000 * limit, polling: 50});
    whole = since();
    const shown = await page.evaluate(() => { show(); return canvas.toDataURL(); });
    differs = (await difference(blank, shown, data(png))).toFixed(2);
    if (process.env.FATHOM_SHOTS) await page.screenshot({path: join(folder, name + ".page.png")});
    await page.close();
  } catch (e) {
    said.push(e.message.split("\n")[0]);
  }
  const good = said.length === 0 && Number(differs) < most;
  if (!good) ++bad;
  console.log("| " + [name, size, first, whole, differs, said.join("; ").replaceAll("|", "/")].join(" | ") + " |");
}
await browser.close();
process.exit(bad ? 1 : 0);
