"""A wrong argument is refused with the function, the argument and what was expected; results are the same everywhere."""

from __future__ import annotations

import os
import pathlib
import pickle
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest
import zerocount as zc
from zerocount.tables import short_name


class Odd:
    """No argument of any function."""


ODD = [None, 3, 2.5, True, b"x", [1], {1: 2}, Odd(), Odd, np.array(1.0), lambda: None]


def calls(axis: zc.Study, first: zc.Results) -> dict[str, Callable[[Any], Any]]:
    """Calls of public functions with an odd value as one of their arguments."""
    sample = zc.sample(axis, 2)
    watch = zc.monitor({"arrival_time": [0.04, 0.05, 0.06]})
    return {
        "study": zc.study,
        "open": zc.open,
        "Results": zc.Results,
        "shipped": zc.shipped,
        "ask": lambda odd: zc.ask(odd),
        "ask operand": lambda odd: zc.ask("judge", odd),
        "compare": zc.compare,
        "identify": zc.identify,
        "monitor": zc.monitor,
        "monitor moves": lambda odd: zc.monitor({"arrival_time": [0.04, 0.05]}, Odd() if odd is None else odd),
        "update": watch.update,
        "read": watch.read,
        "plan": lambda odd: zc.plan(success=odd, failures=odd),
        "trial": lambda odd: zc.trial(odd),
        "trial point": lambda odd: zc.trial(axis, point=odd, trial=odd),
        "trial controller": lambda odd: zc.trial(axis, controller=Odd() if odd is None or callable(odd) else odd),
        "sample": lambda odd: zc.sample(odd),
        "sample outcome": lambda odd: zc.sample(axis, 2, outcome=odd if not callable(odd) else None, threads="2"),  # type: ignore[arg-type]
        "tune": lambda odd: zc.tune(odd, "tuned.h5", budget=10),
        "tune output": lambda odd: zc.tune(axis, odd, budget=10),
        "tune goal": lambda odd: zc.tune(axis, "tuned.h5", goal=Odd() if odd is None else odd, free=odd, budget=10),
        "set": lambda odd: axis.set(Odd() if odd is None else odd),
        "sweep": lambda odd: axis.sweep(odd, [1.0]),
        "sweep values": lambda odd: axis.sweep("controller.ki", 3 if isinstance(odd, (list, dict)) else odd),
        "at": lambda odd: axis.at(Odd() if odd in (3, True) else odd),
        "without": lambda odd: axis.without(odd),
        "save": lambda odd: axis.save(odd),
        "run": lambda odd: axis.run(odd),
        "trials": lambda odd: first.trials(Odd() if odd is None or odd in (3, True) else odd),
        "trace": lambda odd: first.trace(point=Odd() if odd in (3, True) else odd),
        "report": first.report,
        "plot": lambda odd: first.plot(Odd() if odd is None else odd),
        "command": first.command,
        "draw": lambda odd: sample.draw(Odd() if odd in (3, True) else odd),
        "sample x": lambda odd: sample([90, 600, 1e5, 0.5, 20, 0.5], first=Odd() if odd in (3, True) else odd),
    }


def test_wrong_arguments_raise_errors_of_the_package(
    axis: zc.Study, first: zc.Results, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No TypeError, AttributeError or KeyError of the inside reaches the caller."""
    monkeypatch.chdir(tmp_path)
    refused = dict.fromkeys(calls(axis, first), 0)
    for name, call in calls(axis, first).items():
        for odd in ODD:
            try:
                call(odd)
            except zc.Error as error:
                refused[name] += 1
                assert str(error)
            except Exception as error:
                raise AssertionError(f"{name} with {odd!r}") from error
    assert min(refused.values()) >= len(ODD) // 2, refused


def test_the_message_names_the_argument() -> None:
    """Function, argument, value and what was expected."""
    with pytest.raises(zc.ArgumentError, match=r"study: manifest is 3 \(int\); expected a text, a path, a mapping by texts or a Study"):
        zc.study(3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="unexpected keyword"):  # as Python tells it
        zc.plan(odd=1)  # type: ignore[call-arg]


def test_numpy_numbers_and_pandas_columns_are_accepted(axis: zc.Study, first: zc.Results) -> None:
    """Numbers of NumPy, paths, and columns of pandas."""
    assert len(first.trials(np.int64(2))) == len(first.trials(2))
    assert len(axis.sweep("controller.ki", np.geomspace(5e3, 1e5, 3)).labels) == 3
    assert len(axis.sweep("controller.ki", pd.Series([5e3, 1e4])).labels) == 2
    assert zc.plan(success=np.float64(0.99))["plans"][0]["trials"] == 299


def test_results_are_the_same_in_another_folder_and_process(
    first: zc.Results, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A relative path is the one of the moment in which the file was opened."""
    monkeypatch.chdir(first.path.parent)
    results = zc.open(first.path.name)
    log = pathlib.Path("log.csv")
    log.write_text("arrival_time\n" + "0.04\n0.05\n" * 10)
    watch = zc.monitor(str(log))
    (tmp_path / "results.pickle").write_bytes(pickle.dumps(results))
    monkeypatch.chdir(tmp_path)
    assert results.path.is_absolute()
    assert results.judge().status == first.judge().status
    assert len(results.moves(0)) > 0
    assert watch.update({"arrival_time": [0.05]}).status == "undecided"
    code = "import pickle, pathlib; print(pickle.loads(pathlib.Path('results.pickle').read_bytes()).judge().status)"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=dict(os.environ))
    assert said.stdout.strip() == first.judge().status


def test_a_limit_in_brackets_is_kept_in_short_names() -> None:
    """Measures of tolerances keep their names."""
    names = ["tolerance_settling_time[8.727e-05]", "band_settling_time[1]", "friction.k1", "friction.k1@v1.5", "true_overshoot"]
    assert [short_name(name, names) for name in names] == [
        "tolerance_settling_time[8.727e-05]",
        "band_settling_time[1]",
        "k1",
        "k1@v1.5",
        "true_overshoot",
    ]


def test_moves_have_the_settling_times_of_tolerances(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """The column has the name that a goal has."""
    goal = {"tolerance": 8.727e-5, "within": 0.5, "moves": 0.5}
    results = axis.set({"goal": goal}, trials=200).at(2).run(tmp_path / "tolerance.h5", progress=False)
    moves = results.moves()
    assert "tolerance_settling_time[8.727e-05]" in moves
    assert moves.attrs["units"]["tolerance_settling_time[8.727e-05]"] == "s"
    assert "goal_met" in moves


def test_points_have_the_names_that_tables_print(axis: zc.Study, first: zc.Results) -> None:
    """Number, label, short label and both are one point, here and in the program."""
    for name in (2, "2", axis.labels[2], "ki=11767.7", "2 (ki=11767.7)"):
        assert first.point(name) == 2
        assert zc.ask("judge", first, point=name).point == 2
        assert axis.at(name).settings == {"controller.ki": "11767.7344682513"}
    assert first.judge("2 (ki=11767.7)").point == 2
    for ask in (lambda: first.point("3 (ki=11767.7)"), lambda: zc.sample(axis, 2, outcome="speed"), lambda: first.plot("no-such")):
        with pytest.raises(KeyError, match="there is no") as raised:
            ask()
        assert isinstance(raised.value, zc.ManifestError) and str(raised.value) == raised.value.message
