"""Control laws in Python beside the built-in one; errors and interruption of a law; the lock of the interpreter."""

from __future__ import annotations

import operator
import pathlib
import random
import signal
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import zerocount as zc
from support import same_trace, shipped


def pi(kp: float, ki: float, zone: float = float("inf"), *, si: bool = False) -> zc.ControlLaw:
    """The law of examples/controllers/pi.c. With `si` the gains are those of the continuous law."""

    def law(setup: zc.Setup) -> Callable[[zc.LoopSample], float]:
        p = kp * setup.resolution if si else kp
        i = ki * setup.resolution * setup.sample_time / 2 if si else ki
        integral, before = setup.initial_integral, 0.0

        def torque(sample: zc.LoopSample) -> float:
            nonlocal integral, before
            if abs(sample.error) <= zone:
                integral = min(max(integral + i * (sample.error + before), setup.lowest_torque), setup.highest_torque)
            before = sample.error
            return integral + p * sample.error

        return torque

    return law


def test_a_trial_can_be_named_in_several_ways(axis: zc.Study, folder: pathlib.Path) -> None:
    """A study, the path of its manifest and a dict give the same trial, at a point by its number or label."""
    expected = zc.trial(axis, 3, 7)
    assert expected.inputs["controller.ki"] == axis.checked.axes[0]["values"][3]
    for of in (folder / "my-axis.yaml", str(folder / "my-axis.yaml"), axis.to_dict()):
        assert same_trace(zc.trial(of, 3, 7), expected)
    assert same_trace(zc.trial(axis, axis.labels[3], 7), expected) and same_trace(zc.trial(axis, np.int64(3), np.int64(7)), expected)


@pytest.mark.parametrize("point", range(8))
def test_an_integral_law_equals_the_built_in_one_bit_for_bit(axis: zc.Study, point: int) -> None:
    """The integral of the README's study in Python gives the same trials, at every gain."""
    gain = axis.checked.axes[0]["values"][point]
    for trial in (0, 17, 399):
        assert same_trace(zc.trial(axis, point, trial, pi(0, gain, si=True)), zc.trial(axis, point, trial))


AROUND: list[dict[str, Any]] = [
    {},
    {"delay": 1},
    {"delay": 0.4},
    {"filters": [{"lowpass": {"frequency": 400, "damping": 0.7}}, {"notch": {"frequency": 120, "damping": 0.5, "depth": 0.1}}]},
    {"filters": [{"biquad": {"b": [1, -0.5, 0], "a": [0.2, 0]}}], "delay": 2},
    {"feedforward": {"velocity": 0.02, "acceleration": 5.5e-4, "friction": 0.2}},
    {"observer": {"bandwidth": 10, "inertia": 5.54e-4}},
    {"dither": {"amplitude": 1e-4, "frequency": 500}, "missed": 0.01, "jitter": 1e-5},
]
"""What the manifest adds to the law."""


@pytest.mark.parametrize("around", AROUND, ids=str)
def test_a_proportional_and_integral_law_equals_the_built_in_one_bit_for_bit(around: dict[str, Any]) -> None:
    """kp, ki and a zone of the integral in Python give the same trials, with all that the manifest adds to them."""
    rng = random.Random(str(around))
    study = zc.study(
        {
            "zerocount": 1, "name": "law", "seed": rng.randrange(2**32), "trials": 1000,
            "friction": {"k1": {"uniform": [90, 130]}, "alpha": {"log_uniform": [0.1, 2]}},
            "encoder": {"fine_errors": {"noise": 0.02}}, "dac": {"noise": 1e-5},
            "command": {
                "targets": [{"integers": [-40, 40]}, 0], "hold": 0.25,
                "profile": {"shape": "s_curve", "velocity_limit": 0.05, "acceleration_limit": 1.0, "jerk_limit": 100.0},
            },
            "initial": {"encoder_phase": {"uniform": [0, 1]}, "integral": {"uniform": [-0.1, 0.1]}},
            "verdict": {"limit": 1e6},
        }
    )  # fmt: skip
    arrived = differing = 0
    for _ in range(8):
        kp, ki, zone = rng.choice([0.0, 10 ** rng.uniform(-5, -3.3)]), 10 ** rng.uniform(-5.5, -4), rng.choice([20, 100, 1e12])
        gains = {"kp": kp, "ki": ki, "integrator_zone": zone}
        built_in, trial = study.set(controller={**gains, **around}), rng.randrange(1000)
        expected = zc.trial(built_in, 0, trial)
        assert same_trace(zc.trial(built_in, 0, trial, pi(kp, ki, zone)), expected)
        arrived += bool(expected.outcome["arrived"].any())
        differing += not same_trace(zc.trial(built_in, 0, trial, pi(kp, ki * 1.01, zone)), expected)
    assert arrived > 0 and differing > 4


def test_a_sample_has_what_the_trace_records(axis: zc.Study) -> None:
    """What a law is given is what the trace has: time, error, count, reference and the torque before."""
    seen: list[tuple[float, ...]] = []
    setups = []

    def law(setup: zc.Setup) -> Callable[[zc.LoopSample], float]:
        setups.append((setup.sample_time, setup.resolution, setup.torque_resolution, setup.lowest_torque, setup.highest_torque))
        inner = pi(0, 1.2e4, si=True)(setup)

        def torque(sample: zc.LoopSample) -> float:
            seen.append((sample.k, sample.time, sample.error, sample.count, sample.reference, sample.torque, sample.new_target))
            assert (sample.velocity, sample.acceleration) == (0.0, 0.0)
            return inner(sample)

        return torque

    t = zc.trial(axis, 2, 5, law)
    assert setups[0] == pytest.approx((1 / 4000, 2 * np.pi / 1e6, 1e-4, -(2**15) * 1e-4, (2**15 - 1) * 1e-4), rel=1e-15)
    k, time_, error, count, reference, before, new = map(np.array, zip(*seen))
    assert np.array_equal(k, t.samples["k"]) and np.array_equal(time_, t.t) and np.array_equal(error, t.error)
    assert np.array_equal(count, t.samples["count"]) and np.array_equal(reference, t.samples["target"])
    assert np.array_equal(before, np.concatenate([[0.0], t.torque[:-1]]))
    assert np.array_equal(np.flatnonzero(new), [2000])


def test_a_law_reads_the_encoder_of_the_other_mass() -> None:
    """With an encoder on each mass a law is given the resolution and the counts of both."""
    study = zc.study(
        {
            "zerocount": 1, "name": "two-encoders", "seed": 1, "trials": 1, "controller": {"ki": 2e-5},
            "plant": {"load": {"inertia": 1e-3, "stiffness": 1000, "damping": 0.05}},
            "encoder": {"fine": 1000000, "load": {"counts_per_revolution": 360000}},
            "command": {"targets": [2000], "hold": 0.2},
        }
    )  # fmt: skip
    seen: list[tuple[float, float]] = []

    def law(setup: zc.Setup) -> Callable[[zc.LoopSample], float]:
        assert setup.other_resolution == pytest.approx(2 * np.pi / 360000, rel=1e-15)
        return lambda sample: seen.append((sample.count, sample.other_count)) or 2e-5 * sample.error

    t = zc.trial(study, 0, 0, law)
    count, other = map(np.array, zip(*seen))
    assert np.array_equal(count, t.samples["count"]) and np.array_equal(other, t.samples["load_count"]) and other.max() > 20


def test_a_law_is_set_up_once(axis: zc.Study) -> None:
    """A law is called once for a trial, before its first sample."""
    calls: list[str] = []

    def law(setup: zc.Setup) -> Callable[[zc.LoopSample], float]:
        calls.append("setup")
        return lambda sample: calls.append("sample") or 0.0

    zc.trial(axis, 0, 0, law)
    assert calls == ["setup"] + ["sample"] * 4000


def failing(error: BaseException, at: int) -> zc.ControlLaw:
    """A law that raises an exception at a sample; at -1 when it is set up."""

    def law(setup: zc.Setup) -> Callable[[zc.LoopSample], float]:
        if at < 0:
            raise error

        def torque(sample: zc.LoopSample) -> float:
            if sample.k == at:
                raise error
            return 0.0

        return torque

    return law


class OwnError(BaseException):
    """An exception that nobody else knows."""


@pytest.mark.parametrize("at", [-1, 0, 1, 3999])
@pytest.mark.parametrize("kind", [ValueError, KeyError, OwnError, SystemExit, StopIteration, KeyboardInterrupt])
def test_an_exception_of_a_law_arrives_unchanged(axis: zc.Study, kind: type[BaseException], at: int) -> None:
    """The exception that a law raises is the one that the caller catches, with its traceback."""
    error = kind("a", 1)
    with pytest.raises(kind) as raised:
        zc.trial(axis, 0, 0, failing(error, at))
    assert raised.value is error
    assert raised.traceback[-1].name == ("law" if at < 0 else "torque")


@pytest.mark.parametrize("value", [None, "1", [1.0], 1j, np.zeros(2), object()], ids=lambda value: type(value).__name__)
def test_a_wrong_type_of_torque_is_refused(axis: zc.Study, value: Any) -> None:
    """A torque that is no number gives a TypeError with the type."""
    with pytest.raises(TypeError, match=f"the control law returned {type(value).__name__} at a sample; expected a torque, a number"):
        zc.trial(axis, 0, 0, lambda setup: lambda sample: value)


@pytest.mark.parametrize("value", [0, True, np.float64(0.1), np.float32(0.1), np.int8(1), np.array(0.1)], ids=repr)
def test_python_and_numpy_numbers_are_torques(axis: zc.Study, value: Any) -> None:
    """Numbers of Python and NumPy are torques."""
    expected = zc.trial(axis, 0, 0, lambda setup: lambda sample: float(value))
    assert same_trace(zc.trial(axis, 0, 0, lambda setup: lambda sample: value), expected)


def test_a_law_must_return_a_function(axis: zc.Study) -> None:
    """A law that gives no function for the setup, or cannot be called with it, is refused."""
    with pytest.raises(TypeError, match="the controller returned float for the setup of the trial; expected a function of a sample"):
        zc.trial(axis, 0, 0, lambda setup: 1.0)
    with pytest.raises(TypeError):
        zc.trial(axis, 0, 0, lambda: None)
    with pytest.raises(TypeError):
        zc.trial(axis, 0, 0, 5)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
@pytest.mark.parametrize("at", [0, 100, 2500])
def test_a_torque_that_is_not_finite_ends_the_trial(axis: zc.Study, value: float, at: int) -> None:
    """The move with such a torque and those after it are nonfinite; no sample follows."""
    t = zc.trial(axis, 2, 1, lambda setup: lambda sample: value if sample.k >= at else 0.0)
    assert list(t.outcome["outcome"][at // 2000 :]) == ["nonfinite"] * (2 - at // 2000)
    assert "nonfinite" not in t.outcome["outcome"][: at // 2000]
    assert len(t.t) in (at, at + 1)


def test_two_phases_are_refused() -> None:
    """A study with a coarse phase has no law in Python."""
    for name in ("repeatability", "contact-variation", "two-encoders"):
        with pytest.raises(zc.ManifestError, match="two phases of control.*without controller.coarse"):
            zc.trial(shipped(name), 0, 0, pi(0, 1e-5))



@pytest.fixture
def interrupted_soon() -> Iterator[None]:
    """A signal in 0.3 s, whose handler raises KeyboardInterrupt."""

    def handler(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, handler)
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    yield
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


def test_an_interruption_stops_a_trial(axis: zc.Study, interrupted_soon: None) -> None:
    """A signal stops a trial with a law, also one that runs no code of Python between samples."""
    long = axis.set(**{"command.hold": 2500})  # 20 million samples
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        zc.trial(long, 0, 0, lambda setup: operator.attrgetter("torque"))
    assert time.monotonic() - start < 1.5


def test_an_interruption_stops_a_trial_of_the_manifest(axis: zc.Study, interrupted_soon: None) -> None:
    """A signal stops a trial with the built-in law, too."""
    long = axis.set(**{"command.hold": 400})  # 3.2 million samples
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        zc.trial(long)
    assert time.monotonic() - start < 1.0


def test_an_interruption_stops_a_sample(axis: zc.Study, interrupted_soon: None) -> None:
    """A signal stops the trials of a large sample; the function can be called again."""
    f = zc.sample(axis, 2)
    x = np.tile(f.draw(1000), (200, 1))
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        f(x)
    assert time.monotonic() - start < 2.0
    assert len(f(x[:3])) == 3


@pytest.mark.long
def test_other_threads_run_beside_a_sample(axis: zc.Study) -> None:
    """Python's lock is free while trials are simulated: another thread makes progress, and may simulate too."""
    f = zc.sample(axis, 2, outcome="arrival_time", threads=1)
    x = f.draw(4000)
    expected = f(x[:300])
    steps, stop, beside = [0], threading.Event(), []

    def count() -> None:
        beside.append(f(x[:300]))
        while not stop.wait(0.005):
            steps[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    start = time.monotonic()
    f(x)
    lasted = time.monotonic() - start
    stop.set()
    thread.join()
    assert steps[0] > 0.2 * lasted / 0.005 > 5
    assert np.array_equal(beside[0], expected, equal_nan=True)
