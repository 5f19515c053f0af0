"""Whether a machine in use has changed."""

from __future__ import annotations

import contextlib
import csv
import os
import pathlib
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, overload

from .answer_types import MonitorAnswer
from .arguments import is_iterable, refuse
from .asking import ask
from .datasets import path_of
from .errors import ManifestError
from .results import Results


def _cell(value: Any) -> str:
    """As the program reads it: what never happened is nan, also pandas.NA."""
    text = str(value)
    return "nan" if value is None or text == "<NA>" else text


def _columns(moves: Any) -> dict[str, list[Any]]:
    """The columns of a table: a DataFrame, columns or values by name, or one mapping a move.

    Raises
    ------
    ArgumentError
        If it is no such table.
    """
    if hasattr(moves, "columns") and hasattr(moves, "loc"):
        return {str(name): list(moves[name]) for name in moves.columns}
    if isinstance(moves, Mapping):
        return {
            str(name): list(values) if is_iterable(values) else [values]
            for name, values in moves.items()
        }
    rows = list(moves) if is_iterable(moves) else [moves]
    names = set(rows[0]) if rows and isinstance(rows[0], Mapping) else set()
    for row in rows:
        if not isinstance(row, Mapping) or set(row) != names:
            refuse("monitor: a move", row, f"a mapping with {', '.join(map(str, names)) or 'measures'}, as the first")
    return {name: [row[name] for row in rows] for name in (rows[0] if rows else {})}


def _is_file(moves: Any) -> bool:
    return isinstance(moves, (str, os.PathLike, Results))


def _add(path: pathlib.Path, columns: Mapping[str, Sequence[Any]]) -> None:
    """Adds rows to a log, which is begun where there is none."""
    if len({len(values) for values in columns.values()}) > 1:
        raise ManifestError("the columns have different lengths", 2)
    begins = not path.exists()
    with path.open("a", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        if begins:
            writer.writerow(columns)
        writer.writerows([_cell(value) for value in row] for row in zip(*columns.values()))


@contextlib.contextmanager
def _restored(path: pathlib.Path) -> Iterator[None]:
    """Leaves a log as it was before, where what is done with it fails."""
    size = path.stat().st_size if path.exists() else None
    try:
        yield
    except BaseException:
        if size is None:
            path.unlink(missing_ok=True)
        else:
            os.truncate(path, size)
        raise


class Monitor:
    """Watches a machine, move after move. Made by :func:`monitor`.

    Parameters
    ----------
    baseline : Results, path or table
        What its moves are compared with.
    **options
        Of the command ``monitor``.

    Examples
    --------
    >>> watch = zc.monitor({"arrival_time": [0.041, 0.043, 0.040, 0.044, 0.042]})
    >>> watch.update({"arrival_time": [0.042, 0.043]}).status
    'undecided'
    """

    def __init__(self, baseline: Any, **options: Any) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="zerocount-monitor-")
        self._log = pathlib.Path(self._folder.name) / "moves.csv"
        self._options = options
        self._names: list[str] = []
        if _is_file(baseline):
            self._baseline = path_of(baseline)
        else:
            log = pathlib.Path(self._folder.name) / "baseline.csv"
            _add(log, _columns(baseline))
            self._baseline = str(log)

    def read(self, log: str | os.PathLike[str]) -> MonitorAnswer:
        """Ask of a log in place of the moves of :meth:`update`.

        Parameters
        ----------
        log : path
            A row a move.

        Returns
        -------
        MonitorAnswer
            Of its moves alone.

        Raises
        ------
        DataError
            If it cannot be read.
        """
        return ask("monitor", self._baseline, log, **self._options)

    def update(self, moves: Any) -> MonitorAnswer:
        """Add moves, and ask again. The program reads all moves since the first.

        Parameters
        ----------
        moves : table
            A DataFrame, lists or values by the name of the measure, or one mapping a move. NaN, NA or None: it never happened.

        Returns
        -------
        MonitorAnswer
            Of all moves until now.

        Raises
        ------
        ManifestError
            If the columns are not those of the first moves, or the first moves have none.
        Error
            Of the class of the exit code, if the program refuses the moves: then none of them is added.
        """
        columns = _columns(moves)
        names = self._names or list(columns)
        if not names:
            raise ManifestError("no columns; expected names of measures, as the first moves", 2)
        if columns and set(columns) != set(names):
            raise ManifestError(f"columns {', '.join(map(str, columns))}; expected {', '.join(names)}, as the first moves have", 2)
        with _restored(self._log):
            _add(self._log, {name: columns[name] for name in names} if columns else {})
            answer = self.read(self._log)
        self._names = names
        return answer


@overload
def monitor(baseline: Any, moves: None = None, **options: Any) -> Monitor: ...
@overload
def monitor(baseline: Any, moves: str | os.PathLike[str] | Iterable[Any], **options: Any) -> MonitorAnswer: ...
def monitor(baseline: Any, moves: Any = None, **options: Any) -> Monitor | MonitorAnswer:
    """Whether a machine in use has changed.

    Parameters
    ----------
    baseline : Results, path or table
        A results file, a log of the machine's own earlier moves, or a table of them: a DataFrame, or lists by the name
        of the measure.
    moves : path or table, optional
        The moves in their order. Without them the machine is watched by :meth:`Monitor.update`.
    **options
        Of the command: ``alarm``, ``change``, ``measure`` (a list), ``block``, ``group``, ``unchanged`` (a list), ``point``, ``condition``, ``age``, ``machine``, ``seed``, ``budget``.

    Returns
    -------
    MonitorAnswer or Monitor
        The answer, with ``status``, ``measure``, ``direction``, ``since``, ``alarm_at``, and ``not_judged``, the measures that only one of both has;
        or what gives one for each update.

    Raises
    ------
    ManifestError
        If no measure is on both sides, or an option is wrong.
    DataError
        If a log cannot be read.

    Examples
    --------
    >>> before = {"arrival_time": [0.041, 0.043, 0.040, 0.044, 0.042] * 10}
    >>> zc.monitor(before, {"arrival_time": [0.061, 0.063] * 20}).direction
    'higher'
    """
    watch = Monitor(baseline, **options)
    if moves is None:
        return watch
    return watch.read(moves) if _is_file(moves) else watch.update(moves)
