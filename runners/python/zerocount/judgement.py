"""Whether a goal is met."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

from .options import dataclass_of


@dataclasses.dataclass(frozen=True)
class Judgement:
    """Whether a goal is met.

    Parameters
    ----------
    point : int
        The design point that was judged.
    label : str
        Its label.
    status : str
        ``"met"``, ``"missed"`` or ``"undecided"``.
    rate : float
        Proportion of moves that meet the goal.
    rate_low, rate_high : float
        Its one-sided bounds, at the confidence of the goal.
    machines_low, machines_high : float or None
        Bounds of the proportion of machines, if the goal is about machines.
    chosen_from : int
        Design points of which this one is the best; the bounds allow for that choice.
    needed : dict or None
        The rigs and trials that would decide it.
    worlds : dict or None
        What is known of the worlds, of a study with worlds.
    text : str
        The verdict in words; ``print`` shows it.
    """

    point: int
    label: str
    status: str
    rate: float
    rate_low: float
    rate_high: float
    machines_low: float | None = None
    machines_high: float | None = None
    chosen_from: int = 1
    needed: dict[str, Any] | None = None
    worlds: dict[str, Any] | None = dataclasses.field(default=None, repr=False)
    text: str = dataclasses.field(default="", repr=False)

    def __str__(self) -> str:
        return self.text.rstrip("\n")

    @staticmethod
    def of(record: Mapping[str, Any]) -> Judgement:
        """From JSON."""
        return dataclass_of(Judgement, record)
