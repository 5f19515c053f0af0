"""Figures of the report."""

from __future__ import annotations

import dataclasses
import functools
import json
import os
import pathlib
import tempfile
from typing import TYPE_CHECKING, Any

from . import program
from .datasets import state_of
from .drawing import drawn
from .errors import MachineError, UnknownNameError

if TYPE_CHECKING:
    import matplotlib.figure  # type: ignore[import]

SHOWN_WIDTH = 600
"""Of a picture in a notebook, pixels."""


@dataclasses.dataclass(frozen=True, eq=False)
class Figure:
    """A figure of the report. A notebook shows it as a picture.

    Parameters
    ----------
    name : str
        As ``Results.figures`` lists it.
    """

    name: str
    _options: tuple[str, ...] = dataclasses.field(repr=False)

    @functools.cached_property
    def specification(self) -> dict[str, Any]:
        """Vega-Lite, with the data and the theme. It needs node, as the pictures do."""
        with tempfile.TemporaryDirectory() as folder:
            text = self.save(pathlib.Path(folder, "figure.json")).read_text(encoding="utf-8")
        specification: dict[str, Any] = json.loads(text)
        return specification

    def save(self, output: str | os.PathLike[str]) -> pathlib.Path:
        """Write the figure.

        Parameters
        ----------
        output : path
            ``.svg``, ``.png``, ``.html`` (a page that needs nothing else) or ``.json``. An existing file is
            replaced.

        Returns
        -------
        pathlib.Path

        Raises
        ------
        MachineError
            If node, which draws pictures, or rsvg-convert is missing.
        """
        program.run(["plot", *self._options, "-o", os.fspath(output), "--force"])
        return pathlib.Path(output)

    @functools.cached_property
    def svg(self) -> str:
        """The picture as SVG."""
        return program.run(["plot", *self._options, "-o", "-"])[1]

    @functools.cached_property
    def png(self) -> bytes:
        """The picture as PNG, 300 pixels an inch at a width of 140 mm."""
        with tempfile.TemporaryDirectory() as folder:
            return self.save(pathlib.Path(folder, "figure.png")).read_bytes()

    def matplotlib(self) -> matplotlib.figure.Figure:
        """The figure drawn by matplotlib from the same specification, to be changed.

        Returns
        -------
        matplotlib.figure.Figure
            Its axes have the units of the data, their labels SI prefixes.

        Raises
        ------
        MachineError
            If node is missing, which makes the specification.

        Examples
        --------
        >>> picture = zc.open("my-axis.h5").plot("settled").matplotlib()
        >>> picture.axes[0].get_xlabel()
        'settled for good from (ms)'
        """
        return drawn(self.specification)

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> tuple[dict[str, Any], dict[str, Any]]:
        """What a notebook shows: the picture, as well as this machine can draw it."""
        text = {"text/plain": repr(self)}
        try:
            return {"image/png": self.png, **text}, {"image/png": {"width": SHOWN_WIDTH}}
        except MachineError:
            pass
        try:
            return {"image/svg+xml": self.svg, **text}, {}
        except MachineError as error:
            return {"text/plain": f"{repr(self)}: {error}"}, {}


def figure_names(path: str | os.PathLike[str]) -> list[str]:
    """Names of the figures of a results file."""
    return list(_figure_names(os.path.abspath(path), state_of(path)))


@functools.lru_cache
def _figure_names(path: str, state: tuple[int, int, int]) -> tuple[str, ...]:
    """The same of a file in this state."""
    return tuple(program.run(["plot", path])[1].split())


def figure(path: str | os.PathLike[str], name: str | None, point: int | None) -> Figure:
    """A figure of a results file.

    Parameters
    ----------
    path : path
        A results file.
    name : str or None
        Its name, or the start of it; None: the first.
    point : int or None
        The design point whose trials are shown; None: the best.
    """
    known = figure_names(path)
    fitting = [other for other in known if name is None or other == name] or [
        other for other in known if name is not None and other.startswith(name)
    ]
    if not fitting:
        raise UnknownNameError(f"{path}: there is no figure {name!r}; expected one of {', '.join(known)}", 2)
    options = [os.fspath(path), "--figure", fitting[0]] + (["--point", str(point)] if point is not None else [])
    return Figure(fitting[0], tuple(options))
