"""Gains that meet a goal."""

from __future__ import annotations

import dataclasses
import json
import math
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from . import program
from .options import dataclass_of, options
from .progress import progress_bar

if TYPE_CHECKING:
    from .results import Results
    from .studies import Study


@dataclasses.dataclass(frozen=True)
class Proof:
    """What trials on new machines show of tuned gains.

    Parameters
    ----------
    rate : float
        Proportion of moves that meet the goal.
    rate_low : float
        Its lower bound, at the confidence of the goal.
    machines_low : float or None
        Lower bound of the proportion of machines, if the goal is about machines.
    rigs, trials : int
        Machines and trials.
    criterion : float
        The minimised measure.
    """

    rate: float
    rate_low: float
    machines_low: float | None
    rigs: int
    trials: int
    criterion: float | None = None


@dataclasses.dataclass(frozen=True)
class Tuning:
    """Tuned gains.

    Parameters
    ----------
    status : str
        ``"met"``, ``"undecided"``, or ``"unreachable"`` within the ranges.
    gains : dict of str to float
        By dotted key; empty if the search found none.
    proof : Proof or None
        On machines that the search never saw; None if the search found nothing to prove.
    room : dict of str to list of float
        By dotted key, the range in which the value alone can change with the goal still met.
    margins : dict
        Gain (dB), phase (degrees) and delay (samples) margins, the least of the machines.
    delay_lost : float or None
        Delay of the loop at which the goal seems lost, samples.
    manifest : Study or None
        The study with the tuned gains.
    results : Results or None
        The results file of the proof.
    alternatives, frontier, limits : list of dict
        With free keys held at the values of ``fixed`` (an empty one: with an observer beside); the best found at
        each rate; what stands in the way: each with ``cause``, ``rate`` (None where it is not simulated) and ``note``.
    worst : dict or None
        The machine that the gains suit worst.
    searched : dict
        Points and trials of the search, and whether it converged.
    answer : dict
        The whole JSON of ``zerocount tune``; ``left_out`` of it names what the budget was not enough for,
        ``nearest`` the point that came nearest to the margins where none keeps them.
    """

    status: str
    gains: dict[str, float] = dataclasses.field(default_factory=dict)
    proof: Proof | None = None
    room: dict[str, list[float]] = dataclasses.field(default_factory=dict, repr=False)
    margins: dict[str, Any] = dataclasses.field(default_factory=dict, repr=False)
    delay_lost: float | None = dataclasses.field(default=None, repr=False)
    manifest: Study | None = dataclasses.field(default=None, repr=False)
    results: Results | None = dataclasses.field(default=None, repr=False)
    alternatives: list[dict[str, Any]] = dataclasses.field(default_factory=list, repr=False)
    frontier: list[dict[str, Any]] = dataclasses.field(default_factory=list, repr=False)
    limits: list[dict[str, Any]] = dataclasses.field(default_factory=list, repr=False)
    worst: dict[str, Any] | None = dataclasses.field(default=None, repr=False)
    searched: dict[str, Any] = dataclasses.field(default_factory=dict, repr=False)
    answer: dict[str, Any] = dataclasses.field(default_factory=dict, repr=False)


def tune(
    manifest: Any,
    output: str | os.PathLike[str],
    *,
    goal: Mapping[str, Any] | None = None,
    free: Mapping[str, Any] | None = None,
    minimise: str | None = None,
    margins: Mapping[str, float] | None = None,
    budget: int | str | None = None,
    threads: int | None = None,
    report: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: bool = True,
) -> Tuning:
    """Find values of free parameters that meet a goal, and prove them on new machines.

    Parameters
    ----------
    manifest : Study, path or dict
        The axis. A sweep in it is left out. A swept key that is free then has the middle of its range, until
        the search finds another value.
    output : path
        The results file of the proof. The same call continues an interrupted search.
    goal : dict, optional
        As the key ``goal`` of a manifest: ``{"band": 1, "within": 0.05, "moves": 0.99}``, s and counts. Default:
        that of the manifest.
    free : dict, optional
        Ranges by dotted key: ``{"controller.kp": [0, 1000], "controller.ki": {"log": [5e3, 3e5]}}``, in the
        manifest's units. Default: that of the manifest.
    minimise : str, optional
        The criterion, such as ``"band_settling_time.p95"``.
    margins : dict, optional
        Least margins ``gain`` (dB), ``phase`` (degrees) and ``delay`` (samples).
    budget : int or str, optional
        Of the search, the proof and all else: a number of trials, or a time such as ``"60s"``.
    threads : int, optional
        Default: all cores.
    report : path, optional
        Write an HTML page there.
    force : bool
        Replace other outputs.
    progress : bool
        Show the progress in a terminal or a notebook.

    Returns
    -------
    Tuning

    Raises
    ------
    ManifestError
        If the manifest has neither goal nor free parameters.

    Examples
    --------
    >>> free = {"controller.ki": {"log": [5e3, 5e4]}}
    >>> tuned = zc.tune("my-axis.yaml", "tuned.h5", free=free, margins={"gain": 1, "phase": 10}, budget=20000)
    >>> tuned.status
    'met'
    >>> tuned.manifest
    <Study 'my-axis': 1 design point × 4032 trials>
    """
    from .results import Results
    from .studies import study

    subject = _without_sweep(study(manifest), free)
    settings = {"goal": goal, "tune.free": free, "tune.minimise": minimise, "tune.margins": margins}
    subject = subject.set({key: value for key, value in settings.items() if value is not None})
    target = os.path.abspath(output)
    with progress_bar("tune", progress) as bar:
        text = subject.command(
            "tune",
            *options(
                output=target,
                format="json",
                budget=budget,
                threads=threads,
                report=None if report is None else os.path.abspath(report),
                force=force,
            ),
            accepted=program.VERDICTS,
            progress=bar,
        )
    answer = json.loads(text)
    results = Results(target) if answer.get("proof") else None
    return dataclass_of(
        Tuning,
        answer,
        proof=dataclass_of(Proof, answer["proof"]) if answer.get("proof") else None,
        results=results,
        manifest=results.study if results else None,
        answer=answer,
    )


def _without_sweep(subject: Study, free: Mapping[str, Any] | None) -> Study:
    """The study at one point; the swept keys that are free in the middle of their ranges."""
    tree = subject.to_dict()
    if "sweep" not in tree:
        return subject
    ranges = free if free is not None else (tree.get("tune") or {}).get("free") or {}
    swept = (tree["sweep"] or {}).get("grid") or {}
    middles = {key: middle for key in swept if key in ranges and (middle := _middle(ranges[key])) is not None}
    return subject.without("sweep", "observed").set(middles)


def _middle(searched: Any) -> float | None:
    """The middle of a range of the key ``tune.free``; None of what is no range, which the program refuses."""
    try:
        if isinstance(searched, Mapping):
            low, high = map(float, searched["log"])
            return math.sqrt(low * high)
        low, high = map(float, searched)
    except (KeyError, TypeError, ValueError):
        return None
    return (low + high) / 2
