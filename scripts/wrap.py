#!/usr/bin/env python3
"""Wraps the prose of pages at 100 columns, in place: scripts/wrap.py PAGE.md…

Code blocks, tables, headings and images stay as they are; code between backticks stays on one line. Only
white space changes.
"""
import pathlib
import re
import sys

width = 100
# A word that would mean something else at the beginning of a line.
leading = re.compile(r"([-+*#>|]|#+|\d+[.)])$")


def words_of(text):
    """Split at spaces outside of backticks, where a line may break."""
    words = []
    for word in re.sub(r"`[^`]*`", lambda m: m.group().replace(" ", "\0"), text).split():
        word = word.replace("\0", " ")
        if words and leading.match(word):
            words[-1] += " " + word  # stays behind the word before it
        else:
            words.append(word)
    return words


def filled(text, first, rest):
    lines, line, empty = [], first, True
    for word in words_of(text):
        if not empty and len(line) + 1 + len(word) > width:
            lines.append(line)
            line, empty = rest, True
        line += word if empty else " " + word
        empty = False
    return lines + [line]


def wrapped(page):
    lines, paragraph, fenced = [], [], False  # a paragraph: its first indentation, the others', its lines

    def flush():
        if paragraph:
            lines.extend(filled(" ".join(paragraph[2:]), *paragraph[:2]))
            paragraph.clear()

    for line in page.split("\n"):
        text = line.strip()
        if text.startswith("```"):
            fenced = not fenced
        if fenced or not text or text.startswith(("```", "#", "|", "![", "<")):
            flush()
            lines.append(line if fenced else line.rstrip())
        elif item := re.match(r"(\s*(?:[-*]|\d+\.) )\s*(.*)", line):
            flush()
            paragraph += [item[1], " " * len(item[1]), item[2]]
        else:
            indent = re.match(r"\s*", line)[0]
            paragraph += [text] if paragraph else [indent, indent, text]
    flush()
    return "\n".join(lines)


for name in sys.argv[1:]:
    file = pathlib.Path(name)
    before = file.read_text()
    after = wrapped(before)
    assert before.split() == after.split(), name
    file.write_text(after)
