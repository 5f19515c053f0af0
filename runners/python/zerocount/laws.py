"""Control laws in Python."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .errors import ManifestError
from .loop import ControlLaw
from .traces import Trace, simulated

if TYPE_CHECKING:
    from .results import Results
    from .studies import Study


def trial(
    study: Study | Results | str | os.PathLike[str] | Mapping[str, Any],
    point: int | str = 0,
    trial: int = 0,
    controller: ControlLaw | None = None,
) -> Trace:
    """Run one trial in this process.

    Parameters
    ----------
    study : Study, Results, path or dict of a manifest
        Whose trial it is.
    point : int or str
        Number or label of the design point.
    trial : int
        Index of the trial at the point.
    controller : callable, optional
        A control law in place of the one of the manifest. It is called once with a `Setup` before the first
        sample, and returns a function that is called with a `Sample` at every sampling instant and returns the
        wanted torque (N m). Filters, feedforward and observer of the manifest act on that torque; the converter
        rounds and limits it. Torques that are not finite end the trial as ``nonfinite``.

    Returns
    -------
    Trace
        The same bits as the program gives.

    Raises
    ------
    ManifestError
        If the control of the study has two phases, which a law in Python cannot have.

    Examples
    --------
    An integral control with the trapezoidal rule:

    >>> def integral_control(setup):
    ...     gain = 11767.7 * setup.resolution * setup.sample_time / 2  # N m/count
    ...     integral = setup.initial_integral
    ...     before = 0.0
    ...     def torque(sample):
    ...         nonlocal integral, before
    ...         integral += gain * (sample.error + before)
    ...         before = sample.error
    ...         return integral
    ...     return torque
    >>> t = zc.trial(zc.study("my-axis.yaml"), point=2, trial=17, controller=integral_control)
    >>> t.error[-1]
    0
    """
    from .results import Results
    from .studies import point_number
    from .studies import study as study_of

    checked = study.checked if isinstance(study, Results) else study_of(study).checked
    number = point_number(point, checked.labels, checked.name)
    if not 0 <= trial < checked.trials:
        raise ManifestError(f"trial = {trial} is out of range; expected 0 to {checked.trials - 1}", 2)
    return simulated(checked, number, trial, controller)
