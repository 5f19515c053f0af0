"""What mypy knows of answers: it is checked with --strict, which also refuses a comment that ignores no error."""

from __future__ import annotations

import zerocount as zc
from zerocount.answer_types import LearnAnswer, ParametersAnswer, ParametersGuidesAnswer


def use(results: zc.Results) -> float | None:
    judgement = results.judge()
    judgement.nothing  # type: ignore[attr-defined]
    judgement.status == "unknown"  # type: ignore[comparison-overlap]
    judgement.needed.trials  # type: ignore[union-attr]
    return judgement.rate if judgement.needed is None else judgement.needed.trials


def facts(results: zc.Results) -> int:
    labels: list[str] = results.checked.labels
    results.study.labels.nothing  # type: ignore[attr-defined]
    number: int = results.summary  # type: ignore[assignment]
    return number + len(labels) + results.study.trials


learnt: LearnAnswer = zc.ask("learn", "worlds.h5", point=2)
listed: ParametersAnswer | ParametersGuidesAnswer = zc.ask("parameters")
word: str = zc.ask("judge", "my-axis.h5").label
number: int = zc.ask("judge", "my-axis.h5").label  # type: ignore[assignment]
anything: zc.Answer = zc.ask("any" + "thing")
