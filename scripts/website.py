#!/usr/bin/env python3
"""A static site of scenes: scripts/website.py FATHOM OUT SCENE.sdf…

Writes into the folder OUT a page a scene (`fathom compile --target html`), a picture of each (320x240), the
module web/fathom-view.js, and index.html, which loads a scene into itself where its picture is clicked. Exit status 1
where a scene fails or a link of the site leads nowhere.
"""
import html
import html.parser
import pathlib
import shutil
import subprocess
import sys
import urllib.parse

root = pathlib.Path(__file__).resolve().parent.parent
index = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Scenes</title>
<style>
body {{ margin: 1em auto; max-width: 70em; padding: 0 1em; font: 16px/1.5 system-ui, sans-serif; }}
#shown {{ width: 100%; max-height: 80vh; }}
ul {{ display: grid; grid-template-columns: repeat(auto-fill, minmax(160px, 1fr)); gap: 1em; list-style: none; padding: 0; }}
img {{ width: 100%; height: auto; display: block; }}
</style>
<script type="module" src="fathom-view.js"></script>
</head>
<body>
<h1>Scenes</h1>
<fathom-view id="shown" controls hidden></fathom-view>
<ul>
{items}</ul>
<script>
for (const link of document.querySelectorAll("li a")) link.addEventListener("click", e => {{
  if (e.ctrlKey || e.metaKey || e.shiftKey) return;
  e.preventDefault();
  const view = document.getElementById("shown");
  view.hidden = false;
  view.src = link.getAttribute("href");
  view.scrollIntoView();
}});
</script>
</body>
</html>
"""
item = """<li><a href="{page}"><img src="{picture}" alt="" width="320" height="240" loading="lazy">{name}</a></li>
"""


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.found = []

    def handle_starttag(self, tag, attributes):
        self.found += [value for name, value in attributes if name in ("href", "src")]


def lost_links(folder):
    """Each link of the folder's pages that leads to no file of it."""
    for page in sorted(folder.glob("*.html")):
        links = Links()
        links.feed(page.read_text())
        for link in links.found:
            target = urllib.parse.unquote(link.split("#")[0])
            if not target or not (folder / target).is_file():
                yield f"{page.name}: {link}"


def main(program, out, *scenes):
    folder = pathlib.Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(root / "web" / "fathom-view.js", folder)
    items, failed = "", False
    for scene in map(pathlib.Path, scenes):
        page, picture = folder / f"{scene.stem}.html", folder / f"{scene.stem}.png"
        done = [subprocess.run([program, *words], check=False).returncode == 0 for words in (
            ["compile", scene, "--target", "html", "-o", page],
            ["render", scene, "--size", "320x240", "--samples", "4", "-o", picture])]
        if not all(done):
            failed = True
            continue
        items += item.format(page=html.escape(urllib.parse.quote(page.name)), name=html.escape(scene.stem),
                             picture=html.escape(urllib.parse.quote(picture.name)))
    (folder / "index.html").write_text(index.format(items=items))
    for link in lost_links(folder):
        print(f"{link} leads nowhere", file=sys.stderr)
        failed = True
    return failed


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
