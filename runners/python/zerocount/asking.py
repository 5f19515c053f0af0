"""Commands of the program, and their answers."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, cast

from . import program
from .answer_types import TYPES, Ask
from .answers import Answer
from .options import options
from .progress import progress_bar

if TYPE_CHECKING:
    from .results import Results
    from .studies import Study


def _typed(function: Callable[..., Answer]) -> Ask:
    """The function with the type of the answer for each command."""
    return cast(Ask, function)


def _word(operand: Any) -> str:
    """An operand on the command line; that of results and paths from the root."""
    path = getattr(operand, "path", operand)
    return str(os.path.abspath(path)) if isinstance(path, os.PathLike) else str(path)


@_typed
def ask(command: str, /, *operands: Study | Mapping[str, Any] | Results | str | os.PathLike[str], progress: bool = True, **values: Any) -> Answer:
    """Ask a command of the program.

    Parameters
    ----------
    command : str
        Such as ``"limits"``.
    *operands : Study, dict, Results, path or str
        What the command is asked of: a study, results, files, or other words of its command line.
    progress : bool
        Show the progress of a long command in a terminal or a notebook.
    **values
        Options of the command, with ``_`` in place of ``-``; a path is seen from the current folder. True gives an
        option without a value, a list gives it several times, and a dict as ``KEY=VALUE``.

    Returns
    -------
    Answer
        Also where the answer is no, or undecided. Its class, in ``zerocount.answer_types``, has its parts as
        attributes: ``help(type(answer))`` lists them with their meanings and units.

    Raises
    ------
    Error
        Of the class of the exit code, where there is no answer.

    Examples
    --------
    >>> zc.ask("judge", "my-axis.h5", point=2)
    <JudgeAnswer: 2 (ki=11767.7): the goal is met>
    """
    from .studies import Study, study

    words = options(**values, format="notebook")
    subject = study(operands[0]) if operands and isinstance(operands[0], (Study, Mapping)) else None
    others = [_word(operand) for operand in operands[subject is not None :]]
    with progress_bar(command, progress) as bar:
        if subject is not None:
            text = subject.command(command, *others, *words, accepted=program.VERDICTS, progress=bar)
        else:
            text = program.run([command, *others, *words], accepted=program.VERDICTS, progress=bar)[1]
    rendered = json.loads(text)
    return TYPES[rendered["answer"]["answer"]](rendered)
