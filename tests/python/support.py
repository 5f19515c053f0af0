"""What several tests of the package use."""

from __future__ import annotations

import os
import pathlib
import re
import subprocess
from collections.abc import Iterable
from typing import Any

import h5py
import numpy as np
import pytest
import zerocount as zc

ROOT = pathlib.Path(__file__).parents[2]
SHIPPED = sorted((ROOT / "experiments" / "manifests").glob("*.yaml"))

SMALL: dict[str, dict[str, Any]] = {
    "compensators": {"machines": 4, "trials": 8},
    "contact-variation": {"machines": 4, "trials": 8},
    "delay": {"machines": 20, "trials": 60},
    "friction-models": {"trials": 4},
    "identification": {},
    "initial-conditions": {"trials": 20},
    "k1-along-position": {"trials": 60},
    "linear-stage": {"trials": 40},
    "paper-fig4": {"trials": 12},
    "paper-fig7": {"trials": 20},
    "repeatability": {"trials": 2},
    "sample-rate": {"trials": 30},
    "stability-map": {"trials": 8},
    "two-encoders": {"trials": 6},
    "unknown-friction": {"worlds": 8, "trials": 120, "sweep.grid.controller.ki": [2e-5, 3e-5, 5e-5]},
}
"""Shipped studies with settings that make them short."""

DEAR = ("repeatability", "contact-variation")
"""The shipped studies whose trials take longest."""


def dear_by_night(places: Iterable[Any]) -> list[Any]:
    """Names of shipped studies, or their paths, as parameters of a test: the dear ones are marked `long`."""
    return [pytest.param(place, marks=pytest.mark.long) if pathlib.Path(place).stem in DEAR else place for place in places]


def first_study(root: pathlib.Path, path: pathlib.Path) -> None:
    """Writes the manifest of the README's first study."""
    text = (root / "README.md").read_text(encoding="utf-8")
    path.write_text(re.search(r"```yaml\n(zerocount: 1\b[^`]*\nname: my-axis\n.*?)```", text, re.DOTALL)[1], encoding="utf-8")


def short_first_study(root: pathlib.Path, path: pathlib.Path) -> None:
    """Writes that manifest with a fifth of its trials."""
    first_study(root, path)
    text = path.read_text(encoding="utf-8").replace("machines: 1000", "machines: 200").replace("trials: 2000", "trials: 400")
    path.write_text(text, encoding="utf-8")


def shipped(name: str) -> zc.Study:
    """A shipped study, short."""
    return zc.study(ROOT / "experiments" / "manifests" / f"{name}.yaml").set(**SMALL[name])


def program(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Runs the program without the package."""
    command = [os.environ["ZEROCOUNT_PROGRAM"], *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def by_program(*arguments: object, accepted: tuple[int, ...] = (0,)) -> str:
    """Standard output of the program."""
    done = program(*arguments)
    assert done.returncode in accepted, done.stderr
    return done.stdout


def said_by_program(*arguments: object) -> str:
    """The messages with which the program refuses something."""
    done = program(*arguments)
    assert done.returncode != 0
    return done.stderr.rstrip("\n")


def datasets_of(path: object) -> dict[str, np.ndarray]:
    """All datasets of a results file by their paths."""
    found: dict[str, np.ndarray] = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


def inputs_of(path: object, names: list[str], point: int) -> np.ndarray:
    """[trial, variable] what was drawn for the trials of a point, by the full names of the variables."""
    with h5py.File(path) as file:
        mine = file["trial/point"][:] == point
        return np.column_stack([file[f"trial/input/{name}"][:][mine] for name in names])


def same(one: Any, other: Any) -> bool:
    """Whether two arrays have the same shape and values; all NaN are the same."""
    one, other = np.asarray(one), np.asarray(other)
    return np.array_equal(one, other, equal_nan=one.dtype.kind == "f" and other.dtype.kind == "f")


def same_trace(one: zc.Trace, other: zc.Trace) -> bool:
    """Whether two traces have the same inputs, samples and outcome, to the bit."""
    return one.inputs == other.inputs and all(
        list(a) == list(b) and all(same(a[name], b[name]) for name in a)
        for a, b in ((one.samples, other.samples), (one.outcome, other.outcome))
    )
