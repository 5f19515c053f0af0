"""One trial, sample by sample."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .checked import CheckedStudy
from .datasets import Array
from .optional import required

if TYPE_CHECKING:
    import matplotlib.figure  # type: ignore[import]
    import pandas  # type: ignore[import]


@dataclasses.dataclass(frozen=True, eq=False)
class Trace:
    """A trial, sample by sample.

    Parameters
    ----------
    title : str
        Study, design point and trial.
    samples : dict of str to numpy.ndarray
        ``[sample]`` values at the sampling instants: ``t`` (s), ``target``, ``count``, ``error`` (counts),
        ``code``, ``torque`` (N m), ``theta`` (rad), ``omega`` (rad/s) and others; `units` tells the units.
    inputs : dict of str to float
        What was drawn for the trial, by dotted key.
    outcome : dict of str to numpy.ndarray
        ``[move]`` measures of the moves.
    units : dict of str to str
        Of the samples.
    bands : list of int
        Error bands that are shown, counts.
    """

    title: str
    samples: dict[str, Array]
    inputs: dict[str, float]
    outcome: dict[str, Array]
    units: dict[str, str]
    bands: list[int]

    def __repr__(self) -> str:
        outcomes = list(map(str, self.outcome["outcome"]))
        if len(outcomes) > 4:
            outcomes = [f"{outcomes.count(word)} {word}" for word in dict.fromkeys(outcomes)]
        return f"<Trace of {self.title}: {len(self.t)} samples, {' '.join(outcomes)}>"

    @property
    def t(self) -> Array:
        """Time, s."""
        return self.samples["t"]

    @property
    def error(self) -> Array:
        """Target less count, counts."""
        return self.samples["error"]

    @property
    def torque(self) -> Array:
        """Torque that was decided, N m; a force in N on a linear axis."""
        return self.samples["torque"]

    @property
    def frame(self) -> pandas.DataFrame:
        """The samples as a DataFrame, indexed by time."""
        pandas = required("pandas", "the frame of a trace")
        table = pandas.DataFrame({name: values for name, values in self.samples.items() if name != "t"}, index=self.t)
        table.index.name = "t"
        table.attrs["units"] = self.units
        return table

    def plot(self) -> matplotlib.figure.Figure:
        """Error and torque over time, with the error bands.

        Returns
        -------
        matplotlib.figure.Figure
            The upper axes show the error (counts), on a linear scale within the widest band and two counts and
            on a logarithmic one beyond; the lower ones the torque.

        Examples
        --------
        >>> figure = zc.open("my-axis.h5").trace(2, 17).plot()
        >>> [axes.get_ylabel() for axes in figure.axes]
        ['error (counts)', 'torque (N m)']
        """
        pyplot = required("matplotlib.pyplot", "the plot of a trace")
        picture, (upper, lower) = pyplot.subplots(2, sharex=True, figsize=(7, 4.5), layout="constrained")
        for band in self.bands:
            if band > 0:
                upper.axhspan(-band - 0.5, band + 0.5, alpha=0.15, label=f"±{band} counts" if band > 1 else "±1 count")
        upper.step(self.t, self.error, where="post", linewidth=1.0)
        upper.set_yscale("symlog", linthresh=max([2, *self.bands]))
        upper.set_ylabel("error (counts)")
        upper.set_title(self.title, fontsize="medium")
        if any(band > 0 for band in self.bands):
            upper.legend(loc="upper right", fontsize="small")
        lower.step(self.t, self.torque, where="post", linewidth=1.0)
        lower.set_ylabel(f"{'force' if self.units['torque'] == 'N' else 'torque'} ({self.units['torque']})")
        lower.set_xlabel("time (s)")
        pyplot.close(picture)  # a notebook shows what is returned, and not twice
        return picture


def replayed(text: str, study: CheckedStudy, point: int) -> Trace:
    """A trace from what ``zerocount trace --format json`` gives."""
    record = json.loads(text, parse_int=float)  # -0 is a number, too
    rows, moves, described = record["samples"], record["outcome"], study.descriptions
    return _trace(
        study,
        point,
        int(record["trial"]),
        {name: _array([row[name] for row in rows], described["samples"][name]) for name in rows[0]} if rows else {},
        record["inputs"],
        {name: _array([move[name] for move in moves], described["outcome"][name]) for name in moves[0]},
    )


def simulated(study: CheckedStudy, point: int, trial: int, law: Any) -> Trace:
    """A trial that is run in this process. ``law`` is a control law in Python, or None."""
    record = study.trace(point, trial, law)
    described = study.descriptions
    samples = {
        name: _in_words(values, described["samples"][name]["flags"])
        for name, values in record["samples"].items()
        if name != "trial"
    }
    outcome = {
        name: _in_words(values, described["outcome"][name]["flags"]) for name, values in record["outcome"].items()
    }
    inputs = dict(zip((column["name"] for column in study.inputs), record["inputs"]))
    return _trace(study, point, trial, samples, inputs, outcome)


def _trace(
    study: CheckedStudy,
    point: int,
    trial: int,
    samples: dict[str, Array],
    inputs: dict[str, float],
    outcome: dict[str, Array],
) -> Trace:
    described = study.descriptions["samples"]
    title = f"{study.name}, {study.labels[point]}, trial {trial}" if study.labels[point] else f"{study.name}, trial {trial}"
    units = {name: described[name]["unit"] for name in samples}
    return Trace(title, samples, inputs, outcome, units, list(study.bands))


def _array(values: list[Any], description: Mapping[str, Any]) -> Array:
    """Values of JSON, where null is NaN, as the type of their column."""
    return np.array(values, dtype=object if description["flags"] else description["type"])


def _in_words(values: Array, words: Mapping[int, str]) -> Array:
    """The words of an enumeration."""
    return np.array([words[int(value)] for value in values], dtype=object) if words else values
