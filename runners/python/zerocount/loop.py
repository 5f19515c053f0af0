"""What a control law in Python is given, and gives."""

from __future__ import annotations

import ctypes
import math
import struct
from collections.abc import Callable, Generator
from typing import Any, NamedTuple


class Setup(NamedTuple):
    """What is the same at all samples of a trial. On a linear axis read m for rad, and N for N m.

    Parameters
    ----------
    sample_time : float
        T, s.
    resolution : float
        Of the encoder, rad per count.
    torque_resolution : float
        Of the converter, N m per code.
    lowest_torque, highest_torque : float
        That the converter can give, N m.
    initial_integral : float
        I before the first sample, ``initial.integral`` and what ``initial.holding`` adds, N m.
    other_resolution : float
        Of the encoder of the other mass, rad per count; 0 where there is none.
    """

    sample_time: float
    resolution: float
    torque_resolution: float
    lowest_torque: float
    highest_torque: float
    initial_integral: float
    other_resolution: float


class Sample(NamedTuple):
    """A sampling instant.

    Parameters
    ----------
    k : int
        Number of the sample in the trial, from 0.
    time : float
        Since the start of the trial, k T, s.
    error : float
        Reference, rounded to counts, less count.
    count : float
        Of the encoder that closes the loop, counts of the fine one.
    reference : float
        Before it is rounded, counts.
    torque : float
        Decided at the sample before, in whole DAC steps within the range, N m; 0 at the first.
    velocity, acceleration : float
        Of the reference before it is rounded, rad/s and rad/s².
    new_target : bool
        Whether this is the first sample with another target.
    other_count : float
        Of the encoder of the other mass, counts of it; 0 where there is none.
    """

    k: int
    time: float
    error: float
    count: float  # type: ignore[assignment]  # a tuple has a method of this name
    reference: float
    torque: float
    velocity: float
    acceleration: float
    new_target: bool
    other_count: float


ControlLaw = Callable[[Setup], Callable[[Sample], float]]
"""A control law: is given the setup of a trial, and returns the function that gives the torque (N m) of a sample."""

# zerocount_setup, of which its size and the parameters are left out, and zerocount_sample.
SETUP_BYTES = struct.Struct("=16x7d")
SAMPLE_BYTES = struct.Struct("=q7d?7xd")


def torques(law: ControlLaw, setup: Any, sample: Any, raised: list[BaseException]) -> Generator[float, None, None]:
    """The torques of a law, each for what then stands in memory.

    A generator, because an exception of a signal is raised where Python's code begins or goes on. Here that is always
    inside the ``try``: C, which asks for the torques, could not pass an exception on.

    Parameters
    ----------
    law : callable
        A control law.
    setup, sample : buffer
        Where the setup of the trial and each sample are.
    raised : list
        Gets the exception of the law. The torque is then NaN, which ends the trial.

    Yields
    ------
    float
        First 0, before there is a setup; then the torque of each sample, N m.
    """
    unpack, new = SAMPLE_BYTES.unpack_from, tuple.__new__
    torque: Any = 0.0
    try:
        yield torque
        step = law(Setup(*SETUP_BYTES.unpack_from(setup)))
        if not callable(step):
            raise TypeError(
                f"the controller returned {type(step).__name__} for the setup of the trial; expected a function of a sample"
            )
        while True:
            torque = step(new(Sample, unpack(sample)))
            yield torque if isinstance(torque, float) else _number(torque)
    except GeneratorExit:  # the trial is over
        raise
    except BaseException as error:
        raised.append(error)
        yield math.nan


def _number(value: Any) -> float:
    """The torque that a law returned."""
    try:
        return ctypes.c_double(value).value
    except TypeError:
        raise TypeError(
            f"the control law returned {type(value).__name__} at a sample; expected a torque, a number"
        ) from None
