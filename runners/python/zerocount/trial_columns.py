"""Columns of the trials and moves of a results file."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np

import _zerocount

from .datasets import Array, Column, ResultsDatasets
from .tables import combined, succeeded, worst


@dataclasses.dataclass(frozen=True, eq=False)
class TrialColumns:
    """Columns of the trials and moves of a results file, by their full names.

    Parameters
    ----------
    file : ResultsDatasets
        The file, whose checksum was compared.
    study : _zerocount.Study
        The study as its trials were run.
    """

    file: ResultsDatasets
    study: _zerocount.Study

    def inputs(self, rows: slice | None) -> dict[str, Column]:
        """[trial] what is known before trials are run: trial, point, index, rig, world and inputs."""
        columns = self.file.group("trial", rows)
        columns.update(self._shared(columns["index"].values))
        columns.update(self.file.group("trial/input", rows))
        return columns

    def trials(self, rows: slice | None) -> dict[str, Column]:
        """[trial] inputs, and outcomes and measures of the moves, combined."""
        outcome = self.by_band(self.file.group("outcome", rows))
        return {**self.inputs(rows), **self.of_trials({**outcome, **self.meets(outcome)})}

    def moves(self, rows: slice | None) -> tuple[Array, Array, dict[str, Column]]:
        """Trials, moves, and [trial * move] outcomes and measures."""
        columns = self.by_band(self.file.group("outcome", rows))
        trial, move = columns.pop("trial").values, columns.pop("move").values
        columns.update(self.meets(columns))
        return trial, move, flat(columns, ("trial", "move"))

    def repeated_inputs(self, rows: slice | None, moves: int) -> dict[str, Column]:
        """[trial * move] the inputs, without the trial."""
        columns = self.inputs(rows)
        columns.pop("trial")
        return {
            name: dataclasses.replace(column, values=np.repeat(column.values, moves)) for name, column in columns.items()
        }

    def by_band(self, columns: Mapping[str, Column]) -> dict[str, Column]:
        """The columns, those with a dimension of error bands as one column for each of them."""
        result = {}
        for name, column in columns.items():
            if column.dimensions[-1] != "band":
                result[name] = column
                continue
            for place, band in enumerate(self.study.bands):
                values = column.values[..., place]
                result[f"{name}[{band}]"] = dataclasses.replace(column, values=values, dimensions=column.dimensions[:-1])
        return result

    def meets(self, outcome: Mapping[str, Column]) -> dict[str, Column]:
        """[trial, move] whether each move meets the goal of the manifest, if there is one."""
        goal = self.study.goal
        times = outcome.get(f"band_settling_time[{goal['band']}]") if goal is not None else None
        if goal is None or times is None:
            return {}
        met = times.values <= goal["latest"]  # not where it is NaN
        return {"goal_met": dataclasses.replace(times, values=met, unit="1", meaning="it meets the goal of the manifest")}

    def of_trials(self, columns: Mapping[str, Column]) -> dict[str, Column]:
        """[trial] from [trial, move]."""
        outcome = columns["outcome"]
        codes, words = outcome.values, outcome.words
        result = {
            "success": Column(succeeded(codes, words), ("trial",), "1", "all moves ended at zero counts"),
            "outcome": Column(worst(codes, words), ("trial",), "1", "outcome of the worst move", words),
        }
        rules = {name: described["of_trial"] for name, described in self.study.descriptions["outcome"].items()}
        for name, column in columns.items():
            rule = "all" if name == "goal_met" else rules.get(name)
            if column.dimensions == ("trial", "move") and name != "outcome" and rule is not None:
                values = combined(column.values, rule)
                result[name] = dataclasses.replace(column, values=values, dimensions=("trial",), words=[])
        return result

    def _shared(self, index: Array) -> dict[str, Column]:
        """[trial] what a trial shares with others: its rig and its world."""
        counts = {
            "rig": (self.study.rigs, "index of the rig, the machine of the trial"),
            "world": (self.study.worlds, "index of the world"),
        }
        return {
            name: Column(index % count, ("trial",), "1", meaning) for name, (count, meaning) in counts.items() if count > 0
        }


def flat(columns: Mapping[str, Column], dimensions: tuple[str, ...]) -> dict[str, Column]:
    """The columns with these dimensions as columns with one."""
    return {
        name: dataclasses.replace(column, values=column.values.reshape(-1))
        for name, column in columns.items()
        if column.dimensions == dimensions
    }
