"""Gains that meet a goal."""

from __future__ import annotations

import functools
import math
import os
import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .answer_types import TuneAnswer
from .asking import ask
from .answers import Answer

if TYPE_CHECKING:
    from .results import Results
    from .studies import Study


class Tuning(TuneAnswer):
    """Tuned gains."""

    _output: str

    @functools.cached_property
    def results(self) -> Results | None:
        """The results file of the proof; None if the search found nothing to prove."""
        from .results import Results

        return Results(self._output) if self["proof"] else None

    @property
    def manifest(self) -> Study | None:
        """The study with the tuned gains."""
        return self.results.study if self.results else None


def tune(
    manifest: Study | str | os.PathLike[str] | Mapping[str, Any],
    output: str | os.PathLike[str],
    *,
    goal: Mapping[str, Any] | None = None,
    free: Mapping[str, Any] | None = None,
    minimise: str | None = None,
    margins: Mapping[str, Any] | str | None = None,
    budget: float | str | None = None,
    extras: str | None = None,
    threads: int | None = None,
    report: str | os.PathLike[str] | None = None,
    watch: str | os.PathLike[str] | None = None,
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
    margins : dict or "off", optional
        Least margins ``gain`` (dB), ``phase`` (degrees) and ``delay`` (samples), the largest ``sensitivity``, and
        the ``spread`` of the machines that keep them, such as ``{"gain": 1, "phase": 10, "spread": "off"}``.
    budget : int or str, optional
        Of the search, the proof and the extras: a number of trials, or a time such as ``"60s"``.
    extras : str, optional
        What follows the proof: ``"none"``, ``"all"`` (default) or some of
        ``"margins,ages,room,robustness,controls,limits,maps"`` (ages of a study with ages, maps on a page).
    threads : int, optional
        Default: all cores.
    report : path, optional
        Write an HTML page there.
    watch : path, optional
        The same page from the beginning, for a browser that shows how far the tuning is.
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
    >>> tuned = zc.tune("my-axis.yaml", "tuned.h5", free=free, margins="off", budget=10000)
    >>> tuned.status
    'met'
    >>> tuned.manifest
    <Study 'my-axis': 1 design point × 500 trials>
    """
    from .studies import study

    subject = _without_sweep(study(manifest), free)
    settings = {"goal": goal, "tune.free": free, "tune.minimise": minimise, "tune.margins": margins}
    subject = subject.set({key: value for key, value in settings.items() if value is not None})
    target = os.path.abspath(output)
    tuning = Tuning.of(
        ask(
            "tune",
            subject,
            progress=progress,
            output=target,
            budget=budget,
            extras=extras,
            threads=threads,
            report=None if report is None else pathlib.Path(report),
            watch=None if watch is None else pathlib.Path(watch),
            force=force,
        )
    )
    tuning._output = target
    return tuning


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
