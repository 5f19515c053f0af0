"""Friction from records."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from .answer_types import IdentifyAnswer, IdentifyLawsAnswer, IdentifySlidingAnswer
from .answers import Answer
from .asking import ask
from .checked import manifest_tree
from .optional import required

if TYPE_CHECKING:
    import pandas  # type: ignore[import]


class Identified(Answer):
    """What was identified from records."""

    @property
    def passed(self) -> bool | None:
        """Whether encoder and noise explain the residuals; otherwise the result must not be trusted. None where the answer
        does not tell it of one model."""
        residuals = self.get("residuals")
        return bool(residuals["passed"]) if residuals else None

    @property
    def settings(self) -> dict[str, Any]:
        """The manifest as dotted keys: ``study.set(identified.settings)``."""
        sections = manifest_tree(self["manifest"], "<identified>", []) or {}
        return {
            f"{section}.{key}": value
            for section, keys in sections.items()
            if isinstance(keys, Mapping)
            for key, value in keys.items()
        }

    @property
    def table(self) -> pandas.DataFrame:
        """The parameters, one row each, by their names; of several laws those of the best."""
        parameters = self["parameters"] if "parameters" in self else self["laws"][0]["parameters"]
        return required("pandas", "the table of parameters").DataFrame(parameters).set_index("name")


class Identification(Identified, IdentifyAnswer):
    """Friction, damping and inertia from material tests."""


class LawIdentification(Identified, IdentifyLawsAnswer):
    """Friction laws that were compared on the same records."""


class SlidingIdentification(Identified, IdentifySlidingAnswer):
    """Inertia and friction from sliding motion."""


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
    pitch: float | None = None,
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
) -> Identification | LawIdentification | SlidingIdentification:
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
    pitch : float, optional
        Of the screw or of the magnets of a linear axis, m, with ``sliding``.
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
    Identification, or LawIdentification or SlidingIdentification
        The others of several laws, and of sliding.

    Raises
    ------
    DataError
        If the records are unsuitable; the message says why.
    ManifestError
        If they are no such tables; with file and line.

    Examples
    --------
    >>> found = zc.identify("identification.h5", point="steps")
    >>> found.settings["friction.k1"]["lognormal"]["median"]
    126.5187
    """
    answer = ask(
        "identify",
        *records,
        progress=progress,
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
        pitch=pitch,
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
    )
    if isinstance(answer, IdentifyLawsAnswer):
        return LawIdentification.of(answer)
    if isinstance(answer, IdentifySlidingAnswer):
        return SlidingIdentification.of(answer)
    return Identification.of(answer)
