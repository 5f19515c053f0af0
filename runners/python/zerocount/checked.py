"""Studies that were checked: what is known of them, and their trials in this process."""

from __future__ import annotations

import dataclasses
import json
import math
import os
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import library, program
from .datasets import Array
from .loop import ControlLaw


@dataclasses.dataclass(frozen=True, eq=False)
class CheckedStudy:
    """A study that was checked, as ``zerocount_describe_study`` describes it.

    Parameters
    ----------
    name, description : str
        Of the manifest.
    seed, trials, machines, worlds, moves : int
        ``machines`` is 0 where each trial has a machine of its own, ``worlds`` where nothing is drawn for a world.
    conditions, condition_names : list of str
        Those that every machine bears in turn, with ages each condition at each age; those of the manifest.
    ages : list of float
        In ``age_unit``.
    labels : list of str
        Of the design points.
    sha256 : str
        Of all that determines the trials.
    warnings : list of str
        What may not be as intended.
    observed : dict of str to str
        What was observed on a real axis, by the label of the design point.
    linear : bool
        Whether it is a linear axis.
    axes, inputs : list of dict
        What is swept, with its ``values`` by point, and what differs between trials: ``name``, ``unit``, ``meaning``.
    bands, tolerances : list
        Limits of the error, counts, and of the position error, rad or m.
    goals : list of dict
        Goals of the manifest.
    severity : list of str
        The outcomes of a move from best to worst.
    descriptions : dict
        Of the columns of ``samples`` and of the measures in ``outcome``: ``unit``, ``meaning``, ``flags`` (the words of
        an enumeration by number), ``type`` and ``of_trial``, how the values of moves are combined.
    """

    name: str
    description: str
    seed: int
    trials: int
    machines: int
    worlds: int
    conditions: list[str]
    condition_names: list[str]
    ages: list[float]
    age_unit: str
    moves: int
    labels: list[str]
    sha256: str
    warnings: list[str]
    observed: dict[str, str]
    linear: bool
    axes: list[dict[str, Any]]
    inputs: list[dict[str, str]]
    bands: list[int]
    tolerances: list[float]
    goals: list[dict[str, Any]]
    severity: list[str]
    descriptions: dict[str, dict[str, dict[str, Any]]]
    _handle: library.Handle | None = dataclasses.field(default=None, repr=False)

    @property
    def goal(self) -> dict[str, Any] | None:
        """The only goal; None where there is none, or several."""
        return self.goals[0] if len(self.goals) == 1 else None

    @property
    def _study(self) -> library.Handle:
        """The study for the library, which is then loaded."""
        library.required()
        assert self._handle is not None
        return self._handle

    def under(self, condition: str) -> CheckedStudy:
        """The study under one of its conditions."""
        study = self._study
        return _described(library.required().study("study_under", study, condition.encode()))

    def variables(self, point: int) -> dict[str, Any]:
        """The random variables of a design point: ``names``, ``kinds``, ``units``, ``distributions``, ``correlations``."""
        study = self._study
        known: dict[str, Any] = json.loads(library.required().text("describe_variables", study, point))
        for form in known["distributions"]:
            form.update({kind: tuple(given) for kind, given in form.items() if isinstance(given, list) and kind != "choice"})
        known["correlations"] = np.array(known["correlations"], dtype=float).reshape(2 * (len(known["names"]),))
        return known

    def values_at_scores(self, point: int, scores: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """``[trial, variable]`` values at standard normal scores, to which the correlations were applied."""
        study, values = self._study, np.array(scores, dtype=np.float64, order="C")
        library.required().call("values_at_scores", study, point, len(values), values.ctypes.data)
        return values

    def simulate(self, point: int, x: npt.ArrayLike, numbers: npt.ArrayLike, threads: int) -> dict[str, Array]:
        """``[trial, move]`` measures of trials with these values ``[trial, variable]`` and numbers ``[trial]``."""
        values, trials = np.ascontiguousarray(x, dtype=np.float64), np.ascontiguousarray(numbers, dtype=np.int64)
        measures = library.required().outcomes(self._study, point, values, trials, threads)
        return {name: found.reshape(len(trials), self.moves) for name, found in measures.items()}

    def trace(self, point: int, trial: int, law: ControlLaw | None = None) -> dict[str, Any]:
        """A trial: ``inputs``, and the columns of its ``samples``, ``jerks`` and ``outcome``."""
        columns = library.required().trial(self._study, point, trial, law)
        record: dict[str, Any] = {"inputs": columns.pop("inputs").tolist(), "samples": {}, "jerks": {}, "outcome": {}}
        for name, values in columns.items():
            group, _, column = name.partition("/")
            record[group][column] = values
        return record


def checked_study(text: str, source: str, folder: str | os.PathLike[str], overrides: Sequence[str]) -> CheckedStudy:
    """The study of a manifest.

    Parameters
    ----------
    text : str
        The manifest.
    source : str
        Its name in messages.
    folder : path
        From which the files that it names are found.
    overrides : sequence of str
        Settings, ``key=value``.

    Raises
    ------
    ManifestError
        If the manifest with the settings is wrong.
    """
    if (loaded := library.loaded()) is None:
        return _known(program.run(["--describe", "study", source, folder, *overrides], text=text)[1])
    encoded, others = library.text_arguments(text), library.override_arguments(overrides)
    return _described(loaded.study("read_study", *encoded, os.fsencode(source), os.fsencode(folder), *others))


def recorded_study(file: str | os.PathLike[str]) -> CheckedStudy:
    """The study of a results file, as its trials were run."""
    if (loaded := library.loaded()) is None:
        return _known(program.run(["--describe", "file", file])[1])
    return _described(loaded.study("open_study", os.fsencode(file)))


def manifest_tree(text: str, source: str, overrides: Sequence[str]) -> dict[str, Any]:
    """A manifest with settings as a dict. It is not checked.

    Parameters
    ----------
    text : str
        The manifest.
    source : str
        Its name in messages.
    overrides : sequence of str
        Settings, ``key=value``.
    """
    if (loaded := library.loaded()) is None:
        described = program.run(["--describe", "manifest", source, *overrides], text=text)[1]
    else:
        encoded, others = library.text_arguments(text), library.override_arguments(overrides)
        described = loaded.text("describe_manifest", *encoded, os.fsencode(source), *others)
    tree: dict[str, Any] = json.loads(described)
    return tree


def _described(handle: library.Handle) -> CheckedStudy:
    """A study of the library."""
    return _known(library.required().text("describe_study", handle), handle)


def _known(description: str, handle: library.Handle | None = None) -> CheckedStudy:
    """What a description says."""
    facts = json.loads(description)
    for axis in facts["axes"]:
        axis["values"] = [math.nan if value is None else value for value in axis["values"]]
    for columns in facts["descriptions"].values():
        for column in columns.values():
            column["flags"] = dict(column["flags"])
            column["type"] = np.dtype(column["type"])
    return CheckedStudy(**facts, _handle=handle)
