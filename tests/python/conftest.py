"""Studies that several tests use, run once."""

from __future__ import annotations

import locale
import os
import pathlib
from collections.abc import Callable

import matplotlib
import pytest
import zerocount as zc
from support import ROOT, shipped, short_first_study

matplotlib.use("Agg")
# As applications with Qt do; decimal_comma.py asks for a locale with a comma.
locale.setlocale(locale.LC_ALL, "")
assert locale.localeconv()["decimal_point"] == os.environ.get("ZEROCOUNT_DECIMAL_POINT", locale.localeconv()["decimal_point"])


def pytest_configure(config: pytest.Config) -> None:
    """What the marks of tests mean."""
    config.addinivalue_line("markers", "long: takes more than some seconds; run every night")


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """Where the results of the session are."""
    return tmp_path_factory.mktemp("studies")


@pytest.fixture(scope="session")
def axis(folder: pathlib.Path) -> zc.Study:
    """The first study of the README, with a fifth of its trials."""
    path = folder / "my-axis.yaml"
    short_first_study(ROOT, path)
    return zc.study(path)


@pytest.fixture(scope="session")
def first(axis: zc.Study, folder: pathlib.Path) -> zc.Results:
    """The results of that study."""
    return axis.run(folder / "my-axis.h5")


@pytest.fixture(scope="session")
def small(axis: zc.Study, folder: pathlib.Path) -> zc.Results:
    """The README's first study with 200 trials at three gains."""
    study = axis.set(machines=100, trials=200).sweep("controller.ki", [5e3, 1.2e4, 4e4])
    return study.run(folder / "small.h5")


@pytest.fixture(scope="session")
def results_of(folder: pathlib.Path) -> Callable[[str], zc.Results]:
    """The results of a shipped study with few trials, by its name."""
    known: dict[str, zc.Results] = {}

    def results(name: str) -> zc.Results:
        if name not in known:
            known[name] = shipped(name).run(folder / f"{name}.h5")
        return known[name]

    return results
