from os import PathLike
from pathlib import Path
from typing import Any, Callable, Literal, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

class Place:
    file: str
    line: int
    column: int
    end_line: int
    end_column: int

class Diagnostic:
    severity: Literal["error", "warning", "note"]
    code: str
    message: str
    at: Place
    notes: list[str]
    help: str

class Param:
    name: str
    label: str
    color: bool
    structural: bool
    value: Any
    initial: Any
    range: tuple[Any, Any] | None

class Facts:
    lipschitz: float | None
    status: Literal["proved", "assumed", "estimated"]
    exact: bool
    time_end: float
    axioms: list[str]
    bounds: tuple[list[float], list[float]] | None

class ShaderInput:
    type: str
    name: str
    value: list[float]
    meaning: str
    param: str
    place: int

class Shader:
    text: str
    words: bytes
    inputs: list[ShaderInput]
    reads_time: bool
    reflection: str

class LibraryEntry:
    name: str
    signature: str
    doc: str
    module: str

class MeshCertificate:
    certified: bool
    mesh_to_surface: float
    surface_to_mesh: float
    least_volume: float
    largest_volume: float
    least_area: float
    largest_area: float
    components: int
    genus: int
    shape_proved: bool
    shape_why: str
    area_why: str
    shape_doubted: bool

class Mesh:
    vertices: NDArray[np.float32]
    normals: NDArray[np.float32]
    triangles: NDArray[np.uint32]
    colors: NDArray[np.float32]
    undecided_cells: int
    certificate: MeshCertificate | None
    def file(self, suffix: str, name: str = "scene") -> bytes: ...

_Enclosure = tuple[float, float]

class Measures:
    volume: _Enclosure
    center: list[_Enclosure]
    least: list[_Enclosure]
    greatest: list[_Enclosure]
    mesh_volume: float
    mesh_area: float
    mesh_center: list[float]
    components: int
    genus: int
    rests_on: list[str]

class Clearance:
    distance: _Enclosure
    near: list[list[float]]
    rests_on: list[str]

_Corner = Sequence[float] | float
_Progress = Callable[[float], bool | None]

class Scene:
    params: list[Param]
    facts: Facts
    diagnostics: list[Diagnostic]
    files: list[Path]
    def with_params(self, **values: float | bool | Sequence[float]) -> Scene: ...
    def distance(
        self, points: ArrayLike, time: float = 0.0, out: NDArray[np.float32] | None = None
    ) -> NDArray[np.float32]: ...
    def gradient(
        self, points: ArrayLike, time: float = 0.0
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]: ...
    def interval(self, boxes: ArrayLike, time: float = 0.0) -> NDArray[np.float32]: ...
    def volume(
        self,
        counts: Sequence[int] | int,
        lo: _Corner | None = None,
        hi: _Corner | None = None,
        time: float = 0.0,
    ) -> NDArray[np.float32]: ...
    def render(
        self,
        width: int = 640,
        height: int = 360,
        samples: int = 0,
        time: float = 0.0,
        threads: int = 0,
        max_steps: int = 0,
        progress: _Progress | None = None,
    ) -> NDArray[np.uint8]: ...
    def mesh(
        self,
        resolution: int = 128,
        tolerance: float = 0.0,
        time: float = 0.0,
        lo: _Corner | None = None,
        hi: _Corner | None = None,
        certify: bool = False,
        colors: bool = False,
        simplify: float = 0.0,
        threads: int = 0,
        progress: _Progress | None = None,
    ) -> Mesh: ...
    parts: list[str]
    def part(self, name: str) -> Scene: ...
    def measure(
        self,
        resolution: int = 128,
        tolerance: float = 0.0,
        time: float = 0.0,
        lo: _Corner | None = None,
        hi: _Corner | None = None,
        threads: int = 0,
        progress: _Progress | None = None,
    ) -> Measures: ...
    def clearance(
        self,
        other: Scene,
        tolerance: float,
        time: float = 0.0,
        progress: _Progress | None = None,
    ) -> Clearance: ...
    def shader(
        self,
        target: str = "glsl330",
        field_only: bool = False,
        buffers: bool = False,
        time: float = 0.0,
        title: str = "scene",
    ) -> Shader: ...
    def yaml(self) -> str: ...
    def _repr_png_(self) -> bytes: ...
    def _repr_html_(self) -> str | None: ...

class ProofCache:
    def __init__(self, most_bytes: int = 33554432) -> None: ...
    @property
    def searches(self) -> int: ...
    @property
    def bytes(self) -> int: ...

def compile(
    text: str,
    name: str = "scene.sdf",
    include: Sequence[str | PathLike[str]] = ...,
    definitions: Mapping[str, object] = ...,
    limits: Mapping[str, object] = ...,
    files: Callable[[str], str | bytes | None] | None = None,
    cache: ProofCache | None = None,
    cancelled: Callable[[], bool] | None = None,
    entered: Callable[[str], object] | None = None,
) -> Scene: ...
def load(
    path: str | PathLike[str],
    include: Sequence[str | PathLike[str]] = ...,
    definitions: Mapping[str, object] = ...,
    limits: Mapping[str, object] = ...,
    cache: ProofCache | None = None,
    cancelled: Callable[[], bool] | None = None,
    entered: Callable[[str], object] | None = None,
) -> Scene: ...
def format_text(text: str) -> str | None: ...
def library_entries() -> list[LibraryEntry]: ...
def shader_targets() -> list[str]: ...
