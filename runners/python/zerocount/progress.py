"""Progress of the program, in a terminal or a notebook."""

from __future__ import annotations

import contextlib
import re
import shutil
import sys
from collections.abc import Callable, Iterator
from typing import Any

_PERCENT = re.compile(r"\((\d+(?:\.\d+)?) %\)")


@contextlib.contextmanager
def progress_bar(name: str, wanted: bool) -> Iterator[Callable[[str], None] | None]:
    """A function that shows a line of progress, while the context lasts.

    Parameters
    ----------
    name : str
        What the progress is of.
    wanted : bool
        Whether it is to be shown. It is not where there is neither a terminal nor a notebook.

    Yields
    ------
    callable or None
        None where nothing is shown.
    """
    if not wanted:
        yield None
    elif (display := _notebook_display()) is not None:
        with _notebook_bar(name, display) as bar:
            yield bar
    elif sys.stderr is not None and sys.stderr.isatty():
        with _terminal_bar(name) as bar:
            yield bar
    else:
        yield None


def _fraction(text: str) -> float | None:
    """The progress that a line tells, from 0 to 1."""
    percent = _PERCENT.search(text)
    return float(percent[1]) / 100 if percent else None


def _notebook_display() -> Any:
    """The module that shows things in the notebook in which this runs."""
    shell = sys.modules.get("IPython")
    if shell is None or type(shell.get_ipython()).__name__ != "ZMQInteractiveShell":
        return None
    import IPython.display  # type: ignore[import]

    return IPython.display


@contextlib.contextmanager
def _notebook_bar(name: str, display: Any) -> Iterator[Callable[[str], None]]:
    handle: Any = None

    def show(text: str) -> None:
        nonlocal handle
        fraction = _fraction(text)
        value = "" if fraction is None else f' value="{fraction:.3f}"'
        page = display.HTML(f"<progress{value}></progress> {name}: {text}")
        if handle is None:
            handle = display.display(page, display_id=True)
        else:
            handle.update(page)

    try:
        yield show
    finally:
        if handle is not None:
            handle.update(display.HTML(""))


@contextlib.contextmanager
def _terminal_bar(name: str) -> Iterator[Callable[[str], None]]:
    width = 24

    def show(text: str) -> None:
        fraction = _fraction(text)
        filled = 0 if fraction is None else round(fraction * width)
        bar = "" if fraction is None else f"[{'█' * filled}{'·' * (width - filled)}] "
        line = f"{name}: {bar}{text}"
        sys.stderr.write("\r\x1b[K" + line[: shutil.get_terminal_size().columns - 1])
        sys.stderr.flush()

    try:
        yield show
    finally:
        sys.stderr.write("\r\x1b[K")
        sys.stderr.flush()
