"""A machine that is watched, beside what the program says of the same log."""

from __future__ import annotations

import json
import pathlib

import numpy as np
import pandas as pd
import pytest
import zerocount as zc
from support import by_program

SAME = ["status", "measure", "direction", "since", "alarm_at", "moves", "evidence"]


def times(seed: int, moves: int, factor: float = 1.0) -> list[float]:
    """Settling times, s."""
    return list(0.05 * factor * np.exp(0.2 * np.random.default_rng(seed).standard_normal(moves)))


def test_updates_give_the_answer_of_the_whole_log(tmp_path: pathlib.Path) -> None:
    before = pd.DataFrame({"arrival_time": times(1, 100), "overshoot": np.arange(100) % 3})
    moves = pd.DataFrame({"arrival_time": times(2, 30) + times(3, 60, 1.5), "overshoot": np.arange(90) % 3})
    moves.loc[5, "arrival_time"] = np.nan
    before.to_csv(tmp_path / "before.csv", index=False)
    moves.to_csv(tmp_path / "moves.csv", index=False)
    watch = zc.monitor(before)
    assert watch.update(moves[:20]).status == "undecided"
    assert watch.update(moves[20:30].to_dict("records")).moves == 30
    answer = watch.update(moves[30:][["overshoot", "arrival_time"]])
    by_hand = json.loads(by_program("monitor", tmp_path / "before.csv", tmp_path / "moves.csv", "--format", "json", accepted=(1,)))
    assert [answer[key] for key in SAME] == [by_hand[key] for key in SAME]
    assert (answer.status, answer.direction) == ("changed", "higher")
    assert zc.monitor(tmp_path / "before.csv", tmp_path / "moves.csv").alarm_at == answer.alarm_at
    assert zc.monitor(before, moves, alarm=1e-4).alarm_at > answer.alarm_at


@pytest.mark.long
def test_results_are_a_baseline(small: zc.Results) -> None:
    moves = {"arrival_time": [10.0, None, 10.0] * 5}
    answer = zc.monitor(small, moves, point=0)
    assert (answer.status, answer.direction) == ("changed", "higher")
    assert answer.baseline_moves == len(small.moves(0))


def test_moves_of_other_columns_are_refused() -> None:
    watch = zc.monitor({"arrival_time": times(1, 10)})
    watch.update({"arrival_time": 0.05})
    with pytest.raises(ValueError, match="expected arrival_time"):
        watch.update({"overshoot": 1})
    with pytest.raises(ValueError, match="different lengths"):
        zc.monitor({"arrival_time": [0.05, 0.06], "overshoot": [1]})
    with pytest.raises(zc.ManifestError, match="no measure to compare"):
        zc.monitor({"overshoot": [1, 2]}, {"arrival_time": [1.0]})


def test_measures_that_are_not_judged_are_named() -> None:
    """A column under another name is told from one that is not there."""
    before = {"arrival_time": times(1, 100), "overshoot": list(range(100)), "jerk_count": [0, 1] * 50}
    moves = {"arrival_time": times(2, 100), "Over_Shoot": list(range(100))}
    answer = zc.monitor(before, moves)
    missing = answer.not_judged[answer.not_judged.why == "missing"]
    assert list(missing.measure) == ["overshoot", "jerk_count"]
    assert list(missing.near)[0] == "Over_Shoot"
    with pytest.raises(zc.ManifestError, match="the column 'Arrival_Time' of .* looks like arrival_time"):
        zc.monitor(before, {"Arrival_Time": times(2, 10), "stable": [1] * 10})
    with pytest.raises(zc.ManifestError, match="'Arrival_Time' looks like arrival_time"):
        zc.monitor(before, {"Arrival_Time": times(2, 10)})


def test_refused_moves_are_not_added() -> None:
    watch = zc.monitor({"arrival_time": times(1, 10)})
    with pytest.raises(ValueError, match="no columns"):
        watch.update([])
    with pytest.raises(zc.DataError):
        watch.update({"arrival_time": [0.05, -1.0]})
    assert watch.update({"arrival_time": [0.05]}).moves == 1
    with pytest.raises(zc.DataError):
        watch.update({"arrival_time": "soon"})
    assert watch.update([]).moves == 1
    assert watch.update({"arrival_time": [pd.NA, None]}).moves == 3
