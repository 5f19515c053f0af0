"""Builds the extension and the program by CMake, for pip.

    pip install --no-build-isolation .

needs what `./quickstart` installs to build the program, and pybind11-dev and python3-dev.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).parent
BUILD = ROOT / "build" / f"python-{sys.implementation.cache_tag}"


class BuildByCMake(build_ext):
    def run(self):
        options = [
            "-DCMAKE_BUILD_TYPE=Release",
            "-DBUILD_TESTING=OFF",
            "-DZEROCOUNT_NATIVE=ON",
            "-DZEROCOUNT_PYTHON_PACKAGE=ON",
            f"-DPython_EXECUTABLE={sys.executable}",
        ]
        subprocess.run(["cmake", "-G", "Ninja", "-S", ROOT, "-B", BUILD, *options], check=True)
        subprocess.run(["cmake", "--build", BUILD, "--target", "_zerocount", "zerocount"], check=True)
        extension = BUILD / "python" / f"_zerocount{sysconfig.get_config_var('EXT_SUFFIX')}"
        target = pathlib.Path(self.get_ext_fullpath("_zerocount"))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(extension, target)
        shutil.copy2(ROOT / "runners" / "python" / "_zerocount.pyi", target.parent)
        self.distribution.data_files = [("bin", [os.path.relpath(BUILD / "zerocount", ROOT)])]


def version():
    project = re.search(r"^project\(zerocount VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)
    return project[1]


setup(version=version(), ext_modules=[Extension("_zerocount", [])], cmdclass={"build_ext": BuildByCMake})
