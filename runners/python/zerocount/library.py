"""The library zerocount in this process, by its C interface (``zerocount/zerocount.h``)."""

from __future__ import annotations

import ctypes
import functools
import os
import pathlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .datasets import Array
from .errors import MachineError, error_of
from .loop import SAMPLE_BYTES, SETUP_BYTES, ControlLaw, torques
from .version import VERSION

ABI = 1
"""The version of the interface that this module calls."""

NAME = f"libzerocount.so.{ABI}"

_BETWEEN_SIGNALS = 50  # ms until this process looks for signals, such as that of Ctrl-C


class _Law(ctypes.Structure):
    """``zerocount_law``."""

    _fields_ = [
        ("size", ctypes.c_uint32),
        ("step", ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_void_p)),
        ("context", ctypes.c_void_p),
        ("setup", ctypes.c_ubyte * SETUP_BYTES.size),
        ("sample", ctypes.c_ubyte * SAMPLE_BYTES.size),
    ]


class _Array(ctypes.Structure):
    """``zerocount_array``."""

    _fields_ = [
        ("name", ctypes.c_char_p),
        ("type", ctypes.c_char_p),
        ("size", ctypes.c_int64),
        ("values", ctypes.c_void_p),
    ]


_INT64, _POINTER, _TEXT = ctypes.c_int64, ctypes.c_void_p, ctypes.c_char_p
_OVERRIDES = (ctypes.POINTER(ctypes.c_char_p), ctypes.c_size_t)
_FUNCTIONS: dict[str, tuple[Any, ...]] = {
    "read_study": (_TEXT, ctypes.c_size_t, _TEXT, _TEXT, *_OVERRIDES, _POINTER),
    "open_study": (_TEXT, _POINTER),
    "study_under": (_POINTER, _TEXT, _POINTER),
    "describe_study": (_POINTER, _POINTER),
    "describe_variables": (_POINTER, _INT64, _POINTER),
    "describe_manifest": (_TEXT, ctypes.c_size_t, _TEXT, *_OVERRIDES, _POINTER),
    "values_at_scores": (_POINTER, _INT64, _INT64, _POINTER),
    "start_outcomes": (_POINTER, _INT64, _INT64, _POINTER, _POINTER, ctypes.c_int32, _POINTER),
    "start_trial": (_POINTER, _INT64, _INT64, _POINTER, _POINTER),
    "wait": (_POINTER, ctypes.c_int32, _POINTER),
}
"""The functions that return a code, and their arguments."""


class Library:
    """The functions of the library.

    Parameters
    ----------
    path : str
        Of the library, or its name for the loader of the system.

    Raises
    ------
    OSError
        If it cannot be loaded.
    MachineError
        If it has another version than the package.
    """

    def __init__(self, path: str) -> None:
        self._all = ctypes.CDLL(path)
        for name, type_ in (("version", _TEXT), ("message", _TEXT), ("result", ctypes.POINTER(_Array))):
            getattr(self._all, f"zerocount_{name}").restype = type_
        its = (self._all.zerocount_abi_version(), self._all.zerocount_version().decode())
        if its != (ABI, VERSION):
            raise MachineError(f"{path} is zerocount {its[1]} with the interface {its[0]}; expected {VERSION} with {ABI}", 5)
        self._prepare(self._all)
        # A law in Python needs the lock of the interpreter, which all other calls leave to others.
        self._with_lock = ctypes.PyDLL(path)
        self._prepare(self._with_lock)

    def _prepare(self, library: ctypes.CDLL) -> None:
        for name, types in _FUNCTIONS.items():
            function = getattr(library, f"zerocount_{name}")
            function.argtypes = types
            function.errcheck = self._checked

    def _checked(self, code: int, function: Any, arguments: Any) -> None:
        if code != 0:
            raise error_of(code, os.fsdecode(self._all.zerocount_message()))

    def call(self, name: str, *arguments: Any) -> None:
        """Call a function that returns a code, of which others than 0 are errors."""
        getattr(self._all, f"zerocount_{name}")(*arguments)

    def text(self, name: str, *arguments: Any) -> str:
        """The text that a function makes."""
        text = ctypes.c_char_p()
        self.call(name, *arguments, ctypes.byref(text))
        try:
            return (text.value or b"").decode("utf-8", "replace")
        finally:
            self._all.zerocount_free_text(text)

    def study(self, name: str, *arguments: Any) -> Handle:
        """The study that a function makes."""
        study = Handle(self._all.zerocount_free_study)
        self.call(name, *arguments, ctypes.byref(study))
        return study

    def outcomes(self, study: Handle, point: int, values: Array, numbers: Array, threads: int) -> dict[str, Array]:
        """The measures of trials with these values, each in the order of trials and moves."""
        job = Handle(self._all.zerocount_free_job)
        place = values.ctypes.data, numbers.ctypes.data
        return self._finished(job, "start_outcomes", study, point, len(numbers), *place, threads)

    def trial(self, study: Handle, point: int, trial: int, law: ControlLaw | None) -> dict[str, Array]:
        """A trial, sample by sample."""
        job = Handle(self._all.zerocount_free_job)
        if law is None:
            return self._finished(job, "start_trial", study, point, trial, None)
        memory, raised = _Law(size=ctypes.sizeof(_Law)), list[BaseException]()
        steps = torques(law, memory.setup, memory.sample, raised)
        next(steps)
        memory.step = type(memory.step)(steps.send)
        try:
            self._with_lock.zerocount_start_trial(study, point, trial, ctypes.byref(memory), ctypes.byref(job))
            if raised:
                raise raised[0]
            return self._result(job)
        finally:
            steps.close()  # and with it its references to the memory

    def _finished(self, job: Handle, name: str, *arguments: Any) -> dict[str, Array]:
        """The result of a job. A signal whose handler raises stops it."""
        done = ctypes.c_int32()
        try:
            self.call(name, *arguments, ctypes.byref(job))
            while not done.value:
                self.call("wait", job, _BETWEEN_SIGNALS, ctypes.byref(done))
            return self._result(job)
        finally:
            job.free()  # before the arrays of the arguments

    def _result(self, job: Handle) -> dict[str, Array]:
        count = ctypes.c_size_t()
        arrays = self._all.zerocount_result(job, ctypes.byref(count))
        result = {}
        for array in arrays[: count.value]:
            values = result[array.name.decode()] = np.empty(array.size, array.type.decode())
            ctypes.memmove(values.ctypes.data, array.values, values.nbytes)
        return result


class Handle(ctypes.c_void_p):
    """What the library made, freed with this object.

    Parameters
    ----------
    free : callable
        The function that frees it.
    """

    def __init__(self, free: Callable[[ctypes.c_void_p], None]) -> None:
        super().__init__()
        self._free = free

    def free(self) -> None:
        """Free it."""
        self._free(self)
        self.value = None

    __del__ = free


def text_arguments(text: str) -> tuple[bytes, int]:
    """A text and its size."""
    encoded = text.encode()
    return encoded, len(encoded)


def override_arguments(overrides: Sequence[str]) -> tuple[Any, int]:
    """Overrides and their number."""
    return (ctypes.c_char_p * len(overrides))(*(text.encode() for text in overrides)), len(overrides)


def places() -> list[str]:
    """Where the library may be: at ``$ZEROCOUNT_LIBRARY``, or in a wheel, an installed prefix, or the folders of the system."""
    if given := os.environ.get("ZEROCOUNT_LIBRARY"):
        return [given]
    here = pathlib.Path(__file__).resolve().parent
    beside = (here / "lib" / NAME, *(folder / NAME for folder in here.parents[2:3]))
    return [*(str(path) for path in beside if path.exists()), NAME]


@functools.cache
def loaded() -> Library | None:
    """The library; None where there is none."""
    for path in places():
        try:
            return Library(path)
        except MachineError:  # of another version
            raise
        except OSError:
            continue
    return None


def required() -> Library:
    """The library, for what only this process can do.

    Raises
    ------
    MachineError
        If there is none.
    """
    if (library := loaded()) is None:
        raise MachineError(
            f"a trial or a sample in this process needs the library {NAME}, which was not found at "
            f"{' or '.join(places())}; install it (apt-get install libzerocount{ABI}), or set ZEROCOUNT_LIBRARY to its path",
            5,
        )
    return library
