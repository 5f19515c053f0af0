"""Tables of pandas from datasets."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .datasets import Array, Column
from .optional import required

if TYPE_CHECKING:
    import pandas  # type: ignore[import]


def combined(values: Array, rule: str) -> Array:
    """``[trial]`` from the values ``[trial, move]`` of its moves.

    Parameters
    ----------
    values : numpy.ndarray
        Of the moves.
    rule : str
        ``all``, ``any``, ``sum``, ``largest`` (magnitude) or ``last``.
    """
    if rule == "all":
        return np.asarray(values.all(axis=1))
    if rule == "any":
        return np.asarray(values.any(axis=1))
    if rule == "sum":
        return np.asarray(values.sum(axis=1))
    if rule == "largest":
        return np.asarray(np.abs(values).max(axis=1))
    return np.asarray(values[:, -1])


def succeeded(outcomes: Array, words: Sequence[str]) -> Array:
    """``[trial]`` whether all moves ended at zero counts.

    Parameters
    ----------
    outcomes : numpy.ndarray
        ``[trial, move]`` numbers of the outcomes.
    words : sequence of str
        By their numbers.
    """
    return np.asarray((outcomes == words.index("zero_count")).all(axis=1))


def worst(outcomes: Array, words: Sequence[str], by_severity: Sequence[str]) -> Array:
    """``[trial]`` number of the worst outcome; parameters as of `succeeded`, and all words from best to worst."""
    order = np.array([words.index(word) for word in by_severity if word in words], dtype=outcomes.dtype)
    severity = np.zeros(len(words), dtype=int)
    severity[order] = range(len(order))
    return np.asarray(order[severity[outcomes].max(axis=1)])


def short_name(name: str, among: list[str]) -> str:
    """The last part of a dotted key, with as many parts before it as tell it from others.

    What follows in brackets, a limit, or after @, a condition, is no part of the key.
    """
    key = re.split(r"[\[@]", name)[0]
    parts = key.split(".")
    for first in range(len(parts) - 1, 0, -1):
        short = ".".join(parts[first:]) + name[len(key) :]
        clear = sum(other == short or other.endswith("." + short) for other in among) <= 1
        if clear and not parts[first].isdigit():
            return short
    return name


def frame(purpose: str, columns: Mapping[str, Column], index: Any, index_name: str | None) -> pandas.DataFrame:
    """A DataFrame with short names, and the units and meanings of its columns."""
    pandas = required("pandas", purpose)
    names = {name: short_name(name, list(columns)) for name in columns}
    table = pandas.DataFrame({names[name]: _series(pandas, column) for name, column in columns.items()}, index=index)
    if index_name is not None:
        table.index.name = index_name
    table.attrs["units"] = {names[name]: column.unit for name, column in columns.items()}
    table.attrs["meanings"] = {names[name]: column.meaning for name, column in columns.items()}
    return table


def _series(pandas: Any, column: Column) -> Any:
    """The values of a column, an enumeration as categories."""
    return pandas.Categorical.from_codes(column.values, column.words) if column.words else column.values
