"""The errors of the package, one class for each exit code of the program."""

from __future__ import annotations

import dataclasses
import re

_PLACE = re.compile(r"(?P<file>.+?):(?P<line>\d+):(?:(?P<column>\d+):)? (?P<text>.+)")
_OVERRIDE = re.compile(r"--set (?P<setting>\S+?=.*?): (?P<text>(?P<key>[a-z_][\w.\[\]]*): .+)")
_FILE = re.compile(r"(?P<file>[^:\s][^:]*\.\w+): (?P<text>.+)")
_KEY = re.compile(r"(?P<key>[a-z_][\w.\[\]]*): .+")


@dataclasses.dataclass(frozen=True)
class Problem:
    """One error of a manifest or of a table.

    Parameters
    ----------
    text : str
        What is wrong and what was expected, as the program words it, without the place.
    file : str or None
        Name of the manifest, table or results file; None of a manifest that was a dict.
    line, column : int or None
        Place in the file, from 1.
    key : str or None
        Dotted path of the key in a manifest, or name of the column of a table.
    setting : str or None
        The setting in which the error is, such as ``dac.bits=99``.
    """

    text: str
    file: str | None = None
    line: int | None = None
    column: int | None = None
    key: str | None = None
    setting: str | None = None


class Error(Exception):
    """What the program refused or failed to do.

    Attributes
    ----------
    message : str
        All that the program said.
    code : int
        Exit code of the program.
    problems : list of Problem
        The errors one by one; at least one.
    """

    def __init__(self, message: str, code: int) -> None:
        super().__init__(message)
        self.message = message
        self.code = code
        lines = [line for line in message.splitlines() if line.strip()]
        self.problems = [_problem(line) for line in lines] or [Problem(message)]

    @property
    def file(self) -> str | None:
        """The file of the first problem."""
        return self.problems[0].file

    @property
    def line(self) -> int | None:
        """The line of the first problem, from 1."""
        return self.problems[0].line

    @property
    def key(self) -> str | None:
        """The key of the first problem."""
        return self.problems[0].key

    def __reduce__(self) -> tuple[type[Error], tuple[str, int]]:
        return type(self), (self.message, self.code)


class ManifestError(Error, ValueError):
    """A manifest, a setting or an argument is wrong (exit code 2)."""


class ArgumentError(ManifestError, TypeError):
    """An argument of a function is of another type than it can have."""


class UnknownNameError(ManifestError, KeyError):
    """There is no point, measure or figure of this name."""

    __str__ = Exception.__str__  # a KeyError shows a text in quotes


class DataError(Error, ValueError):
    """Results or records are missing, incomplete, damaged or incompatible (exit code 4)."""


class MachineError(Error, OSError):
    """Files, memory or another program failed (exit code 5)."""


class TooLittleDataError(Error):
    """There is too little data for an answer (exit code 3)."""


_CLASSES = {2: ManifestError, 3: TooLittleDataError, 4: DataError, 5: MachineError}


def error_of(code: int, message: str) -> Error:
    """The exception for an exit code and the messages of the program."""
    return _CLASSES.get(code, Error)(message, code)


def _problem(line: str) -> Problem:
    """The parts of a message such as ``axis.yaml:9:3: friction.k11: unknown key``."""
    if (place := _PLACE.fullmatch(line)) and place["file"].startswith("<"):  # made of a dict
        key = _KEY.fullmatch(place["text"])
        return Problem(place["text"], key=key["key"] if key else None)
    if place:
        key = _KEY.fullmatch(place["text"])
        column = place["column"]
        return Problem(
            place["text"],
            place["file"],
            int(place["line"]),
            int(column) if column else None,
            key["key"] if key else None,
        )
    if setting := _OVERRIDE.fullmatch(line):
        return Problem(setting["text"], key=setting["key"], setting=setting["setting"])
    if file := _FILE.fullmatch(line):
        return Problem(file["text"], file["file"])
    return Problem(line)
