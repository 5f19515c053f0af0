"""The examples of all docstrings of the package run, in a folder with the study of the README.

usage: docstrings.py ROOT
"""

import doctest
import importlib
import os
import pathlib
import pkgutil
import sys
import tempfile

import numpy
import zerocount
from support import first_study


def main(root: pathlib.Path) -> int:
    failed = attempted = 0
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        first_study(root, pathlib.Path("my-axis.yaml"))
        zerocount.study("my-axis.yaml").run("my-axis.h5")
        zerocount.study(root / "experiments/manifests/identification.yaml").run("identification.h5")
        for module in sorted(module.name for module in pkgutil.iter_modules(zerocount.__path__, "zerocount.")):
            result = doctest.testmod(importlib.import_module(module), extraglobs={"zc": zerocount, "np": numpy})
            failed, attempted = failed + result.failed, attempted + result.attempted
        result = doctest.testmod(zerocount, extraglobs={"zc": zerocount})
        failed, attempted = failed + result.failed, attempted + result.attempted
        os.chdir("/")
    print(f"{attempted} examples, {failed} failed")
    return failed > 0 or attempted < 40


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
