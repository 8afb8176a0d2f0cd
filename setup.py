"""Builds the Python package by CMake and hands it to setuptools. Settings are in pyproject.toml.

HEXTWIST_BUILD, in the environment, is a build tree that is there already, of this Python: nothing is compiled then that it has.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).parent.resolve()
# What reads files of others in a process of its own: the module looks for these beside itself.
READERS = ["hextwist_read_cad", "hextwist_read_hdf5"]


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


class Build(build_ext):
    def build_extension(self, extension):
        ready = os.environ.get("HEXTWIST_BUILD")
        folder = pathlib.Path(ready or self.build_temp).resolve()
        if not ready:
            settings = {
                "CMAKE_BUILD_TYPE": "Release",
                "HEXTWIST_UNITY_BUILD": "ON",
                "HEXTWIST_BUILD_TESTS": "OFF",
                "HEXTWIST_BUILD_GMSH": "OFF",
                "HEXTWIST_BUILD_MPI": "OFF",
                "HEXTWIST_BUILD_PYTHON": "ON",
                "Python_EXECUTABLE": sys.executable,
            }
            try:
                import pybind11

                settings["pybind11_DIR"] = pybind11.get_cmake_dir()
            except ImportError:
                pass  # CMake looks for that of the system
            folder.mkdir(parents=True, exist_ok=True)
            run("cmake", "-S", SOURCE, "-B", folder, "-G", "Ninja", *(f"-D{name}={value}" for name, value in settings.items()))
        run("cmake", "--build", folder, "--target", "hextwist_python", *READERS)
        stage = pathlib.Path(self.build_temp).resolve() / "stage"
        shutil.rmtree(stage, ignore_errors=True)
        run("cmake", "--install", folder, "--prefix", stage, "--component", "python", "--strip")
        package = next(stage.rglob("_built_for.py")).parent
        to = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve().parent
        shutil.copytree(package, to, dirs_exist_ok=True)
        for reader in READERS:
            shutil.copy2(folder / "app" / reader, to)
            run("strip", to / reader)


setup(
    version=re.search(r"project\(hextwist VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1],
    packages=[],  # CMake installs its files
    ext_modules=[Extension("hextwist._core", sources=[])],
    cmdclass={"build_ext": Build},
)
