"""The package without the library: all but trials in this process, by the program."""

from __future__ import annotations

import json
import os
import pathlib
import subprocess
import sys

import zerocount as zc
from support import same

SCRIPT = """
import json, math, sys
import numpy as np
import zerocount as zc

s = zc.study("my-axis.yaml").set(machines=20, trials=40).sweep("controller.ki", [5e3, 1.2e4])
r = s.run("without-library.h5")
refused = {}
for name, ask in {
    "trial": lambda: zc.trial(s), "law": lambda: zc.trial(s, controller=lambda setup: lambda sample: 0.0), "sample": lambda: zc.sample(s, 1),
}.items():
    try:
        refused[name] = repr(ask())
    except zc.MachineError as error:
        refused[name] = str(error)
try:
    s.set({"dac.bits": 99}).labels
except zc.ManifestError as error:
    refused["key"] = error.key
facts = {name: repr(value) for name, value in vars(s.checked).items() if name != "_handle"}
print(json.dumps({
    "facts": facts, "recorded": r.checked.sha256, "tree": s.to_dict(), "point": r.point("ki=12000"), "judge": r.judge().status,
    "error": r.trace(1, 3).error.tolist(), "table": repr(r.table), "refused": refused,
}))
"""


def test_everything_else_works_without_the_library(axis: zc.Study, folder: pathlib.Path) -> None:
    """Studies, runs, tables, traces and answers are the same; a trial and a sample say what is missing."""
    environment = {**os.environ, "ZEROCOUNT_LIBRARY": "/nowhere/libzerocount.so.1"}
    done = subprocess.run([sys.executable, "-c", SCRIPT], cwd=folder, capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    s = axis.set(machines=20, trials=40).sweep("controller.ki", [5e3, 1.2e4])
    r = zc.open(folder / "without-library.h5")
    assert found["facts"] == {name: repr(value) for name, value in vars(s.checked).items() if name != "_handle"}
    assert found["recorded"] == s.sha256 and found["tree"] == s.to_dict() and found["point"] == 1
    assert found["judge"] == r.judge().status and same(found["error"], r.trace(1, 3).error) and found["table"] == repr(r.table)
    refused = found["refused"]
    assert refused.pop("key") == "dac.bits"
    assert len(refused) == 3
    for message in refused.values():
        assert "in this process needs the library libzerocount.so.1" in message and "/nowhere" in message and "apt-get install" in message


def test_a_library_of_another_version_is_refused(folder: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """The message has both versions."""
    source, library = tmp_path / "other.c", tmp_path / "libzerocount.so.1"
    source.write_text('unsigned zerocount_abi_version(void) { return 7; }\nconst char* zerocount_version(void) { return "9.9"; }\n'
                      "void zerocount_message(void) {}\nvoid zerocount_result(void) {}\n")  # fmt: skip
    subprocess.run(["cc", "-shared", "-fPIC", source, "-o", library], check=True)
    environment = {**os.environ, "ZEROCOUNT_LIBRARY": str(library)}
    words = [sys.executable, "-c", "import zerocount as zc; zc.study('my-axis.yaml')"]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False, env=environment)
    assert f"{library} is zerocount 9.9 with the interface 7; expected {zc.__version__} with 1" in done.stderr
