"""The answers of the program, written by generate_answers.py from ``zerocount schema --answers``: do not edit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Protocol, Union, overload

from .answers import Answer, Record, Undescribed

if TYPE_CHECKING:
    import pandas  # type: ignore[import]


class Needed(Record):
    """Study that would decide the goal.

    Attributes
    ----------
    rigs : int
        Machines; 0 without rigs.
    trials : int
        Trials of a design point.
    """

    rigs: int
    trials: int


class Success(Record):
    """Rates of success by world.

    Attributes
    ----------
    worst : float or None
        Rate of the worst world, with one-sided bounds.
    worst_low : float or None
        Lower bound.
    worst_high : float or None
        Upper bound.
    median : float or None
        Median of the rates.
    best : float or None
        Rate of the best world.
    worst_world : int
        Index of the worst world.
    best_world : int
        Index of the best world.
    """

    worst: float | None
    worst_low: float | None
    worst_high: float | None
    median: float | None
    best: float | None
    worst_world: int
    best_world: int


class Rule(Record):
    """What the bad worlds have in common.

    Attributes
    ----------
    text : str
        The rule in words.
    conditions : pandas.DataFrame
        Conditions of the rule.

        - ``parameter``: dotted path, or name of a derived quantity
        - ``relation``
        - ``value``: threshold, in the unit of the parameter

    same : pandas.DataFrame
        Conditions each of which alone names the same worlds.

        - ``parameter``: dotted path, or name of a derived quantity
        - ``relation``
        - ``value``: threshold, in the unit of the parameter

    joined_by : Literal["and", "or"]
        How the conditions are joined.
    bad_named : int
        Bad worlds that the rule names.
    others_named : int
        Other worlds that it names.
    error_rate : float or None
        Proportion of worlds named wrongly.
    p_value : float or None
        Probability of such a rule by chance.
    """

    text: str
    conditions: pandas.DataFrame
    same: pandas.DataFrame
    joined_by: Literal["and", "or"]
    bad_named: int
    others_named: int
    error_rate: float | None
    p_value: float | None


class Worlds(Record):
    """The worlds at the point.

    Attributes
    ----------
    n : int
        Number of worlds.
    success : Success
        Rates of success by world.
    success_rates : list[float or None]
        Rate of success of each world.
    goal_rates : list[float or None] or None
        Proportion of moves of each world that meet the goal.
    goal_status : list[Literal["met", "missed", "undecided"]] or None
        Verdict of each world.
    met : int or None
        Worlds in which the goal is met.
    missed : int or None
        Worlds in which the goal is missed.
    undecided : int or None
        Worlds in which the goal is undecided.
    bad_worlds : list[int]
        Indices of the worlds that fall short.
    rule : Rule or None
        What the bad worlds have in common.
    """

    _records = {"success": Success, "rule": Rule}

    n: int
    success: Success
    success_rates: list[float | None]
    goal_rates: list[float | None] | None
    goal_status: list[Literal["met", "missed", "undecided"]] | None
    met: int | None
    missed: int | None
    undecided: int | None
    bad_worlds: list[int]
    rule: Rule | None


class JudgeAnswer(Answer):
    """Whether a study meets its goal.

    Attributes
    ----------
    point : int
        Number of the design point.
    label : str
        Label of the design point.
    goal : str
        The goal in words.
    status : Literal["met", "missed", "undecided"]
        Verdict on the goal.
    rate : float or None
        Proportion of moves that meet the goal, with one-sided bounds.
    rate_low : float or None
        Lower bound.
    rate_high : float or None
        Upper bound.
    machines_low : float or None
        Lower bound of the proportion of machines that meet the goal, if it is about machines.
    machines_high : float or None
        Its upper bound.
    chosen_from : int
        Design points that the point is the best of; 1 if it was named.
    needed : Needed or None
        Study that would decide the goal.
    worlds : Worlds or None
        The worlds at the point.
    """

    _records = {"needed": Needed, "worlds": Worlds}

    point: int
    label: str
    goal: str
    status: Literal["met", "missed", "undecided"]
    rate: float | None
    rate_low: float | None
    rate_high: float | None
    machines_low: float | None
    machines_high: float | None
    chosen_from: int
    needed: Needed | None
    worlds: Worlds | None


class CompareAnswer(Undescribed):
    """Of the command compare, whose schema the program does not give yet."""


class IdentifyAnswer(Undescribed):
    """Of the command identify, whose schema the program does not give yet."""


class PlanAnswer(Undescribed):
    """Of the command plan, whose schema the program does not give yet."""


class SummaryAnswer(Undescribed):
    """Of the command summary, whose schema the program does not give yet."""


class TuneAnswer(Undescribed):
    """Of the command tune, whose schema the program does not give yet."""


TYPES: dict[str, type[Answer]] = {
    "judge": JudgeAnswer,
    "compare": CompareAnswer,
    "identify": IdentifyAnswer,
    "plan": PlanAnswer,
    "summary": SummaryAnswer,
    "tune": TuneAnswer,
}


DESCRIBED = frozenset({"judge"})


class Ask(Protocol):
    """Asks the program, and gives the answer of the command."""

    @overload
    def __call__(self, command: Literal["judge"], /, *operands: Any, progress: bool = ..., **options: Any) -> JudgeAnswer: ...
    @overload
    def __call__(self, command: Literal["compare"], /, *operands: Any, progress: bool = ..., **options: Any) -> CompareAnswer: ...
    @overload
    def __call__(self, command: Literal["identify"], /, *operands: Any, progress: bool = ..., **options: Any) -> IdentifyAnswer: ...
    @overload
    def __call__(self, command: Literal["plan"], /, *operands: Any, progress: bool = ..., **options: Any) -> PlanAnswer: ...
    @overload
    def __call__(self, command: Literal["summary"], /, *operands: Any, progress: bool = ..., **options: Any) -> SummaryAnswer: ...
    @overload
    def __call__(self, command: Literal["tune"], /, *operands: Any, progress: bool = ..., **options: Any) -> TuneAnswer: ...
    @overload
    def __call__(self, command: str, /, *operands: Any, progress: bool = ..., **options: Any) -> Answer: ...
