"""Datasets of results files as arrays of NumPy, with their units."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import pathlib
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import DataError, MachineError
from .optional import required

Array = npt.NDArray[Any]


@dataclasses.dataclass(frozen=True, eq=False)
class Column:
    """A dataset.

    Parameters
    ----------
    values : numpy.ndarray
        Texts as Python's, enumerations as their numbers.
    dimensions : tuple of str
        Names of the dimensions, such as ``("trial", "move")``.
    unit : str
        ``"1"`` where dimensionless, ``""`` for texts.
    meaning : str
        One line.
    words : list of str
        Of an enumeration, by number; otherwise empty.
    """

    values: Array
    dimensions: tuple[str, ...]
    unit: str
    meaning: str
    words: list[str] = dataclasses.field(default_factory=list)

    @property
    def in_words(self) -> Array:
        """The values, those of an enumeration as words."""
        return np.asarray(np.array(self.words, dtype=object)[self.values]) if self.words else self.values


class ResultsDatasets:
    """The datasets of a results file. It is open only while it is read.

    Parameters
    ----------
    path : path
        A results file.

    Raises
    ------
    DataError
        If it is not one.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = pathlib.Path(path).absolute()
        if "format_version" not in self.attributes:
            raise DataError(f"{self.path}: not a results file of zerocount", 4)

    @property
    def attributes(self) -> dict[str, Any]:
        """Those of the root."""
        with self._open() as file:
            return {key: _attribute(value) for key, value in file.attrs.items()}

    @contextlib.contextmanager
    def _open(self) -> Iterator[Any]:
        h5py = required("h5py", "a results file")
        state_of(self.path)
        try:
            file = h5py.File(self.path, "r")
        except PermissionError as error:
            raise MachineError(f"{self.path}: cannot be read: {error.strerror}", 5) from None
        except OSError:
            raise DataError(f"{self.path}: not a results file of zerocount: it is not in the HDF5 format", 4) from None
        with file:
            try:
                yield file
            except (KeyError, OSError, RuntimeError):  # of h5py
                raise DataError(f"{self.path}: damaged: a part of it cannot be read; see 'zerocount verify'", 4) from None

    def has(self, name: str) -> bool:
        """Whether there is a group or dataset of this path."""
        with self._open() as file:
            return name in file

    def group(self, name: str, rows: slice | None = None) -> dict[str, Column]:
        """The datasets of a group, without those of groups in it.

        Parameters
        ----------
        name : str
            Path of the group, such as ``outcome`` or ``trial/input``.
        rows : slice, optional
            The trials to read; default: all.

        Returns
        -------
        dict of str to Column
            By the name in the group.

        Raises
        ------
        DataError
            If the file has no such group.
        """
        with self._open() as file:
            if name not in file:
                raise DataError(f"{self.path}: it has no {_WHAT.get(name, name)}", 4)
            datasets = {key: item for key, item in file[name].items() if hasattr(item, "shape")}
            return {key: _column(item, rows) for key, item in datasets.items()}

    def rows_of_point(self, point: int) -> slice:
        """The trials of a design point.

        Parameters
        ----------
        point : int
            Its number.
        """
        with self._open() as file:
            if "trial" not in file:
                raise DataError(f"{self.path}: it has no {_WHAT['trial']}", 4)
            points = file["trial/point"][:]
        first, last = np.searchsorted(points, [point, point + 1])
        return slice(int(first), int(last))

    def text(self, name: str) -> str:
        """A dataset that is one text."""
        with self._open() as file:
            return str(file[name].asstr()[()])

    def texts(self, name: str) -> list[str]:
        """A dataset that is a list of texts."""
        with self._open() as file:
            return [str(text) for text in file[name].asstr()[:]] if name in file else []


_WHAT = {
    "trial": "trials: its study does not keep them",
    "outcome": "outcomes of trials: its study does not keep them",
    "machine": "machines: each trial is on one of its own",
    "world": "worlds: nothing in its manifest is drawn per world",
    "age": "ages: its manifest has none",
    "level": "torque levels: its loop is closed",
    "jerk": "jerks",
}


def state_of(path: str | os.PathLike[str]) -> tuple[int, int, int]:
    """What tells whether a results file was written again."""
    try:
        state = os.stat(path)
    except (FileNotFoundError, NotADirectoryError):
        raise DataError(f"{path}: no such file; expected a results file", 4) from None
    return state.st_mtime_ns, state.st_size, state.st_ino


def path_of(results: Any) -> str:
    """The path from the root of a results file, which is there."""
    path: str = os.path.abspath(getattr(results, "path", results))
    state_of(path)
    return path


def _attribute(value: Any) -> Any:
    if isinstance(value, bytes):
        return value.decode()
    return value.item() if isinstance(value, np.generic) else value


def _column(dataset: Any, rows: slice | None) -> Column:
    attributes = {key: _attribute(dataset.attrs[key]) for key in ("units", "long_name") if key in dataset.attrs}
    dimensions = _dimensions(dataset)
    selection = rows if rows is not None and dimensions[:1] == ("trial",) else ()
    words = _words(dataset)
    if dataset.dtype.kind == "O":
        values = np.asarray(dataset.asstr()[selection], dtype=object)
    else:
        values = np.asarray(dataset[selection])
    if words == ["no", "yes"]:
        values, words = values.astype(bool), []
    unit, meaning = attributes.get("units", "1"), attributes.get("long_name", "")
    return Column(values, dimensions, unit, meaning, words)


def _words(dataset: Any) -> list[str]:
    """The words of an enumeration by its numbers, which begin at 0."""
    if "flag_values" not in dataset.attrs:
        return []
    words = str(_attribute(dataset.attrs["flag_meanings"])).split()
    by_number = dict(zip(map(int, dataset.attrs["flag_values"]), words))
    return [by_number.get(number, str(number)) for number in range(max(by_number) + 1)]


def _dimensions(dataset: Any) -> tuple[str, ...]:
    name_of = required("h5py", "a results file").h5ds.get_scale_name
    own = dataset.name.rpartition("/")[2]
    scales = (dataset.dims[i] for i in range(dataset.ndim))
    return tuple((name_of(scale[0].id) or b"").decode() if len(scale) else own for scale in scales)
