"""Results beside a baseline."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from .answer_types import CompareAnswer
from .asking import ask
from .datasets import path_of

if TYPE_CHECKING:
    import pandas  # type: ignore[import]

    from .results import Results


class Comparison(CompareAnswer):
    """Results beside a baseline."""

    @property
    def table(self) -> pandas.DataFrame:
        """One row for each point and measure: the values of both, the change and its bounds, and the verdict."""
        return self.rows_of("points.measures")


def compare(
    baseline: Results | str | os.PathLike[str],
    current: Results | str | os.PathLike[str] | None = None,
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
    return Comparison.of(ask("compare", *files, *words, margins=margins, changed_fails=changed_fails))
