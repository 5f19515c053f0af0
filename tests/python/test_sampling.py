"""A study as a function of its random variables: values, distributions, random numbers and errors."""

from __future__ import annotations

import math
import pathlib
import signal
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import openturns
import pandas
import pytest
import scipy.stats
import zerocount as zc
from support import inputs_of, same, shipped
from zerocount.tables import short_name

# OpenTURNS takes the signal of Ctrl-C for itself, and ends the process by it. Other tests need it.
signal.signal(signal.SIGINT, signal.getsignal(signal.SIGINT))


@pytest.fixture(scope="module", autouse=True)
def interruptible_afterwards() -> Iterator[None]:
    """Gives the signal back to Python after OpenTURNS was used."""
    yield
    signal.signal(signal.SIGINT, signal.getsignal(signal.SIGINT))


ResultsOf = Callable[[str], zc.Results]

EVERY_KIND: dict[str, dict[str, Any]] = {
    "friction.k1": {"uniform": [90.0, 130.0]},
    "friction.beta": {"log_uniform": [5e4, 2e5]},
    "dac.offset": {"normal": {"mean": 1e-4, "sd": 2e-4}},
    "friction.lambda": {"truncated_normal": {"mean": 8.0, "sd": 3.0, "low": 5.0, "high": 20.0}},
    "friction.k2": {"lognormal": {"median": 600.0, "cv": 0.3}},
    "friction.alpha": {"triangular": [0.1, 0.3, 2.0]},
    "friction.n": {"triangular": [1.5, 2.5, 2.5]},
    "command.targets.0": {"integers": [-3, 30]},
    "controller.delay": {"choice": [0.0, 0.5, 0.0, 1.0]},
    "initial.encoder_phase": {"uniform": [0.0, 1.0]},
}
CORRELATION = [["friction.k1", "friction.k2", 0.6], ["friction.beta", "friction.k1", -0.5], ["controller.delay", "friction.alpha", 0.7]]


def scipy_of(form: dict[str, Any]) -> Any:
    """A distribution of a manifest as one of SciPy."""
    ((kind, given),) = form.items()
    if kind == "uniform":
        return scipy.stats.uniform(given[0], given[1] - given[0])
    if kind == "log_uniform":
        return scipy.stats.loguniform(*given)
    if kind == "normal":
        return scipy.stats.norm(given["mean"], given["sd"])
    if kind == "truncated_normal":
        low, high = ((given[end] - given["mean"]) / given["sd"] for end in ("low", "high"))
        return scipy.stats.truncnorm(low, high, given["mean"], given["sd"])
    if kind == "lognormal":
        return scipy.stats.lognorm(math.sqrt(math.log1p(given["cv"] ** 2)), scale=given["median"])
    if kind == "triangular":
        low, mode, high = given
        return scipy.stats.triang((mode - low) / (high - low), low, high - low)
    values = np.arange(given[0], given[1] + 1) if kind == "integers" else np.array(given)
    places, counts = np.unique(values, return_counts=True)
    return scipy.stats.rv_discrete(values=(np.arange(len(places)), counts / len(values))), places


@pytest.fixture(scope="module")
def every_kind(axis: zc.Study) -> zc.Study:
    """The README's study with a variable of every distribution, some of them correlated."""
    settings = {**EVERY_KIND, "correlation": CORRELATION}
    return axis.without("sweep", "machines", "goal").set(**{"controller.ki": 1.2e4, "command.hold": 0.1, "encoder.fine_errors.noise": 0}).set(**settings)


def is_discrete(form: dict[str, Any]) -> bool:
    return next(iter(form)) in ("integers", "choice")


def test_draws_have_the_distributions_of_the_manifest(every_kind: zc.Study) -> None:
    """Drawn values have the distribution of their key, by SciPy, and the forms are those of the manifest."""
    f = zc.sample(every_kind)
    assert sorted(f.names) == sorted(EVERY_KIND)
    x = f.draw(20000, rng=7)
    for name, unit, form, values in zip(f.names, f.units, f.distributions, x.T):
        assert repr(form).replace("(", "[").replace(")", "]") == repr(EVERY_KIND[name])
        assert unit == next(column["unit"] for column in every_kind.checked.inputs if column["name"] == name)
        if is_discrete(form):
            expected, places = scipy_of(form)
            found = np.array([(values == place).sum() for place in places])
            assert found.sum() == len(x)
            probability = scipy.stats.chisquare(found, expected.pmf(np.arange(len(places))) * len(x)).pvalue
        else:
            probability = scipy.stats.kstest(values, scipy_of(form).cdf).pvalue
        assert 1e-3 < probability, name
    assert same(x, f.draw(20000, rng=7)) and not same(x, f.draw(20000, rng=8))
    assert same(x, f.draw(20000, rng=np.random.default_rng(7)))
    with pytest.warns(DeprecationWarning, match="seed is called rng"):
        assert same(x, f.draw(20000, seed=7))
    with pytest.raises(zc.ArgumentError, match="draw: rng is 'x'.*expected a whole number or a Generator of NumPy"):
        f.draw(3, rng="x")  # type: ignore[arg-type]


def test_draws_have_the_correlations_of_the_manifest(every_kind: zc.Study) -> None:
    """The normal scores of drawn values have the listed correlations, and no others."""
    f = zc.sample(every_kind)
    expected = np.eye(len(f.names))
    for one, other, coefficient in CORRELATION:
        i, j = f.names.index(one), f.names.index(other)
        expected[i, j] = expected[j, i] = coefficient
    assert np.allclose(f.correlations, expected, atol=1e-12)
    x = f.draw(20000, rng=3)
    continuous = [place for place, form in enumerate(f.distributions) if not is_discrete(form)]
    scores = np.column_stack([scipy.stats.norm.ppf(scipy_of(f.distributions[place]).cdf(x[:, place])) for place in continuous])
    found = np.corrcoef(scores.T)
    assert np.abs(found - expected[np.ix_(continuous, continuous)]).max() < 4 / math.sqrt(len(x))
    delay, alpha = (x[:, f.names.index(name)] for name in ("controller.delay", "friction.alpha"))
    assert np.median(alpha[delay == 1.0]) > np.median(alpha) * 1.2 > np.median(alpha[delay == 0.0]) * 1.2


def test_openturns_has_the_same_distribution(every_kind: zc.Study) -> None:
    """The joint distribution for OpenTURNS has the quantiles and correlations of `draw`, and its draws are accepted."""
    f = zc.sample(every_kind, outcome="arrival_time")
    joint = f.distribution
    assert list(joint.getDescription()) == f.names
    u = np.linspace(0.0005, 0.9995, 500)
    ours = f._study.checked.values_at_scores(0, np.tile(scipy.stats.norm.ppf(u)[:, np.newaxis], len(f.names)))
    for place, form in enumerate(f.distributions):
        marginal = joint.getMarginal(place)
        if next(iter(form)) == "choice":  # goes by the order of its list
            values, counts = np.unique(form["choice"], return_counts=True)
            assert [marginal.computePDF(value) for value in values] == pytest.approx(counts / counts.sum())
        else:
            theirs = np.array([marginal.computeQuantile(float(p))[0] for p in u])
            assert np.allclose(ours[:, place], theirs, rtol=1e-9, atol=1e-12), f.names[place]
    assert np.allclose(np.array(joint.getCopula().getParameter()), f.correlations[np.tril_indices(len(f.names), -1)], atol=1e-12)
    openturns.RandomGenerator.SetSeed(1)
    assert np.isfinite(f(np.array(joint.getSample(500)))).mean() > 0.5


def test_openturns_has_the_same_function(every_kind: zc.Study) -> None:
    """The function for OpenTURNS gives what a call gives, for a sample and for a point."""
    f = zc.sample(every_kind, outcome="peak_torque")
    x = f.draw(40, rng=2)
    function = f.function
    assert list(function.getInputDescription()) == f.names and list(function.getOutputDescription()) == ["peak_torque"]
    assert same(np.array(function(openturns.Sample(x))).ravel(), f(x))
    assert function(x[3])[0] == f(x[3]) and isinstance(f(x[3]), float)
    failed = zc.sample(every_kind, outcome=lambda measures: ~measures["stable"].all(axis=1))
    assert same(np.array(failed.function(x)).ravel(), failed(x)) and set(failed(x)) == {0.0, 1.0}


RECORDED = ["unknown-friction", "sample-rate", "initial-conditions", "contact-variation", "two-encoders", "stability-map"]


@pytest.mark.parametrize("name", ["first", *RECORDED])
def test_the_inputs_of_trials_give_their_recorded_outcomes(name: str, first: zc.Results, results_of: ResultsOf) -> None:
    """With the inputs of recorded trials the function gives their measures; some may differ, for a value that rounds."""
    r = first if name == "first" else results_of(name)
    points = sorted({0, len(r.checked.labels) // 2, len(r.checked.labels) - 1})
    trials = r.trials()
    measures = ["success", "arrival_time", "peak_torque", "jerk_count", "final_error", "band_settling_time[0]"]
    equal = total = 0
    for point in points:
        mine = trials[trials["point"] == point]
        f = zc.sample(r.study, point)
        x = inputs_of(r.path, f.names, point)
        found = f.trials(x)
        for measure in measures:
            f = zc.sample(r.study, point, outcome=measure)
            values = np.asarray(f._outcome_of(found), dtype=float)
            equal += np.isclose(values, mine[measure].to_numpy(dtype=float), rtol=1e-12, atol=0, equal_nan=True).sum()
            total += len(values)
    assert total - equal <= 0.005 * total + 2


def test_the_success_rate_over_draws_agrees_with_the_study(first: zc.Results) -> None:
    """The mean over draws agrees with the rate of the study, within the spread of both."""
    for point in (2, 4):
        f, row = zc.sample(first.study, point), first.table.loc[point]
        n, rate = 500, row["success_rate"]
        mean = f(f.draw(n, rng=point)).mean()
        assert abs(mean - rate) < 4 * math.sqrt(rate * (1 - rate) * (1 / n + 1 / 200))  # 400 trials on 200 machines


def test_a_profile_is_given_by_its_mean_and_score(folder: pathlib.Path) -> None:
    """The profile of each trial is drawn anew; the success over draws is that of a study with many machines."""
    study = zc.study(
        {
            "zerocount": 1, "name": "profile", "seed": 5, "machines": 1500, "trials": 1500,
            "friction": {"k1": {"profile": {"mean": {"lognormal": {"median": 110, "cv": 0.1}}, "cv": 0.2, "correlation_length": 0.2}}},
            "controller": {"ki": 9e-5}, "command": {"targets": [{"integers": [1, 30]}], "hold": 0.3},
            "initial": {"encoder_phase": {"uniform": [0, 1]}, "position": {"uniform": [0, 6.283185307179586]}},
        }
    )  # fmt: skip
    f = zc.sample(study)
    score, mean = (place for place, name in enumerate(f.names) if name.startswith("friction.k1"))
    score, mean = (score, mean) if "normal" in f.distributions[score] else (mean, score)
    assert f.distributions[score] == {"normal": {"mean": 0.0, "sd": 1.0}} and f.units[score] == "1"
    assert f.distributions[mean] == {"lognormal": {"median": 110.0, "cv": 0.1}}
    x = f.draw(1500, rng=1)
    rate = study.run(folder / "profile.h5").table.loc[0, "success_rate"]
    assert 0.1 < rate < 0.9 and abs(f(x).mean() - rate) < 4 * math.sqrt(2 * rate * (1 - rate) / 1500)
    x[:, mean] = 110
    soft, middle, stiff = (f(np.where(np.arange(len(f.names)) == score, value, x)).mean() for value in (-2.0, 0.0, 2.0))
    assert soft < middle - 0.05 and middle < stiff - 0.2
    g = zc.sample(study.set(**{"friction.k1": 110}))
    there = [f.names.index(name) for name in g.names]
    x[:, score] = math.log(math.hypot(1, 0.2)) / 2 / math.sqrt(math.log1p(0.04))  # where k1 is its mean
    assert np.mean(f(x) == g(x[:, there])) > 0.95


JOINT = """\
zerocount: 1
name: joint
seed: 3
trials: 60
samples: posterior.csv
controller: {ki: 5.0e-5}
command: {targets: [{integers: [1, 30]}], hold: 0.3}
initial: {encoder_phase: {uniform: [0, 1]}}
"""
ROWS = [(108, 741.5, 81200), (111.9, 752.3, 79650), (75, 700, 1.1e5), (130, 620, 1.3e5)]


def test_a_row_of_joint_samples_is_one_variable(tmp_path: pathlib.Path) -> None:
    """A row is one variable; its values are those of the table."""
    (tmp_path / "joint.yaml").write_text(JOINT, encoding="utf-8")
    lines = ["friction.k1,friction.k2,friction.beta", *(",".join(map(str, row)) for row in ROWS)]
    (tmp_path / "posterior.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    study = zc.study(tmp_path / "joint.yaml")
    f = zc.sample(study, outcome="peak_torque")
    (place,) = (place for place, form in enumerate(f.distributions) if form == {"integers": (0, 3)})
    assert len(f.names) == 3 and f.names[place] not in ("command.targets.0", "initial.encoder_phase")
    x = f.draw(60)
    assert set(x[:, place]) == {0.0, 1.0, 2.0, 3.0}
    for number, row in enumerate(ROWS):
        x[:, place] = number
        values = dict(zip(("friction.k1", "friction.k2", "friction.beta"), row))
        g = zc.sample(study.without("samples").set(**values), outcome="peak_torque")
        assert same(f(x), g(x[:, [f.names.index(name) for name in g.names]]))
    x[5, place] = 4
    with pytest.raises(zc.ManifestError, match=f"{f.names[place]} = 4 cannot be drawn"):
        f(x)


@pytest.fixture(scope="module")
def noisy(axis: zc.Study) -> zc.Study:
    """The README's study with noise, missed samples and a profile: outcomes depend on the numbers of trials."""
    noise = {"encoder.fine_errors.noise": 0.3, "dac.noise": 1e-4, "controller.missed": 0.01, "initial.history.reversals": 3}
    profile = {"profile": {"mean": 90, "cv": 0.2, "correlation_length": 0.1}}
    return axis.set(**noise, **{"initial.history.torque": 0.05, "friction.k1": profile, "command.hold": 0.1})


def test_equal_numbers_give_equal_outcomes(noisy: zc.Study) -> None:
    """An outcome depends on the values and the number of its trial, not on threads, blocks or order."""
    f = zc.sample(noisy, 3, outcome="peak_torque")
    x = f.draw(150, rng=4)
    expected = f(x, first=1000)
    for threads in (1, 2, 5):
        assert same(zc.sample(noisy, 3, outcome="peak_torque", threads=threads)(x, first=1000), expected)
    parts = [f(x[first : first + 37], first=1000 + first) for first in range(0, 150, 37)]
    assert same(np.concatenate(parts), expected)
    assert [f(x[i], first=1000 + i) for i in (149, 3, 77, 0)] == expected[[149, 3, 77, 0]].tolist()
    assert (f(x) != expected).mean() > 0.5
    assert (f(np.tile(x[0], (50, 1))) != expected[0]).any()


def test_set_keeps_the_machines(noisy: zc.Study) -> None:
    """Other gains are tried on the same machines with the same noise; the point of a sweep can have another gain."""
    f = zc.sample(noisy, 3, outcome="peak_torque")
    x = f.draw(60, rng=5)
    for settings in ({"controller.kp": 20.0}, {"controller.delay": 2}, {"controller.ki": 3e4}):
        g = f.set(settings)
        assert (g.names, g.distributions, g.outcome) == (f.names, f.distributions, f.outcome) and same(g.correlations, f.correlations)
        there = noisy.without("sweep").set({"controller.ki": noisy.checked.axes[0]["values"][3], **settings})
        assert same(g(x), zc.sample(there, outcome="peak_torque")(x))
        assert (g(x) != f(x)).mean() > 0.5
    assert same(f.set(description="other words", seed=noisy.checked.seed)(x), f(x))
    with pytest.raises(zc.ManifestError, match="the variables would not be the same"):
        f.set({"friction.k2": 600})


def test_columns_of_a_table_are_matched_by_name(first: zc.Results, every_kind: zc.Study, results_of: ResultsOf) -> None:
    """The columns of a DataFrame are the variables, in full or short; a missing one is refused, and a value that is no score."""
    f = zc.sample(first, 2, outcome="peak_torque")
    trials = first.trials(2).iloc[:50]
    expected = f(inputs_of(first.path, f.names, 2)[:50])
    assert same(f(trials), expected) and same(f(trials.sample(frac=1, axis=1, random_state=1)), expected)
    full = pandas.DataFrame(inputs_of(first.path, f.names, 2)[:50], columns=f.names)
    assert same(f(full), expected) and same(f.trials(full)["arrival"], f.trials(trials)["arrival"])
    with pytest.raises(zc.ManifestError, match="x lacks the columns (friction.)?k1"):
        f(trials.drop(columns="k1"))
    g = zc.sample(every_kind, outcome="peak_torque")
    x = g.draw(20)
    short = pandas.DataFrame(x, columns=[short_name(name, g.names) for name in g.names])
    assert same(g(short), g(x))  # DEFECT: a variable without a unit, such as friction.n, is not found by its short name
    r = results_of("delay")
    try:  # k1 is a stiffness in the table of trials, and the score of a profile in the sample
        found = zc.sample(r, 0)(r.trials(0))
    except zc.ManifestError as error:
        assert "friction.k1" in str(error)
    else:
        assert abs(found.mean() - r.trials(0)["success"].mean()) < 0.2


def test_outcomes_are_the_measures_of_trials(first: zc.Results) -> None:
    """Every measure of the trials is an outcome, combined over the moves as in the table of trials."""
    trials = first.trials(2).iloc[:40]
    f = zc.sample(first, 2)
    x = inputs_of(first.path, f.names, 2)[:40]
    measures = f.trials(x)
    assert all(values.shape == (40, 2) for values in measures.values())
    for name in measures:
        if name != "outcome":
            found = zc.sample(first, 2, outcome=name)(x)
            expected = trials[name].to_numpy(dtype=float)
            assert np.isclose(found, expected, rtol=1e-12, atol=0, equal_nan=True).mean() >= 0.95, name
    with pytest.raises(zc.ManifestError, match="a number for each trial"):
        zc.sample(first, 2, outcome=lambda measures: measures["arrival_time"])(x)
    late = zc.sample(first, 2, outcome=lambda measures: (measures["arrival_time"] > 0.05).sum(axis=1))
    assert same(late(x), (measures["arrival_time"] > 0.05).sum(axis=1).astype(float))


OUTSIDE = {
    "friction.k1": [89.9, 130.0, np.nan], "friction.beta": [4.9e4, 2e5, -1.0], "dac.offset": [np.nan, np.inf],
    "friction.lambda": [4.99, 20.0], "friction.k2": [0.0, -1.0, np.inf], "friction.alpha": [0.09, 2.0, -np.inf],
    "command.targets.0": [-4, 31, 0.5], "controller.delay": [0.25, 2, -0.5], "initial.encoder_phase": [-1e-9, 1.0],
}  # fmt: skip


@pytest.mark.parametrize("name", OUTSIDE)
def test_a_value_that_cannot_be_drawn_is_refused(every_kind: zc.Study, name: str) -> None:
    """A value outside the distribution of its variable is refused with the name and the value."""
    f = zc.sample(every_kind)
    x = f.draw(5)
    for value in OUTSIDE[name]:
        wrong = x.copy()
        wrong[3, f.names.index(name)] = value
        with pytest.raises(zc.ManifestError, match=rf"{name} = {value:g} cannot be drawn".replace("+", r"\+")):
            f(wrong)
    assert len(f(x)) == 5


def test_wrong_calls_are_refused(every_kind: zc.Study, axis: zc.Study) -> None:
    """Wrong shapes, numbers, points and outcomes, and a study without variables, are refused with what is expected."""
    f = zc.sample(every_kind)
    x = f.draw(3)
    for wrong in (x[:, :-1], x[0, 1:], np.empty((2, 2, len(f.names))), []):
        with pytest.raises(zc.ManifestError, match="expected a column for each of the 10 variables"):
            f(wrong)
    assert f(x[:0]).shape == (0,) and f.draw(0).shape == (0, 10)
    for number in (-1, 2**32 - 2):
        with pytest.raises(zc.ManifestError, match=f"first = {number} is out of range; expected 0 to {2**32 - 3}"):
            f(x, first=number)
    assert len(f(x, first=2**32 - 3)) == 3
    for point in (-1, 8, "none"):
        with pytest.raises(zc.ManifestError, match="expected 0 to 7"):
            zc.sample(axis, point)
    with pytest.raises(zc.ManifestError, match="there is no measure 'speed'; expected success or one of"):
        zc.sample(axis, outcome="speed")
    with pytest.raises(zc.ManifestError, match="rest_error_rms"):
        zc.sample(axis, outcome="rest_error_rms")(zc.sample(axis).draw(1))
    certain = zc.study({"zerocount": 1, "name": "certain", "seed": 1, "trials": 1, "command": {"targets": [5], "hold": 0.1}})
    with pytest.raises(zc.ManifestError, match="certain: nothing is drawn for its trials"):
        zc.sample(certain)


def test_a_study_can_be_named_in_several_ways(axis: zc.Study, first: zc.Results, folder: pathlib.Path) -> None:
    """A study, results and the path of a manifest give the same function."""
    path = folder / "my-axis.yaml"
    functions = [zc.sample(of, 2, outcome="peak_torque") for of in (axis, first, path, str(path), axis.to_dict())]
    functions.append(zc.sample(axis, axis.labels[2], outcome="peak_torque"))
    x = functions[0].draw(20)
    assert all(f.names == functions[0].names and same(f(x), functions[0](x)) for f in functions)


def test_a_sample_needs_one_condition(axis: zc.Study) -> None:
    """Under a condition the function is that of the study with its overrides; without one it is not defined."""
    study = zc.study({**axis.to_dict(), "conditions": {"empty": {}, "loaded": {"plant.inertia": 9.0}}}).set(trials=32000)
    with pytest.raises(zc.ManifestError, match="condition= one of empty, loaded"):
        zc.sample(study, 2)
    with pytest.raises(zc.ManifestError, match="no condition 'hot'; expected one of empty, loaded"):
        zc.sample(study, 2, condition="hot")
    for condition, alone in (("empty", axis), ("loaded", axis.set({"plant.inertia": 9.0}))):
        f, g = zc.sample(study, 2, outcome="peak_torque", condition=condition), zc.sample(alone, 2, outcome="peak_torque")
        x = g.draw(20)
        assert f.names == g.names and same(f(x), g(x))
        assert same(f.set({"controller.ki": 2e4})(x), g.set({"controller.ki": 2e4})(x))


def test_the_number_of_a_trial_decides_its_world() -> None:
    """What is drawn for a world is no variable: it follows from the number of the trial."""
    study = shipped("unknown-friction")
    f = zc.sample(study, 2, outcome="peak_torque")
    assert not {"friction.alpha", "friction.beta", "friction.n"} & set(f.names)
    x = np.tile(f.draw(1), (16, 1))
    found = f(x)
    assert same(found[:8], found[8:]) and len(set(found)) > 5
