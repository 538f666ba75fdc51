"""Scenes as text, signed distance functions, and proofs of how far a ray may step.

    import fathom, numpy as np
    scene = fathom.compile("param r = 1 in 0.5..2\\nsphere(r) - box(0.5)")
    scene.distance(np.zeros((1000, 3), np.float32))
    scene.with_params(r=1.5).render(320, 240)

`fathom.shapes` has the functions of the language as functions of Python.
"""

import html as _html
import importlib as _importlib
import struct as _struct
import zlib as _zlib


class Error(Exception):
    """A scene that does not compile, or a call that the library refused. `diagnostics` says why."""

    def __init__(self, diagnostics):
        super().__init__("\n".join(map(repr, diagnostics)))
        self.diagnostics = diagnostics


class Cancelled(Exception):
    """Work that a `progress`, or a compilation that its `cancelled`, gave up."""


from ._core import (  # noqa: E402  the module raises the two above
    Clearance,
    Diagnostic,
    Facts,
    LibraryEntry,
    Measures,
    Mesh,
    MeshCertificate,
    Param,
    Place,
    ProofCache,
    Scene,
    Shader,
    ShaderInput,
    __version__,
    compile,
    format_text,
    library_entries,
    load,
    shader_targets,
)


def __getattr__(name):  # `fathom.shapes` without an import of its own; it takes some milliseconds to make
    if name == "shapes":
        return _importlib.import_module("fathom.shapes")
    raise AttributeError(f"module 'fathom' has no attribute '{name}'")


def __dir__():
    return sorted([*globals(), "shapes"])


def png(picture):
    """The bytes of a PNG of a picture as `Scene.render` gives it."""
    height, width, _ = picture.shape

    def chunk(kind, data):
        return _struct.pack(">I", len(data)) + kind + data + _struct.pack(">I", _zlib.crc32(kind + data))

    rows = b"".join(b"\0" + row.tobytes() for row in picture)
    header = _struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"sRGB", b"\0")
        + chunk(b"IDAT", _zlib.compress(rows, 6))
        + chunk(b"IEND", b"")
    )


def _data(of):
    """As a console shows what is data: `Param(name='r', label='', …)`."""
    names = [name for name, member in vars(type(of)).items() if isinstance(member, property)]
    return f"{type(of).__name__}({', '.join(f'{name}={getattr(of, name)!r}' for name in names)})"


def _scene(scene):
    facts = scene.facts
    params = ", ".join(f"{param.name}={param.value!r}" for param in scene.params)
    return f"<Scene({params}): {facts.status}, lipschitz {facts.lipschitz}>"


def _mesh(mesh):
    return f"<Mesh of {len(mesh.vertices)} vertices and {len(mesh.triangles)} triangles>"


def _picture_of_scene(scene):
    return png(scene.render(480, 320))


def _page_of_scene(scene):
    """The page of the scene, which turns by the mouse; None where a page cannot hold it."""
    try:
        page = scene.shader("html").text
    except Error:
        return None
    return (
        f'<iframe srcdoc="{_html.escape(page)}" sandbox="allow-scripts" '
        'style="width:640px;height:400px;border:0"></iframe>'
    )


for _type in (Clearance, Facts, LibraryEntry, Measures, MeshCertificate, Param, Place, ShaderInput):
    _type.__repr__ = _data
Scene.__repr__ = _scene
Mesh.__repr__ = _mesh
Scene._repr_png_ = _picture_of_scene
Scene._repr_html_ = _page_of_scene
