"""The package as its users meet it."""

import gc
import os
import pathlib
import threading
import zlib

import fathom
import numpy as np
import pytest

EXAMPLES = pathlib.Path(os.environ["FATHOM_SOURCE_DIR"]) / "examples"
rng = np.random.default_rng(1)


def points(n):
    return rng.uniform(-2, 2, (n, 3)).astype(np.float32)


def test_distances_are_those_of_the_ball():
    p = points(5000)
    d = fathom.compile("sphere(1)").distance(p)
    assert d.dtype == np.float32 and d.shape == (5000,)
    np.testing.assert_allclose(d, np.linalg.norm(p, axis=1) - 1, atol=1e-5)


def test_points_of_any_shape_and_type():
    scene = fathom.compile("box(2)")
    p = points(24).reshape(2, 3, 4, 3)
    flat = scene.distance(p.reshape(-1, 3))
    np.testing.assert_array_equal(scene.distance(p).ravel(), flat)
    np.testing.assert_array_equal(scene.distance(p.astype(np.float64)).ravel(), flat)
    np.testing.assert_array_equal(scene.distance(np.asfortranarray(p)).ravel(), flat)
    assert scene.distance([[0, 0, 0]])[0] == -1
    assert scene.distance(np.zeros((0, 3), np.float32)).shape == (0,)
    with pytest.raises(ValueError, match="3 numbers"):
        scene.distance(np.zeros((3, 2), np.float32))


def test_nothing_is_copied():
    scene = fathom.compile("sphere(1)")
    p, out = points(1000), np.empty(1000, np.float32)
    assert np.shares_memory(scene.distance(p, out=out), out)
    with pytest.raises(TypeError, match="float32"):
        scene.distance(p, out=np.empty(1000))
    with pytest.raises(ValueError, match="shape"):
        scene.distance(p, out=np.empty(999, np.float32))
    with pytest.raises(TypeError):
        read_only = np.empty(1000, np.float32)
        read_only.flags.writeable = False
        scene.distance(p, out=read_only)
    mesh = scene.mesh(resolution=8)
    vertices = mesh.vertices
    assert np.shares_memory(vertices, mesh.vertices)
    del mesh
    gc.collect()
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 1, atol=0.1)


def test_gradients_and_intervals():
    scene = fathom.compile("sphere(1)")
    p = points(1000)
    d, g = scene.gradient(p)
    np.testing.assert_array_equal(d, scene.distance(p))
    np.testing.assert_allclose(g, p / np.linalg.norm(p, axis=1)[:, None], atol=1e-5)
    lo, hi = scene.interval(np.stack([p - 0.1, p + 0.1], axis=1)).T
    assert (lo <= d).all() and (d <= hi).all()


def test_volume_is_indexed_by_x_y_z():
    scene = fathom.compile("sphere(1).translate(x: 3)")
    v = scene.volume((5, 4, 3), lo=(0, 0, 0), hi=(4, 3, 2))
    x, y, z = np.meshgrid(np.arange(5), np.arange(4), np.arange(3), indexing="ij")
    np.testing.assert_array_equal(v, scene.distance(np.stack([x, y, z], axis=-1)))
    assert scene.volume(3).shape == (3, 3, 3)
    with pytest.raises(ValueError, match="no end"):
        fathom.compile("plane()").volume(3)


def test_params():
    scene = fathom.compile('param r = 1 in 0.5..2 "Radius"\nparam c = [1, 2, 3] in -5..5\nsphere(r).translate(c)')
    r, c = scene.params
    assert (r.name, r.label, r.value, r.range) == ("r", "Radius", 1.0, (0.5, 2.0))
    assert c.value == (1, 2, 3) and c.range == ((-5, -5, -5), (5, 5, 5))
    other = scene.with_params(r=2, c=[0, 0, 0])
    assert other.distance([0, 0, 0]) == -2 and scene.params[0].value == 1
    with pytest.raises(fathom.Error, match="range"):
        scene.with_params(r=3)
    with pytest.raises(fathom.Error, match="no param `s`"):
        scene.with_params(s=3)
    for wrong in ("x", None, [1, "y", 0]):
        with pytest.raises(ValueError, match="takes a number"):
            scene.with_params(r=wrong)


def test_facts():
    facts = fathom.compile("sphere(1)").facts
    assert facts.lipschitz == 1 and facts.status == "proved" and facts.exact and facts.axioms
    np.testing.assert_allclose(facts.bounds, [[-1] * 3, [1] * 3], atol=1e-3)
    assert fathom.compile("plane()").facts.bounds is None


def test_errors_say_where():
    with pytest.raises(fathom.Error) as raised:
        fathom.compile("shpere(1)\nbxo(2)", name="a.sdf")
    first = raised.value.diagnostics[0]
    assert (first.code, first.severity, first.at.file, first.at.line) == ("unknown-name", "error", "a.sdf", 1)
    assert "sphere" in str(raised.value)
    with pytest.raises(fathom.Error, match="cannot read"):
        fathom.load("nowhere.sdf")


def test_files_come_from_a_function():
    files = {"parts/ball.sdf": "let ball = sphere(2)"}
    scene = fathom.compile('import "parts/ball.sdf" as parts\nparts.ball', files=files.get)
    assert scene.distance([0, 0, 0]) == -2
    with pytest.raises(fathom.Error):
        fathom.compile('import "other.sdf" as parts\nparts.ball', files=files.get)


def test_a_picture():
    seen = []
    picture = fathom.compile("sphere(1)").render(64, 48, samples=1, progress=lambda done: seen.append(done))
    assert picture.shape == (48, 64, 4) and picture.dtype == np.uint8
    assert (picture[..., 3] == 255).all() and not (picture[24, 32] == picture[0, 0]).all()
    assert seen and seen == sorted(seen) and 0 <= seen[0] and seen[-1] <= 1


def test_giving_up():
    scene = fathom.compile("gyroid(0.3, 0.05) & sphere(1)")
    with pytest.raises(fathom.Cancelled):
        scene.render(64, 48, progress=lambda done: False)
    with pytest.raises(ZeroDivisionError):
        scene.render(64, 48, progress=lambda done: 1 / 0)
    with pytest.raises(fathom.Cancelled):
        scene.mesh(progress=lambda done: False)


WAVES = "implicit(p => p.x + 0.3 * sin(p.y) * sin(3 * p.z), within: ball(4))\n"


def test_a_cache_proves_what_is_new():
    cache = fathom.ProofCache()
    assert cache.searches == 0 and cache.bytes == 0
    first = fathom.compile(WAVES, cache=cache)
    searches = cache.searches
    assert searches > 0 and cache.bytes > 0
    assert fathom.compile(WAVES, cache=cache).facts.lipschitz == first.facts.lipschitz
    assert cache.searches == searches
    fathom.compile(WAVES.replace("0.3", "0.2"), cache=cache)
    assert cache.searches > searches


def test_a_compilation_tells_its_phases_and_is_given_up():
    phases = []
    fathom.compile(WAVES, entered=phases.append)
    assert phases == ["check", "prove", "lower", "done"]
    phases.clear()
    fathom.load(EXAMPLES / "gears.sdf", entered=phases.append)
    assert phases == ["read", "check", "prove", "lower", "done"]
    with pytest.raises(fathom.Cancelled, match="cancelled"):
        fathom.compile(WAVES, cancelled=lambda: True)
    assert fathom.compile(WAVES, cancelled=lambda: False)

    def fails(*_):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        fathom.compile(WAVES, entered=fails)
    with pytest.raises(KeyError, match="mine"):
        fathom.load(EXAMPLES / "gears.sdf", cancelled=fails)
    with pytest.raises(TypeError):
        fathom.compile(WAVES, cache=3)


def test_a_mesh_has_colours_where_they_are_wanted():
    scene = fathom.compile("sphere(1).paint(p => if p.y > 0 { #f00 } else { #00f })")
    assert scene.mesh(resolution=8).colors.shape == (0, 3)
    mesh = scene.mesh(resolution=8, colors=True)
    above = mesh.vertices[:, 1] > 0
    assert np.all(mesh.colors[above] == [1, 0, 0]) and np.all(mesh.colors[~above] == [0, 0, 1])


def test_measures_are_enclosed_and_parts_have_names():
    scene = fathom.compile("box([1, 2, 3])\nsphere(1).translate(x: 4)\nsphere(0.5).translate(x: 9)")
    assert scene.parts == ["box", "sphere", "sphere#2"]
    box, ball = scene.part("box"), scene.part("sphere")
    of = box.measure(resolution=24)
    assert of.volume[0] <= 6 <= of.volume[1]
    assert of.greatest[2][0] <= 1.5 <= of.greatest[2][1]
    apart = box.clearance(ball, tolerance=0.02)
    assert apart.distance[0] <= 2.5 <= apart.distance[1] < 2.6
    with pytest.raises(ValueError, match="this scene has box, sphere"):
        scene.part("cone")


def test_a_mesh_is_closed():
    mesh = fathom.compile("torus(1, 0.3)").mesh(resolution=24, certify=True)
    edges = np.concatenate([mesh.triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    assert len(np.unique(edges, axis=0)) == len(edges)  # each once in this direction
    assert {tuple(e) for e in edges} == {tuple(e[::-1]) for e in edges}
    assert mesh.certificate.genus == 1 and mesh.certificate.certified
    assert len(mesh.file(".stl")) == 84 + 50 * len(mesh.triangles)
    with pytest.raises(ValueError, match="no mesh"):
        fathom.compile("plane()").mesh()


def test_shaders():
    shader = fathom.compile("param r = 1 in 0.5..2\nsphere(r)").shader("es300")
    assert "uniform float param_r;" in shader.text
    (r,) = [i for i in shader.inputs if i.param == "r"]
    assert r.name == "param_r" and r.value == [1]
    assert set(fathom.shader_targets()) >= {"glsl330", "es300", "spirv"}
    assert fathom.compile("sphere(1)").shader("spirv").words[:4] == b"\x03\x02\x23\x07"
    with pytest.raises(fathom.Error, match="no target"):
        fathom.compile("sphere(1)").shader("glsl1")


def test_time():
    scene = fathom.compile("render(time: 2)\nsphere(1 + time)")
    assert scene.distance([0, 0, 0], time=1) == -2
    with pytest.raises(ValueError, match="time"):
        scene.distance([0, 0, 0], time=3)
    assert fathom.compile("sphere(1)").distance([0, 0, 0], time=1e6) == -1


def test_threads_share_a_scene_while_the_lock_is_released():
    scene = fathom.compile("gyroid(0.3, 0.05) & sphere(1)")
    p = points(20000)
    expected = scene.distance(p)
    same = []
    threads = [
        threading.Thread(target=lambda: same.append(all((scene.distance(p) == expected).all() for _ in range(5))))
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert same == [True] * 4


def test_other_threads_run_while_a_picture_is_drawn():
    ran = []
    scene = fathom.load(EXAMPLES / "01_sphere.sdf")
    inside = threading.Event()
    other = threading.Thread(target=lambda: inside.wait(20) and ran.append(True))
    other.start()

    def progress(done):
        inside.set()
        other.join(20)  # ends only if the other thread gets the lock

    scene.render(32, 32, progress=progress)
    assert ran


def test_notebooks_show_a_scene():
    scene = fathom.compile("sphere(1)")
    png = scene._repr_png_()
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    at = png.index(b"IDAT")
    size = int.from_bytes(png[at - 4 : at], "big")
    assert len(zlib.decompress(png[at + 4 : at + 4 + size])) == 320 * (1 + 4 * 480)
    assert "<iframe" in scene._repr_html_() and "webgl2" in scene._repr_html_()


def test_the_notebook_runs():
    import json

    notebook = json.loads((EXAMPLES / "hosts" / "notebook.ipynb").read_text())
    names = {}
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    for cell in cells:
        exec("".join(cell["source"]), names)
    assert len(cells) == 5 and names["mesh"].certificate.certified


def test_a_console_shows_what_there_is():
    scene = fathom.compile("param r = 1 in 0.5..2\nsphere(r)")
    assert repr(scene) == "<Scene(r=1.0): proved, lipschitz 1.0>"
    assert repr(scene.params[0]).startswith("Param(name='r', label='r', color=False, structural=False, value=1.0")
    assert "range=(0.5, 2.0)" in repr(scene.params[0])
    assert repr(scene.facts).startswith("Facts(lipschitz=1.0, status='proved', exact=True")
    mesh = scene.mesh(resolution=8)
    assert repr(mesh) == f"<Mesh of {len(mesh.vertices)} vertices and {len(mesh.triangles)} triangles>"
    assert "shapes" in dir(fathom)
