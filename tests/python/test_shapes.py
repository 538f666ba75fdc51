"""Shapes as functions of Python are those of the language."""

import functools
import inspect
import operator
import pathlib
import re
import subprocess
import sys

import fathom
import numpy as np
import pytest
from fathom import shapes
from fathom.shapes import box, camera, cylinder, sphere, text

p = np.random.default_rng(2).uniform(-2, 2, (500, 3)).astype(np.float32)


@pytest.mark.parametrize(
    "shape, words",
    [
        (sphere(1) - box(0.5), "sphere(1) - box(0.5)"),
        (sphere(1.2) & box([1, 2, 3]), "sphere(1.2) & box([1, 2, 3])"),
        (sphere(1) | box(2) - cylinder(0.5, 4), "sphere(1) | (box(2) - cylinder(0.5, 4))"),
        (box(1).translate(x=-1).rotate(0.3, axis=text("Y")), "box(1).translate(x: -1).rotate(0.3, axis: Y)"),
        (sphere(1).displace(text("p => 0.1 * sin(5 * p.x)")), "sphere(1).displace(p => 0.1 * sin(5 * p.x))"),
        (shapes.smooth_union(np.float64(0.2), [sphere(1), box(1)]), "smooth_union(0.2, [sphere(1), box(1)])"),
        (shapes.dfmodel.sphere(1), 'import "dfmodel" as dfmodel\ndfmodel.sphere(1)'),
        (~sphere(1), "sphere(1).complement()"),
    ],
)
def test_the_same_graph_as_the_words(shape, words):
    made, said = shape.scene(), fathom.compile(words)
    np.testing.assert_array_equal(made.distance(p), said.distance(p))
    assert made.facts.lipschitz == said.facts.lipschitz and made.facts.exact == said.facts.exact


def test_a_shared_shape_is_written_once():
    shape = sphere(1).translate(x=0.1)
    for _ in range(60):  # 2^60 spheres if it were written out
        shape = shape | shape.translate(y=0.01)
    assert len(str(shape)) < 10000


def test_long_chains():
    balls = functools.reduce(operator.or_, [sphere(0.1).translate(x=i) for i in range(2000)])
    assert abs(balls.scene().distance([1999, 0, 0]) + 0.1) < 1e-3


def test_a_scene_of_several_items():
    scene = shapes.scene(sphere(1), camera(at=[0, 0, 9], look_at=[0, 0, 0]))
    assert scene.render(16, 16, samples=1).shape == (16, 16, 4)


def test_errors():
    with pytest.raises(AttributeError, match="sphere"):
        shapes.shpere
    with pytest.raises(AttributeError, match="translate"):
        sphere(1).tranlsate(x=1)
    with pytest.raises(fathom.Error):
        sphere("one").scene()
    with pytest.raises(TypeError):
        sphere(object())
    with pytest.raises(ValueError):
        sphere(float("nan"))


def test_strings_cannot_leave_their_quotes():
    with pytest.raises(fathom.Error) as raised:
        shapes.image('a"), sphere(1)\n\\').scene()
    assert not any("parse" in d.code or "syntax" in d.code for d in raised.value.diagnostics)


def test_docs_are_the_library_s():
    assert "A ball" in inspect.getdoc(sphere) and "radius: float = 1" in inspect.getdoc(sphere)
    assert "gyroid" in dir(shapes) and "map" not in shapes.__all__


def test_shapes_need_no_import_of_their_own():
    program = "import fathom; print(fathom.shapes.sphere(1)); fathom.shape"
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert ran.stdout.strip() == "sphere(1)"
    assert "module 'fathom' has no attribute 'shape'" in ran.stderr


def test_stubs_name_what_there_is():
    folder = pathlib.Path(fathom.__file__).parent
    stub = (folder / "_core.pyi").read_text()
    for name, body in re.findall(r"^class (\w+):\n((?:    .*\n|\n)+)", stub, re.M):
        there = {n for n in dir(getattr(fathom._core, name)) if not n.startswith("__")}
        stubs = set(re.findall(r"^    (?:def )?(\w+)[:(]", body, re.M)) - {"__init__"}
        assert stubs == there, name
    functions = set(re.findall(r"^def (\w+)", stub, re.M)) | set(re.findall(r"^class (\w+)", stub, re.M))
    assert functions == {n for n in dir(fathom._core) if not n.startswith("_")}
