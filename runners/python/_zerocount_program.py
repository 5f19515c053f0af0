"""The command zerocount of a wheel: the program in the package, started without importing that, which takes longer."""

import importlib.util
import os
import pathlib
import sys


def main():
    program = pathlib.Path(importlib.util.find_spec("zerocount").origin).with_name("bin") / "zerocount"
    os.execv(program, ["zerocount", *sys.argv[1:]])
