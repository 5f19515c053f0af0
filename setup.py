"""Builds the extension and the program by CMake, for pip.

    pip install --no-build-isolation .

needs what `./quickstart` installs to build the program, and pybind11-dev and python3-dev. With ZEROCOUNT_BUNDLE it takes both, and the
libraries that they need, from a folder in which cmake/bundle/make_wheel.py has put them, and names the wheel for ZEROCOUNT_PLATFORM.
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
from wheel.bdist_wheel import bdist_wheel

ROOT = pathlib.Path(__file__).parent
BUILD = ROOT / "build" / f"python-{sys.implementation.cache_tag}"
BUNDLE = os.environ.get("ZEROCOUNT_BUNDLE")


class BuildByCMake(build_ext):
    def run(self):
        target = pathlib.Path(self.get_ext_fullpath("_zerocount"))
        target.parent.mkdir(parents=True, exist_ok=True)
        if BUNDLE:
            shutil.copytree(BUNDLE, target.parent, dirs_exist_ok=True)
        else:
            self.build(target)
        shutil.copy2(ROOT / "runners" / "python" / "_zerocount.pyi", target.parent)

    def build(self, target):
        options = [
            "-DCMAKE_BUILD_TYPE=Release",
            "-DBUILD_TESTING=OFF",
            "-DZEROCOUNT_NATIVE=ON",
            "-DZEROCOUNT_PYTHON_PACKAGE=ON",
            f"-DPython_EXECUTABLE={sys.executable}",
        ]
        subprocess.run(["cmake", "-G", "Ninja", "-S", ROOT, "-B", BUILD, *options], check=True)
        subprocess.run(["cmake", "--build", BUILD, "--target", "_zerocount", "zerocount"], check=True)
        shutil.copy2(BUILD / "python" / f"_zerocount{sysconfig.get_config_var('EXT_SUFFIX')}", target)
        self.distribution.data_files = [("bin", [os.path.relpath(BUILD / "zerocount", ROOT)])]


class Wheel(bdist_wheel):
    def get_tag(self):
        python, abi, platform = super().get_tag()
        return python, abi, os.environ.get("ZEROCOUNT_PLATFORM", platform)


def version():
    project = re.search(r"^project\(zerocount VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)
    return project[1]


setup(
    version=version(),
    ext_modules=[Extension("_zerocount", [])],
    cmdclass={"build_ext": BuildByCMake, "bdist_wheel": Wheel},
    # The program of a bundle finds its libraries from where it lies in the package.
    entry_points={"console_scripts": ["zerocount = _zerocount_program:main"]} if BUNDLE else {},
    # h5py has another name where it is Debian's, so that pip would not see it.
    install_requires=["numpy", "h5py"] if BUNDLE else ["numpy"],
)
