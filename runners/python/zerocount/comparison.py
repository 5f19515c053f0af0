"""Results beside a baseline."""

from __future__ import annotations

import dataclasses
import json
import os
from typing import TYPE_CHECKING, Any

from . import program
from .datasets import path_of
from .optional import required
from .options import dataclass_of, options

if TYPE_CHECKING:
    import pandas  # type: ignore[import]


@dataclasses.dataclass(frozen=True)
class Comparison:
    """Results beside a baseline.

    Parameters
    ----------
    verdict : str
        ``"passed"``, ``"regression"``, ``"changed"`` or ``"inconclusive"``.
    sentence : str
        The verdict in words.
    points : list of dict
        The measures of each design point.
    answer : dict
        The whole JSON of ``zerocount compare``.
    """

    verdict: str
    sentence: str
    points: list[dict[str, Any]] = dataclasses.field(default_factory=list, repr=False)
    answer: dict[str, Any] = dataclasses.field(default_factory=dict, repr=False)

    @property
    def table(self) -> pandas.DataFrame:
        """One row for each point and measure: the values of both, the change and its bounds, and the verdict."""
        rows = [{"label": point["label"], **measure} for point in self.points for measure in point["measures"]]
        return required("pandas", "the table of a comparison").json_normalize(rows)


def compare(
    baseline: Any,
    current: Any = None,
    *,
    points: tuple[int | str, int | str] | None = None,
    margins: str | os.PathLike[str] | None = None,
    changed_fails: bool = False,
) -> Comparison:
    """Whether results are as good as a baseline.

    Parameters
    ----------
    baseline, current : Results or path
        Two results files; or one, with `points`.
    points : tuple, optional
        Two design points of one file, of which the second is compared with the first.
    margins : path, optional
        YAML file of margins and requirements.
    changed_fails : bool
        A change for the better fails, too.

    Returns
    -------
    Comparison
        By the goal of the manifest, where it has one.

    Raises
    ------
    DataError
        If there is no such results file, or the two cannot be compared.

    Examples
    --------
    >>> zc.compare("my-axis.h5", points=(2, 3)).verdict
    'regression'
    """
    files = [path_of(file) for file in (baseline, current) if file is not None]
    words = ["--points", *map(str, points)] if points is not None else []
    words += options(margins=margins, changed_fails=changed_fails, format="json")
    answer = json.loads(program.run(["compare", *files, *words], accepted=program.VERDICTS)[1])
    return dataclass_of(Comparison, answer, answer=answer)
