from ._core import (
    Diagnostic as Diagnostic,
    Facts as Facts,
    LibraryEntry as LibraryEntry,
    Mesh as Mesh,
    MeshCertificate as MeshCertificate,
    Param as Param,
    Place as Place,
    ProofCache as ProofCache,
    Scene as Scene,
    Shader as Shader,
    ShaderInput as ShaderInput,
    compile as compile,
    format_text as format_text,
    library_entries as library_entries,
    load as load,
    shader_targets as shader_targets,
)
from . import shapes as shapes
from numpy.typing import NDArray
import numpy as np

__version__: str

class Error(Exception):
    diagnostics: list[Diagnostic]

class Cancelled(Exception): ...

def png(picture: NDArray[np.uint8]) -> bytes: ...
