"""Friction from records."""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import _zerocount

from . import program
from .optional import required
from .options import dataclass_of, options
from .progress import progress_bar

if TYPE_CHECKING:
    import pandas  # type: ignore[import]


@dataclasses.dataclass(frozen=True)
class Identification:
    """Friction that was identified from records.

    Parameters
    ----------
    parameters : list of dict
        ``name``, ``key`` (in a manifest, or None), ``unit``, ``status``, ``value``, ``low`` and ``high`` (95 %) of each.
    manifest : dict
        What to put into a manifest: the sections and keys with their distributions.
    text : str
        The same as YAML with comments.
    passed : bool or None
        Whether encoder and noise explain the residuals; otherwise the result must not be trusted. None where several
        laws are compared: `answer` has each.
    residuals : dict
        The tests of the residuals.
    records : list of dict
        What was read.
    answer : dict
        The whole JSON of ``zerocount identify``.
    """

    parameters: list[dict[str, Any]]
    manifest: dict[str, Any]
    text: str
    passed: bool | None
    residuals: dict[str, Any] = dataclasses.field(default_factory=dict, repr=False)
    records: list[dict[str, Any]] = dataclasses.field(default_factory=list, repr=False)
    answer: dict[str, Any] = dataclasses.field(default_factory=dict, repr=False)

    @property
    def settings(self) -> dict[str, Any]:
        """The same as dotted keys: ``study.set(identified.settings)``."""
        return {f"{section}.{key}": value for section, keys in self.manifest.items() for key, value in keys.items()}

    @property
    def table(self) -> pandas.DataFrame:
        """The parameters, one row each, by their names."""
        return required("pandas", "the table of parameters").DataFrame(self.parameters).set_index("name")


def identify(
    *records: str | os.PathLike[str],
    axis: str | None = None,
    counts_per_revolution: float | None = None,
    resolution: float | None = None,
    column: Mapping[str, str] | None = None,
    separator: str | None = None,
    sample_time: float | None = None,
    exclude: Sequence[str] | None = None,
    model: str | Sequence[str] | None = None,
    series_compliance: bool = False,
    sliding: bool = False,
    amplifier_bandwidth: float | None = None,
    delay: float | None = None,
    dac_bits: int | None = None,
    preload: float | None = None,
    hardening: float | None = None,
    fix: Mapping[str, float] | None = None,
    effort: float | None = None,
    any_magnitude: bool = False,
    posterior: str | os.PathLike[str] | None = None,
    draws: int | None = None,
    plot: str | os.PathLike[str] | None = None,
    point: int | str | Sequence[int | str] | None = None,
    force: bool = False,
    progress: bool = True,
) -> Identification:
    """Identify friction, damping and inertia from records.

    Parameters
    ----------
    *records : path
        Tables of time, torque and angle (CSV), or a results file with traces.
    axis : str, optional
        ``"rotary"`` (default) or ``"linear"``.
    counts_per_revolution : float, optional
        Resolution of the encoder, for an angle in counts.
    resolution : float, optional
        Size of a count, m (rad on a rotary axis).
    column : dict, optional
        Columns by quantity: ``{"time": "t[ms]", "torque": "current[A]*0.87"}``.
    separator : str, optional
        ``"comma"``, ``"semicolon"``, ``"tab"`` or ``"blanks"``.
    sample_time : float, optional
        Of a record without times, s.
    exclude : list of str, optional
        Times to leave out, ``"FROM:TO"``, s.
    model : str or list of str, optional
        Friction law to fit, or several, or ``"all"``.
    series_compliance : bool
        Fit the compliance of a fixture, too.
    sliding : bool
        The records are of motion with sliding.
    amplifier_bandwidth : float, optional
        Hz.
    delay : float, optional
        Of the torque, samples.
    dac_bits : int, optional
        Word length of the converter.
    preload : float, optional
        Of a load and unload before the test, N m or N.
    hardening : float, optional
        Before the test, rad or m.
    fix : dict, optional
        Known parameters: ``{"friction.n": 2}``.
    effort : float, optional
        Time for other starting points; 1 is about 20 s.
    any_magnitude : bool
        Accept values that suggest other units.
    posterior : path, optional
        Write joint draws there.
    draws : int, optional
        Number of joint draws.
    plot : path, optional
        Draw the fit there: ``.html``, ``.svg`` or ``.png``.
    point : int, str or list, optional
        Design points of a results file.
    force : bool
        Replace outputs.
    progress : bool
        Show the progress.

    Returns
    -------
    Identification

    Raises
    ------
    DataError
        If the records are unsuitable; the message says why.
    ManifestError
        If they are no such tables; with file and line.

    Examples
    --------
    >>> found = zc.identify("identification.h5")
    >>> found.settings["friction.k1"]["lognormal"]["median"]
    126.476502
    """
    words = options(
        axis=axis,
        counts_per_revolution=counts_per_revolution,
        resolution=resolution,
        column=column,
        separator=separator,
        sample_time=sample_time,
        exclude=exclude,
        model=model,
        series_compliance=series_compliance,
        sliding=sliding,
        amplifier_bandwidth=amplifier_bandwidth,
        delay=delay,
        dac_bits=dac_bits,
        preload=preload,
        hardening=hardening,
        fix=fix,
        effort=effort,
        any_magnitude=any_magnitude,
        posterior=posterior,
        draws=draws,
        plot=plot,
        point=point,
        force=force,
        format="json",
    )
    with progress_bar("identify", progress) as bar:
        _, text = program.run(
            ["identify", *(os.fspath(record) for record in records), *words], accepted=frozenset({0, 3}), progress=bar
        )
    answer = json.loads(text)
    return dataclass_of(
        Identification,
        answer,
        parameters=answer["parameters"] if "parameters" in answer else _best_law(answer)["parameters"],
        manifest=_zerocount.manifest_tree(answer["manifest"], "<identified>", []) or {},
        text=answer["manifest"],
        passed=answer["residuals"]["passed"] if "residuals" in answer else None,
        answer=answer,
    )


def _best_law(answer: Mapping[str, Any]) -> Mapping[str, Any]:
    """Of the laws that were compared the one with the lowest BIC."""
    fitted = [law for law in answer["laws"] if law.get("bic_above_least") is not None]
    best: Mapping[str, Any] = min(fitted, key=lambda law: float(law["bic_above_least"]))
    return best
