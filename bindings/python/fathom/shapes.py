"""The functions of the language as functions of Python: `sphere(1) - box(0.5)` is an expression of it.

    from fathom.shapes import box, sphere
    solid = sphere(1.2) & box(2) - sphere(0.5).translate(x=1)
    solid.scene().distance(points)

An expression is written out and compiled when `scene` is called, so that its errors, bounds and limits are the
language's own. `help(sphere)` is `fathom doc sphere`. `text` writes out what Python has no words for.
"""

import builtins as _builtins
import difflib as _difflib
from types import MappingProxyType as _Mapping

from . import _core

_MAX_DEPTH = 16  # of parentheses; what is deeper gets a name


def _library():
    entries = {}
    for entry in _core.library_entries():
        name = f"{entry.module}.{entry.name}" if entry.module else entry.name
        entries.setdefault(name, []).append(f"{entry.signature}\n\n{entry.doc}")
    return _Mapping({name: "\n\n".join(texts) for name, texts in entries.items()})


_entries = _library()


def _unknown(name):
    near = _difflib.get_close_matches(name, _entries, 1)
    return AttributeError(f"the language has no function `{name}`" + (f"; is it `{near[0]}`?" if near else ""))


class Shape:
    """An expression of the language: words, and expressions between them. It never changes."""

    __slots__ = ("_parts", "_depth")

    def __init__(self, *parts):
        self._parts = parts
        self._depth = 1 + max((p._depth for p in parts if isinstance(p, Shape)), default=0)

    def scene(self, **options):
        """The compiled scene of this shape alone; options are those of `fathom.compile`."""
        return scene(self, **options)

    def __getattr__(self, name):
        if name.startswith("_") or name not in _entries:
            raise _unknown(name)
        return _function(name, self)

    def __dir__(self):
        return [*super().__dir__(), *(name for name in _entries if "." not in name)]

    def __or__(self, other):
        return Shape("(", self, " | ", _expression(other), ")")

    def __and__(self, other):
        return Shape("(", self, " & ", _expression(other), ")")

    def __sub__(self, other):
        return Shape("(", self, " - ", _expression(other), ")")

    def __invert__(self):
        return _function("complement", self)()

    def __str__(self):
        return _program([self])

    def _repr_png_(self):
        return self.scene()._repr_png_()


def text(words):
    """An expression as the language writes it: `text("p => 0.1 * sin(9 * p.x)")`, `text("tomato")`."""
    return Shape(f"({words})")


def scene(*items, **options):
    """The scene of expressions: shapes, and what is said of the picture, as `camera(...)`."""
    return _core.compile(_program(items), **{"name": "shapes.sdf", **options})


def _expression(value):
    if isinstance(value, Shape):
        return value
    if isinstance(value, bool):
        return Shape("true" if value else "false")
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return Shape(f'"{escaped}"')
    if isinstance(value, int):
        return Shape(str(value) if value >= 0 else f"({value})")
    if hasattr(value, "__iter__"):
        parts = ["["]
        for i, item in enumerate(value):
            parts += [", ", _expression(item)] if i else [_expression(item)]
        return Shape(*parts, "]")
    if hasattr(value, "__float__"):
        number = repr(float(value))
        if number in ("inf", "-inf", "nan"):
            raise ValueError(f"the language has no number {number}")
        return Shape(number if float(value) >= 0 else f"({number})")
    raise TypeError(f"a {type(value).__name__} is no value of the language")


def _function(name, *first):
    def call(*positional, **named):
        parts = [name, "("]
        for value in (*first, *positional):
            parts += [_expression(value), ", "]
        for key, value in named.items():
            parts += [f"{key}: ", _expression(value), ", "]
        if parts[-1] == ", ":
            parts.pop()
        return Shape(*parts, ")")

    call.__name__ = call.__qualname__ = name
    call.__doc__ = _entries[name]
    return call


def _program(items):
    """A program of the items, a line each. What is used more than once, or lies deep, is a `let` before it."""
    uses, order = {}, []
    items = [_expression(item) for item in items]
    stack = [(item, False) for item in reversed(items)]
    while stack:
        shape, left = stack.pop()
        if left:
            order.append(shape)
            continue
        uses[id(shape)] = uses.get(id(shape), 0) + 1
        if uses[id(shape)] > 1:
            continue
        stack.append((shape, True))
        stack += [(part, False) for part in reversed(shape._parts) if isinstance(part, Shape)]
    written, lines = {}, []
    depth = {}
    for shape in order:
        parts = [part if isinstance(part, str) else written[id(part)] for part in shape._parts]
        words = "".join(parts)
        depth[id(shape)] = 1 + max((depth[id(p)] for p in shape._parts if isinstance(p, Shape)), default=0)
        shared = uses[id(shape)] > 1 and depth[id(shape)] > 1
        if shared or depth[id(shape)] >= _MAX_DEPTH:
            name = f"part_{len(lines) + 1}"
            lines.append(f"let {name} = {words}")
            words, depth[id(shape)] = name, 0
        written[id(shape)] = words
    words = [part for shape in order for part in shape._parts if isinstance(part, str)]
    modules = sorted({part.split(".")[0] for part in words if "." in part and part in _entries})
    imports = [f'import "{module}" as {module}' for module in modules]
    return "\n".join(imports + lines + [written[id(item)] for item in items]) + "\n"


class _Module:
    """A module of the library: `dfmodel.sphere(1)`."""

    def __init__(self, name):
        self._name = name

    def __getattr__(self, name):
        whole = f"{self._name}.{name}"
        if whole not in _entries:
            raise _unknown(whole)
        return _function(whole)


# No name of Python's own is replaced by `from fathom.shapes import *`.
_names = sorted({name.split(".")[0] for name in _entries})
__all__ = ["Shape", "scene", "text", *(name for name in _names if not hasattr(_builtins, name))]


def __getattr__(name):
    if name in _entries:
        return _function(name)
    if any(entry.startswith(name + ".") for entry in _entries):
        return _Module(name)
    raise _unknown(name)


def __dir__():
    return __all__
