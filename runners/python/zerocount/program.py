"""The program: where it is, and how it is run."""

from __future__ import annotations

import contextlib
import functools
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import threading
import warnings
from collections.abc import Callable, Iterable, Sequence

from .errors import MachineError, error_of
from .version import VERSION

_REPLACED = b"\r\x1b[K"  # ends a line of progress: the next one takes its place
_PARTS = re.compile(rb"(\r\x1b\[K|\r?\n)")

WARNING = re.compile(r"(zerocount[\w ]*: )?warning: (?P<text>.+)")
"""A message that is no error. The package passes it on as a warning of Python."""

VERDICTS = frozenset({0, 1, 3})
"""Exit codes with which a command has answered: yes, no, undecided."""


@functools.cache
def path() -> str:
    """The program of this version.

    Returns
    -------
    str
        ``$ZEROCOUNT_PROGRAM`` if that is set, otherwise the program that was installed with the package,
        otherwise the ``zerocount`` of ``$PATH``.

    Raises
    ------
    MachineError
        If there is none, or it has another version than the package.
    """
    found = os.environ.get("ZEROCOUNT_PROGRAM") or _installed() or shutil.which("zerocount")
    if found is None:
        raise MachineError(
            "the program zerocount was not found; install it (apt-get install zerocount), or set ZEROCOUNT_PROGRAM "
            "to its path",
            5,
        )
    found = os.path.abspath(found)
    try:
        words = subprocess.run([found, "--version"], capture_output=True, text=True, check=True).stdout.split()
    except (OSError, subprocess.CalledProcessError):
        raise MachineError(f"{found} is not a program that runs here; expected zerocount", 5) from None
    if words[:2] != ["zerocount", VERSION]:
        raise MachineError(
            f"{found} is {' '.join(words[:2])}; expected zerocount {VERSION}, as this package", 5
        )
    return found


def _installed() -> str | None:
    """The program that was installed with the package: in a wheel, by pip from the sources, or as packages of Debian."""
    places = (pathlib.Path(__file__).parent / "bin" / "zerocount", pathlib.Path(sys.prefix, "bin", "zerocount"))
    return next((str(program) for program in places if program.exists()), None)


def run(
    arguments: Iterable[str | os.PathLike[str]],
    *,
    text: str | None = None,
    folder: str | os.PathLike[str] | None = None,
    accepted: frozenset[int] = frozenset({0}),
    progress: Callable[[str], None] | None = None,
) -> tuple[int, str]:
    """Run the program.

    Parameters
    ----------
    arguments : iterable of str or path
        Command and options.
    text : str, optional
        Standard input.
    folder : path, optional
        Where it runs.
    accepted : frozenset of int
        Exit codes that are no error where the program has answered.
    progress : callable, optional
        Is given each line of progress.

    Returns
    -------
    code : int
        Exit code.
    output : str
        Standard output.

    Raises
    ------
    Error
        For an exit code that is not accepted; of the class for that code.
    KeyboardInterrupt
        If it is interrupted. The program has then ended, and kept everything finished.
    """
    command: Sequence[str] = [*_ended_with_this_process(), path(), *(os.fspath(word) for word in arguments)]
    # The program tells its progress often where its messages go to a terminal.
    ours, its = os.openpty() if progress else os.pipe()
    said: list[str] = []
    listener = threading.Thread(target=_listen, args=(ours, said, progress), daemon=True)
    try:
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE if text is not None else subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=its,
            env={**os.environ, "COLUMNS": "0", "TERM": "ansi"},  # lines are not wrapped, and progress is told often
            text=True,
            encoding="utf-8",
            errors="replace",
            cwd=folder,
            start_new_session=True,  # it is interrupted by this process alone, which may be a notebook's
        )
    except OSError as error:
        os.close(ours)
        raise MachineError(f"{path()} cannot be started: {error.strerror}", 5) from None
    finally:
        os.close(its)
    listener.start()
    try:
        output, _ = process.communicate(text)
    except BaseException:
        process.send_signal(signal.SIGINT)
        process.communicate()
        raise
    finally:
        listener.join()
    for warning in filter(None, map(WARNING.match, said)):
        warnings.warn(warning["text"], stacklevel=_frames_of_the_package() + 1)
    message = "\n".join(line for line in said if not WARNING.match(line))
    if process.returncode == 130:
        raise KeyboardInterrupt(message)
    if process.returncode < 0:
        name = signal.Signals(-process.returncode).name
        raise MachineError(f"{path()} was ended by the signal {name}\n{message}".rstrip(), 5)
    if process.returncode not in accepted or (process.returncode != 0 and not output):
        raise error_of(process.returncode, message or f"{path()} ended with exit code {process.returncode}")
    return process.returncode, output


def _frames_of_the_package() -> int:
    """Number of calls in this package that led to the caller's: what it warns of is a line of the user."""
    package = os.path.dirname(__file__)
    frame, frames = sys._getframe(1), 0
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == package:
        frame, frames = frame.f_back, frames + 1
    return frames


@functools.cache
def _ended_with_this_process() -> Sequence[str]:
    """Words before a command that interrupt it when this process is killed, as when the kernel of a notebook restarts."""
    setpriv = shutil.which("setpriv")
    return () if setpriv is None else (setpriv, "--pdeathsig", "INT")


def _listen(stream: int, said: list[str], progress: Callable[[str], None] | None) -> None:
    """Keeps the messages that the program writes, and passes its progress on."""
    rest = b""
    with contextlib.suppress(OSError):  # a terminal ends with an error
        while piece := os.read(stream, 4096):
            *parts, rest = _PARTS.split(rest + piece)
            for text, end in zip(parts[::2], parts[1::2]):
                if end != _REPLACED:
                    said.append(_text(text))
                elif text and progress is not None:
                    progress(_text(text))
    if rest:
        said.append(_text(rest))
    os.close(stream)


def _text(line: bytes) -> str:
    return line.decode("utf-8", "replace").strip()
