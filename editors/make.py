#!/usr/bin/env python3
"""Writes what the editors' grammars know of the language's words, from `fathom doc --json`.

    editors/make.py FATHOM            writes the files
    editors/make.py FATHOM --check    writes nothing; names those that differ, and exits with 1

Each file of templates/ becomes one file of an editor. `@NAME(…)@` in a template stands for a list of
words: WORDS(keywords) joins it by `|`, SPACED(…) by blanks, QUOTED(…) as strings with commas,
ITEMS(…) as Kate's items. Alternatives of a regular expression stand with the longer ones first.
"""
import json
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
FILES = {
    "fathom.tmLanguage.json": "vscode/syntaxes/fathom.tmLanguage.json",
    "fathom.json": "vscode/snippets/fathom.json",
    "fathom.vim": "vim/syntax/fathom.vim",
    "fathom-words.el": "emacs/fathom-words.el",
    "fathom.xml": "kate/fathom.xml",
    "words.js": "codemirror/words.js",
}


def vocabulary(program):
    said = json.loads(subprocess.run([program, "doc", "--json"], check=True, capture_output=True).stdout)
    public = [f for f in said["functions"] if f["module"] == "" and "(" in f["signature"]]
    plain = [c["name"] for c in said["constants"] if "color" not in c]
    plain += [f["name"] for f in said["functions"] if f["module"] == "" and "(" not in f["signature"]]
    operators = [s for s in said["signs"] if s not in ("(", ")", "[", "]", "{", "}", ",", ":", ".", ";")]
    truths = ["false", "true"]
    control = ["break", "else", "for", "if", "import", "in", "return", "while"]
    return {
        "keywords": said["keywords"],
        "keywords_in_place": said["keywords_in_place"],
        "truths": truths,
        "control": control,
        "declaring": [k for k in said["keywords"] if k not in truths + control + ["and", "or", "not"]],
        "types": said["types"],
        "units": said["units"],
        "operators": operators,
        "constants": sorted(set(plain)),
        "colors": [c["name"] for c in said["constants"] if "color" in c],
        "functions": sorted({f["name"] for f in public}),
    }


def lines_of(items):
    """The items with blanks between them, in lines of at most 90 columns."""
    lines = [""]
    for item in items:
        if len(lines[-1]) + len(item) > 78:
            lines.append("")
        lines[-1] += (" " if lines[-1] else "") + item
    return lines


def filled(template, words):
    def put(match):
        form, name = match.groups()
        items = sorted(words[name], key=lambda w: (-len(w), w)) if form in ("SIGNS", "WORDS") else words[name]
        if form == "WORDS":
            return "|".join(items)
        if form == "VIMWORDS":
            return "\\|".join(sorted(items, key=lambda w: (-len(w), w)))
        if form == "SIGNS":  # a regular expression inside a JSON string
            return "|".join(re.sub(r"([|^*+./])", r"\\\\\1", s) for s in items)
        if form == "SPACED":
            return " ".join(items)
        if form == "LINES":
            return "\n      \\ ".join(lines_of(items))
        if form == "ELISP":
            return "\n    ".join(lines_of([f'"{w}"' for w in items]))
        if form == "COMMAS":
            return ",".join(items)
        if form == "QUOTED":
            return ", ".join(f'"{w}"' for w in items)
        if form == "STRINGS":
            return " ".join(f'"{w}"' for w in items)
        if form == "ITEMS":
            return "\n      ".join(f"<item>{w}</item>" for w in items)
        raise SystemExit(f"{template}: there is no form {form}")

    text = template.read_text()
    return re.sub(r"@([A-Z]+)\((\w+)\)@", put, text)


def main():
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    words = vocabulary(sys.argv[1])
    check = "--check" in sys.argv[2:]
    stale = []
    for name, goal in FILES.items():
        text, path = filled(HERE / "templates" / name, words), HERE / goal
        if check:
            if not path.exists() or path.read_text() != text:
                stale.append(goal)
        else:
            path.write_text(text)
    if stale:
        print("not what `editors/make.py` writes now: " + ", ".join(stale))
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
