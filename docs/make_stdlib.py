#!/usr/bin/env python3
"""docs/stdlib.md and its pictures from the library's doc comments: docs/make_stdlib.py FATHOM [--pictures [NAME…]].

Reads stdlib/*.sdf; renders each entry's example with the program FATHOM where --pictures is given (those of
the names, or all). Knows nothing of how
entries work: what is printed is what the comments say.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap

root = pathlib.Path(__file__).resolve().parent.parent
files = [
    ("solids", "Solids"), ("polyhedra", "Polyhedra and generalised distances"), ("fractals", "Blobs, sheets, fractals"),
    ("flat", "Flat shapes"), ("combining", "Combining"), ("transforms", "Transforms"), ("fields", "Fields and numbers"),
    ("looks", "Looks"), ("motion", "Motion"), ("dfmodel", "The thesis's own forms: module `dfmodel`"),
]
# Two tops in one plane, blended with a post: as written first, and by the recipe.
coplanar = """let a = box([1, 0.6, 1.4]).translate(x: -0.5)
let b = box([1, 0.6, 1]).translate(x: 0.5)
let c = cylinder(0.22, 1.6).translate([0.5, 0.5, 0])
round_union(0.25, a, b, c).translate(x: -1.3)
round_union(0.25, a | b, c).translate(x: 1.3)"""
# Nothing finite is known to hold these, so they are looked at from a place of our own.
unframed = {"gdf", "dfmodel_gdf_pair", "columns_difference", "columns_intersection", "dfmodel_offset", "distort", "repeat_mirror"}
no_shape = {"dfmodel_keep"}  # its example makes none
introduction = """# The standard library

Made by `docs/make_stdlib.py` from the comments in `stdlib/*.sdf`; `fathom doc NAME` prints an
entry. *Exact* fields are the distance to the surface, *lower bounds* never exceed it; the *bound*
is the Lipschitz bound before the compiler divides by it. Sizes are full, outer lengths unless said;
shapes are centred at the origin; y is up; angles are in radians (`30deg` writes them in degrees). A
number stands for a vector of equal components. A last argument `shapes` takes a block, a list, or
shapes.

Faces in one plane: `round_union`, `chamfer_union` and the like add material wherever two surfaces
are near, so two boxes whose tops lie in one plane get a swelling along their seam (left). Unite
such parts plainly, and blend the result with the others (right): `round_union(0.2, a | b, c)`; or
move one top by the blend's radius.

![Left a swelling where two tops meet, right none](stdlib/coplanar.png)

```
COPLANAR
```
"""


def wrapped(text, indent=""):
    """A paragraph within 100 columns; code between backticks stays on one line."""
    held = re.sub(r"`[^`]*`", lambda code: code.group().replace(" ", "\0"), text)
    lines = textwrap.fill(held, 100, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
    return lines.replace("\0", " ")


def entries(path):
    doc = []
    # A head that goes over several lines is read as one.
    text = re.sub(r"^fn \w+\(\n.*?^\)", lambda head: re.sub(r"\n\s*", " ", head[0]).replace("( ", "(").replace(" )", ")"),
                  path.read_text(), flags=re.MULTILINE | re.DOTALL)
    for line in text.splitlines():
        if line.startswith("///"):
            doc.append(line[3:].strip())
            continue
        found = re.match(r"(?:fn|let) ([a-z][A-Za-z0-9_]*)", line)
        if found:
            yield found.group(1), head_of(line)[3:] if line.startswith("fn") else found.group(1), doc
        if line.strip():
            doc = []


def head_of(line):
    """A function's line up to its body: past the parentheses and the type behind them."""
    depth = 0
    for i, c in enumerate(line):
        depth += c in "([" and 1 or 0
        depth -= c in ")]" and 1 or 0
        if depth == 0 and i > 3 and (c == "{" or (c == "=" and line[i + 1 : i + 2] in ("", " ") and ")" in line[:i])):
            return line[:i].strip()
    return line.strip()


def picture(program, name, example, module):
    out = root / "docs" / "stdlib" / f"{name}.png"
    out.parent.mkdir(exist_ok=True)
    text = ('import "dfmodel" as dfmodel\n' if module else "") + example + "\n"
    text += 'lighting(ambient: 0.25, ambient_occlusion: 1, shadow_darkness: 0.6)\nbackground(#e9edf1)\n'
    if name in unframed:
        text += "camera([2.6, 1.9, 4.2])\n"
    with tempfile.NamedTemporaryFile("w", suffix=".sdf") as scene:
        scene.write(text)
        scene.flush()
        subprocess.run([program, "render", scene.name, "-I", str(root / "examples" / "parts"), "-o", str(out), "--size", "240x180", "--samples", "4"], check=True,
                       stderr=subprocess.DEVNULL)


def main():
    program, with_pictures, names = sys.argv[1], "--pictures" in sys.argv, sys.argv[3:]
    page = [introduction.replace("COPLANAR", coplanar)]
    if with_pictures and (not names or "coplanar" in names):
        picture(program, "coplanar", coplanar + "\ncamera([0.6, 2.6, 5.6], look_at: [0, 0.2, 0], fov: 40deg)\nsun([-2, 1, 1.2])", False)
    for stem, title in files:
        page.append(f"\n## {title}\n")
        module = stem == "dfmodel"
        shown = {}
        for name, signature, doc in entries(root / "stdlib" / f"{stem}.sdf"):
            shown.setdefault(name, ([], []))
            shown[name][0].append(signature)
            shown[name][1].extend(doc)
        for name, (signatures, doc) in shown.items():
            key = ("dfmodel_" if module else "") + name
            example = next((m.group(1) for m in (re.match(r"Example: `(.*)`", d) for d in doc) if m), None)
            if with_pictures and example and key not in no_shape and (not names or key in names):
                picture(program, key, example, module)
            page.append(f"### `{name}`\n")
            page.append("```\n" + "\n".join(signatures) + "\n```\n")
            if (root / "docs" / "stdlib" / f"{key}.png").exists():
                page.append(f"![{name}](stdlib/{key}.png)\n")
            words = " ".join(d for d in doc if not d.startswith("Example:"))
            page.append(wrapped(words) + "\n")
            if example:
                page.append(f"```\n{example}\n```\n")
    page.append("\n## Built in\n\nWhat the language itself cannot say. `fathom doc NAME` prints these, too.\n")
    listed = subprocess.run([program, "doc"], check=True, capture_output=True, text=True).stdout
    own = {("dfmodel." if stem == "dfmodel" else "") + name for stem, _ in files for name, _, _ in entries(root / "stdlib" / f"{stem}.sdf")}
    for line in sorted(line for line in listed.splitlines() if line.startswith("  ")):  # others name groups
        name = line.split()[0]
        if name in own:
            continue
        lines = subprocess.run([program, "doc", name], check=True, capture_output=True, text=True).stdout.strip().split("\n\n")
        page.append(wrapped(f"- `{lines[0]}`: {' '.join(lines[1:])}", "  "))
    (root / "docs" / "stdlib.md").write_text("\n".join(page).rstrip() + "\n")


main()
