"""How many trials a claim needs."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from . import program
from .datasets import path_of
from .optional import required
from .options import options

if TYPE_CHECKING:
    import pandas  # type: ignore[import]


@dataclasses.dataclass(frozen=True)
class Plan:
    """How many trials a claim needs.

    Parameters
    ----------
    plans : list of dict
        The alternatives.
    answer : dict
        The whole JSON of ``zerocount plan``.
    """

    plans: list[dict[str, Any]]
    answer: dict[str, Any] = dataclasses.field(default_factory=dict, repr=False)

    @property
    def table(self) -> pandas.DataFrame:
        """One row for each alternative; parts of an entry are columns such as ``trials.low``."""
        return required("pandas", "the table of a plan").json_normalize(self.plans)


def plan(
    pilot: Any = None,
    *,
    success: float | None = None,
    confidence: float | None = None,
    failures: int | None = None,
    true_success: float | None = None,
    power: float | None = None,
    halfwidth: float | None = None,
    rigs_share: float | None = None,
    rig_sd: float | None = None,
    margin: Mapping[str, str | float] | None = None,
) -> Plan:
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
    rigs_share : float, optional
        Least proportion of rigs.
    rig_sd : float, optional
        Standard deviation of the success probability between rigs.
    margin : dict, optional
        Largest accepted differences by measure: ``{"settling_time": "5%"}``.

    Returns
    -------
    Plan

    Examples
    --------
    >>> zc.plan(success=0.99).plans[0]
    {'failures': 0, 'trials': 299}
    """
    from .studies import Study

    words = options(
        success=success,
        confidence=confidence,
        failures=failures,
        true_success=true_success,
        power=power,
        halfwidth=halfwidth,
        rigs_share=rigs_share,
        rig_sd=rig_sd,
        margin=margin,
        format="json",
    )
    if isinstance(pilot, Study):
        text = pilot.command("plan", *words)
    else:
        files = [] if pilot is None else [path_of(pilot)]
        text = program.run(["plan", *files, *words])[1]
    answer = json.loads(text)
    return Plan(answer["plans"] if "plans" in answer else [answer], answer)
