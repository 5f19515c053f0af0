"""Builds the program and the library by CMake, for pip.

    pip install --no-build-isolation .

needs what `./quickstart` installs to build the program. With ZEROCOUNT_BUNDLE it takes both, and the libraries that they need, from a
folder in which cmake/bundle/make_wheel.py has put them, and names the wheel for ZEROCOUNT_PLATFORM. Nothing is compiled against one
Python: a wheel is for each of version 3.
"""

import os
import pathlib
import shutil
import subprocess

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

ROOT = pathlib.Path(__file__).resolve().parent
BUILD = ROOT / "build" / "python"
BUNDLE = os.environ.get("ZEROCOUNT_BUNDLE")


class BuildByCMake(build_py):
    def run(self):
        super().run()
        target = pathlib.Path(self.build_lib)
        if BUNDLE:
            shutil.copytree(BUNDLE, target, dirs_exist_ok=True)
            return
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF"]
        subprocess.run(["cmake", "-G", "Ninja", "-S", ROOT, "-B", BUILD, *options], check=True)
        subprocess.run(["cmake", "--build", BUILD, "--target", "zerocount", "zerocount_shared"], check=True)
        for name, folder in (("zerocount", "bin"), ("libzerocount.so.1", "lib")):
            (target / "zerocount" / folder).mkdir(exist_ok=True)
            shutil.copy2(BUILD / name, target / "zerocount" / folder)


class ForThisPlatform(Distribution):
    def has_ext_modules(self):
        return True


class Wheel(bdist_wheel):
    def get_tag(self):
        return "py3", "none", os.environ.get("ZEROCOUNT_PLATFORM", super().get_tag()[2])


setup(
    distclass=ForThisPlatform,
    cmdclass={"build_py": BuildByCMake, "bdist_wheel": Wheel},
    # h5py has another name where it is Debian's, so that pip would not see it.
    install_requires=["numpy", "h5py"] if BUNDLE else ["numpy"],
)
