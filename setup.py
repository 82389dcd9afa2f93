"""The Python package for pip: CMake compiles the module; scenarios go to share/boltzmann of the environment."""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

build = pathlib.Path("build", "pip")
build.mkdir(parents=True, exist_ok=True)


class CMake(build_ext):
    def build_extension(self, ext):
        target = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve()
        options = ["-DBOLTZMANN_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}", "-DBOLTZMANN_SETS=all"]
        try:
            import pybind11  # of the build environment; else the system's
            options.append(f"-DPYBIND11_HEADERS={pybind11.get_include()}")
        except ImportError:
            pass
        subprocess.run(
            ["cmake", "-S", ".", "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DBOLTZMANN_TESTS=OFF",
             "-DBOLTZMANN_ARCHIVES=OFF", *options], check=True)  # fmt: skip
        subprocess.run(["cmake", "--build", build, "--target", "python_module"], check=True)
        target.parent.mkdir(parents=True, exist_ok=True)
        (compiled,) = (build / "python" / "boltzmann").glob("_core.*.so")
        subprocess.run(["strip", "--strip-unneeded", "-o", target, compiled], check=True)


setup(
    version=re.search(r"VERSION (\S+)", pathlib.Path("CMakeLists.txt").read_text().split("project(")[1])[1],
    packages=["boltzmann"],
    package_dir={"": "python"},
    package_data={"boltzmann": ["py.typed", "*.pyi"]},
    ext_modules=[Extension("boltzmann._core", [])],
    cmdclass={"build_ext": CMake},
    data_files=[
        (f"share/boltzmann/{folder.name}", sorted(map(os.fspath, folder.iterdir())))
        for folder in (pathlib.Path("scenarios"), pathlib.Path("docs", "gallery"))
    ],
    options={"build": {"build_base": str(build / "setuptools")}, "egg_info": {"egg_base": str(build)}},
)
