"""The Python programs of examples/reading redo the table that `zerocount summary` prints, and what the MATLAB program reads is there.

usage: judge_reading_results.py ZEROCOUNT FOLDER
"""

import contextlib
import io
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py

manifest = """\
zerocount: 1
name: reading
seed: 7
machines: 12
trials: 60
friction:
  k1: {uniform: [90, 130]}
  k2: {uniform: [600, 900]}
command: {targets: [{integers: [1, 30]}, 0], hold: 0.3}
initial: {encoder_phase: {uniform: [0, 1]}}
sweep:
  cases: {low: {controller.ki: 3.85e-5}, high: {controller.ki: 9.45e-5}, "beyond, far": {controller.ki: 6.0e-4}}
"""


def expected_rows(zerocount):
    text = subprocess.check_output([zerocount, "summary", "study.h5", "--format", "json"], text=True)
    rows = []
    for point in json.loads(text)["points"]:
        names = ("success_rate", "success_rate_low", "success_rate_high")
        values = [point["trials"]] + [point[name] for name in names]
        values += [point["arrival_time"]["median"], point["arrival_time"]["p95"], point["jerk_count"]["mean"]]
        rows.append((point["label"], [math.nan if value is None else value for value in values]))
    return rows


def same(found, expected):
    if math.isnan(expected):
        return math.isnan(found)
    return abs(found - expected) <= 1e-11 * max(1.0, abs(expected))


def judge_python(code, expected):
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(code, {})
    lines = [line.split("\t") for line in printed.getvalue().splitlines()]
    assert len(lines) == len(expected), printed.getvalue()
    for (label, *values), (expected_label, expected_values) in zip(lines, expected):
        assert label == expected_label, (label, expected_label)
        assert len(values) == len(expected_values)
        for value, wanted in zip(values, expected_values):
            assert same(float(value), wanted), f"{label}: {values}; expected {expected_values}"


def judge_matlab(code):
    paths = re.findall(r"h5read\(file, '([^']+)'\)", code)
    with h5py.File("study.h5") as file:
        for path in paths:
            assert path in file, path
    assert len(paths) >= 5


def main():
    zerocount, programs = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        pathlib.Path("study.yaml").write_text(manifest, encoding="utf-8")
        for words in (["run", "study.yaml", "-o", "study.h5"], ["export", "study.h5", "-o", "tables"]):
            subprocess.run([zerocount, *words], check=True, stderr=subprocess.DEVNULL)
        expected = expected_rows(zerocount)
        assert 0 < expected[1][1][1] < 1 and expected[2][1][1] == 0, expected
        for name in ("trials.py", "points.py"):
            judge_python((programs / name).read_text(encoding="utf-8"), expected)
        judge_matlab((programs / "trials.m").read_text(encoding="utf-8"))
        os.chdir("/")
    print(f"the programs agree on {len(expected)} points")


main()
