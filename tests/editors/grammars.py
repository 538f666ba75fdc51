#!/usr/bin/env python3
"""Whether each editor's grammar takes the words of all examples and golden cases for what they are.

    tests/editors/grammars.py FATHOM NODE_MODULES [textmate|vim|emacs|codemirror …]

The compiler's own tokens (`textDocument/semanticTokens` of `fathom lsp`) say of each character whether
it is in a comment (c), a string (s), a number or a colour (n), a keyword (k), an operator (o) or
something else (.). Each grammar gives the same for each text; blanks are not compared. Emacs has no
face for operators, and one for numbers and constants alike, so those are not compared there.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE))
from server import Server  # noqa: E402

CLASSES = {"comment": "c", "string": "s", "number": "n", "keyword": "k", "operator": "o"}


def texts():
    """All texts that are to be read, without the expectations of the golden cases."""
    found = {}
    for folder in ("examples", "examples/parts", "tests/golden/cases"):
        for path in sorted((ROOT / folder).glob("*.sdf")):
            if path.name.startswith("fail_"):
                continue
            text = path.read_bytes().decode("utf-8", "replace").split("//====")[0]
            if text.isascii() and "\r" not in text:  # so that all count characters alike
                found[str(path.relative_to(ROOT)).replace("/", "_")] = text
    assert len(found) > 60, len(found)
    return found


def compilers(program, found):
    server = Server(program)
    legend = server.capabilities["semanticTokensProvider"]["legend"]["tokenTypes"]
    tokens = {}
    for name, text in found.items():
        uri = "untitled:" + name
        server.open(uri, text)
        data = server.request("textDocument/semanticTokens/full", {"textDocument": {"uri": uri}})["data"]
        starts = [0]
        for line in text.splitlines(keepends=True):
            starts.append(starts[-1] + len(line))
        marks = ["."] * len(text)
        line = character = 0
        for i in range(0, len(data), 5):
            lines, step, length, kind, _ = data[i:i + 5]
            line, character = line + lines, step if lines else character + step
            for at in range(starts[line] + character, starts[line] + character + length):
                marks[at] = CLASSES.get(legend[kind], ".")
        tokens[name] = "".join(marks)
    assert server.close() == 0
    return tokens


def by_command(command, folder, found):
    """Runs an editor over the texts of a folder; it leaves NAME.marks beside each."""
    done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=600)
    marks = {}
    for name in found:
        path = pathlib.Path(folder) / (name + ".marks")
        if not path.exists():
            raise SystemExit(f"{command[0]} left no {path.name}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
        marks[name] = path.read_text()
        path.unlink()
    return marks


def compare(which, found, expected, marks, left_out):
    wrong = compared = 0
    for name, text in found.items():
        assert len(marks[name]) == len(text), (which, name, len(marks[name]), len(text))
        for at, (want, got) in enumerate(zip(expected[name], marks[name])):
            if text[at].isspace() or want in left_out or got in left_out:
                continue
            compared += 1
            if want != got:
                wrong += 1
                if wrong <= 12:
                    line = text.count("\n", 0, at) + 1
                    shown = text.splitlines()[line - 1]
                    print(f"{which}: {name}:{line}: {text[at]!r} is {want}, read as {got}: {shown}")
    print(f"{which}: {compared} characters of {len(found)} texts, {wrong} wrong")
    assert compared > 30000, "the test reads what it means to read"
    return wrong


def main():
    program, modules = sys.argv[1:3]
    wanted = sys.argv[3:] or ["textmate", "vim", "emacs", "codemirror"]
    program = str(pathlib.Path(program).resolve())
    found = texts()
    expected = compilers(program, found)
    os.environ["NODE_MODULES"] = str(pathlib.Path(modules).resolve())
    commands = {
        "textmate": ["node", str(HERE / "textmate.mjs"), str(ROOT), *found],
        "codemirror": ["node", str(HERE / "codemirror.mjs"), str(ROOT), *found],
        "vim": ["vim", "-u", "NONE", "-N", "-es", "-i", "NONE", "--cmd", f"let g:root = '{ROOT}'",
                "-S", str(HERE / "marks.vim"), *found],
        "emacs": ["emacs", "-Q", "--batch", "-L", str(ROOT / "editors/emacs"), "-l",
                  str(HERE / "marks.el"), *found],
    }
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, text in found.items():
            (pathlib.Path(folder) / name).write_text(text)
        for which in wanted:
            marks = by_command(commands[which], folder, found)
            wrong += compare(which, found, expected, marks, "no" if which == "emacs" else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
