"""Columns of the trials and moves of a results file."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .checked import CheckedStudy
from .datasets import Array, Column, ResultsDatasets
from .tables import combined, succeeded, worst


@dataclasses.dataclass(frozen=True, eq=False)
class TrialColumns:
    """Columns of the trials and moves of a results file, by their full names.

    Parameters
    ----------
    file : ResultsDatasets
        The file, whose checksum was compared.
    study : CheckedStudy
        The study as its trials were run.
    """

    file: ResultsDatasets
    study: CheckedStudy

    def inputs(self, rows: slice | None) -> dict[str, Column]:
        """[trial] what is known before trials are run: trial, point, index, machine, world, condition and inputs."""
        columns = self.file.group("trial", rows)
        columns.update(self.shared(columns["index"].values))
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
            limits: Mapping[str, Sequence[float]] = {"band": self.study.bands, "tolerance": self.study.tolerances}
            if column.dimensions[-1] not in limits:
                result[name] = column
                continue
            for place, limit in enumerate(limits[column.dimensions[-1]]):
                values = column.values[..., place]
                result[f"{name}[{limit}]"] = dataclasses.replace(column, values=values, dimensions=column.dimensions[:-1])
        return result

    def meets(self, outcome: Mapping[str, Column]) -> dict[str, Column]:
        """[trial, move] whether each move meets the goals of the manifest that are about it, if there are any."""
        if not self.study.goals:
            return {}
        of_goals = [met for goal in self.study.goals if (met := self.meets_goal(goal, outcome)) is not None]
        if len(of_goals) < len(self.study.goals):
            return {}
        values = np.logical_and.reduce(of_goals)
        like = outcome[self.study.goals[0]["measure"]]
        meaning = "it meets the goal of the manifest" if len(of_goals) == 1 else "it meets the goals about it"
        return {"goal_met": dataclasses.replace(like, values=values, unit="1", meaning=meaning)}

    def meets_goal(self, goal: Mapping[str, Any], outcome: Mapping[str, Column]) -> Array | None:
        """[trial, move] whether each move meets a goal, or it is not about the move; None where it cannot be told."""
        times = outcome.get(goal["measure"])
        after = goal["after_profile"]
        needed = [*goal["limits"], *(["travel_time"] if after is not None else [])]
        if times is None or any(measure not in outcome for measure in needed):
            return None
        allowed = goal["within"] if after is None else outcome["travel_time"].values + after
        met: Array = times.values <= allowed * goal["rounding"]  # not where it is NaN
        for measure, largest in goal["limits"].items():
            met &= np.abs(outcome[measure].values.astype(float)) <= largest
        if goal["on"]:
            met[:, [move for move in range(met.shape[1]) if move not in goal["on"]]] = True
        return met

    def of_trials(self, columns: Mapping[str, Column]) -> dict[str, Column]:
        """[trial] from [trial, move]."""
        outcome = columns["outcome"]
        codes, words = outcome.values, outcome.words
        result = {
            "success": Column(succeeded(codes, words), ("trial",), "1", "all moves ended at zero counts"),
            "outcome": Column(worst(codes, words, self.study.severity), ("trial",), "1", "outcome of the worst move", words),
        }
        rules = {name: described["of_trial"] for name, described in self.study.descriptions["outcome"].items()}
        for name, column in columns.items():
            rule = "all" if name == "goal_met" else rules.get(name)
            if column.dimensions == ("trial", "move") and name != "outcome" and rule is not None:
                values = combined(column.values, rule)
                result[name] = dataclasses.replace(column, values=values, dimensions=("trial",), words=[])
        return result

    def shared(self, index: Array) -> dict[str, Column]:
        """[trial] what a trial shares with others: its machine, its world, its condition and its age.

        Trial i runs on machine i mod R, under condition i div R mod C, at age i div RC mod A, with the draws of
        i mod R + R * (i div RCA).
        """
        machines, conditions, ages = max(self.study.machines, 1), self.study.condition_names, self.study.ages
        of_age = machines * max(len(conditions), 1)
        draw = index % machines + machines * (index // (of_age * max(len(ages), 1)))
        columns = {}
        if self.study.machines > 0:
            columns["machine"] = Column(index % machines, ("trial",), "1", "index of the machine of the trial")
        if self.study.worlds > 0:
            columns["world"] = Column(draw % self.study.worlds, ("trial",), "1", "index of the world")
        if conditions:
            number = index // machines % len(conditions)
            columns["condition"] = Column(number, ("trial",), "1", "what the machine bears", conditions)
        if ages:
            age = np.array(ages)[index // of_age % len(ages)]
            columns["age"] = Column(age, ("trial",), self.study.age_unit, "age of the machine")
        return columns


def flat(columns: Mapping[str, Column], dimensions: tuple[str, ...]) -> dict[str, Column]:
    """The columns with these dimensions as columns with one."""
    return {
        name: dataclasses.replace(column, values=column.values.reshape(-1))
        for name, column in columns.items()
        if column.dimensions == dimensions
    }
