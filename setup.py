"""Builds the Python package with CMake: `pip install --no-build-isolation .` (docs/python.md)."""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).parent.resolve()
VERSION = re.search(r"project\(fathom VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        build = pathlib.Path(self.build_temp).resolve()
        off = ["PROGRAM", "TESTS", "SHARED", "GL", "VDB", "WERROR"]  # the package draws by the CPU
        subprocess.run(
            ["cmake", "-G", "Ninja", "-S", ROOT, "-B", build, "-DFATHOM_PYTHON=ON", "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_BUILD_TYPE=Release"]
            + [f"-DFATHOM_{name}=OFF" for name in off]
            + [f"-DPython3_EXECUTABLE={sys.executable}", f"-DPYTHON_EXECUTABLE={sys.executable}"]
            + os.environ.get("CMAKE_ARGS", "").split(),
            check=True,
        )
        subprocess.run(["cmake", "--build", build, "--target", "fathom_python"], check=True)
        (module,) = (build / "python" / "fathom").glob("_core.*.so")
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(module, target)


setup(version=VERSION, ext_modules=[Extension("fathom._core", [])], cmdclass={"build_ext": CMakeBuild})
