"""How many trials a claim needs."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .answer_types import PlanAnswer
from .asking import ask

if TYPE_CHECKING:
    from .results import Results
    from .studies import Study


def plan(
    pilot: Study | Results | str | os.PathLike[str] | Mapping[str, Any] | None = None,
    *,
    success: float | None = None,
    confidence: float | None = None,
    failures: int | None = None,
    true_success: float | None = None,
    power: float | None = None,
    halfwidth: float | None = None,
    machines_share: float | None = None,
    machine_sd: float | None = None,
    margin: Mapping[str, str | float] | None = None,
) -> PlanAnswer:
    """How many trials a claim needs.

    Parameters
    ----------
    pilot : Study, Results or path, optional
        The study whose goal is to be decided, or a pilot.
    success : float, optional
        Least proportion of successful axes to be shown.
    confidence : float, optional
        Of the claim; default 0.95.
    failures : int, optional
        Plans for 0 to this number of failures.
    true_success : float, optional
        Assumed true proportion.
    power : float, optional
        Probability with which the plan shows it.
    halfwidth : float, optional
        Half-width of the bounds of a rate.
    machines_share : float, optional
        Least proportion of machines.
    machine_sd : float, optional
        Standard deviation of the success probability between machines.
    margin : dict, optional
        Largest accepted differences by measure: ``{"arrival_time": "5%"}``.

    Returns
    -------
    PlanAnswer
        Of the kind that fits the question.

    Examples
    --------
    >>> zc.plan(success=0.99)["plans"][0]["trials"]
    299
    """
    return ask(
        "plan",
        *([] if pilot is None else [pilot]),
        success=success,
        confidence=confidence,
        failures=failures,
        true_success=true_success,
        power=power,
        halfwidth=halfwidth,
        machines_share=machines_share,
        machine_sd=machine_sd,
        margin=margin,
    )
