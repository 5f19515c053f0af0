"""Several goals of a study, and goals on some of the moves, counted again from the recorded measures."""

from __future__ import annotations

import pathlib

import pytest
import zerocount as zc

MANIFEST = """\
zerocount: 1
name: two-goals
seed: 5
machines: 20
trials: 100
goals:
  first: {on: [0], tolerance: 4.0e-6, after_profile: 0.15, moves: 0.5, machines: 0.5, limits: {overshoot: 3}}
  second: {on: [1], band: 1, within: 0.1, moves: 0.5, limits: {"band_exits[1]": 0, "tolerance_settling_time[1.0e-5]": 0.05}}
friction: {k1: {uniform: [90, 130]}}
controller: {sample_rate: 2000, ki: {uniform: [2.0e-5, 6.0e-5]}}
command: {targets: [{integers: [1, 30]}, {integers: [-30, 30]}], hold: 0.3, profile: {shape: trapezoidal, velocity_limit: 0.01, acceleration_limit: 2}}
initial: {encoder_phase: {uniform: [0, 1]}}
sweep: {grid: {controller.delay: [0, 2]}}
"""


@pytest.fixture(scope="module")
def results(folder: pathlib.Path) -> zc.Results:
    """Results of the study with two goals."""
    path = folder / "two-goals.yaml"
    path.write_text(MANIFEST)
    return zc.study(path).run(folder / "two-goals.h5")


def test_moves_meet_the_goals_that_are_about_them(results: zc.Results) -> None:
    """A move meets a goal within its time and its limits; the other goal says nothing of it."""
    moves = results.moves().reset_index()
    first = (moves["tolerance_settling_time[4e-06]"] <= (moves["travel_time"] + 0.15) * (1 + 1e-9)) & (moves["overshoot"] <= 3)
    second = (moves["band_settling_time[1]"] <= 0.1 * (1 + 1e-9)) & (moves["band_exits[1]"] == 0)
    in_time = moves["tolerance_settling_time[1e-05]"] <= 0.05 * (1 + 1e-9)
    assert (second & ~in_time).any()
    second &= in_time
    expected = first.where(moves["move"] == 0, second)
    assert 0.02 < expected.mean() < 0.98
    assert (moves["goal_met"] == expected).all()


def test_the_summary_counts_moves_by_goal(results: zc.Results) -> None:
    """The rate of each goal is that of its own moves, and the goal of a point is the worst of them."""
    moves = results.moves(inputs=True).reset_index()
    for point in results.summary["points"]:
        of_point = moves[moves["point"] == point["point"]]
        for move, name in enumerate(("first", "second")):
            rate = of_point[of_point["move"] == move]["goal_met"].mean()
            assert point["goals"][name]["rate"] == pytest.approx(rate, abs=1e-12)
        assert point["goal"] == {**point["goals"][point["goal"]["name"]], "name": point["goal"]["name"]} | (
            {"machines": None, "machines_low": None, "machines_high": None} if point["goal"]["name"] == "second" else {}
        )


def test_several_goals_are_named(results: zc.Results) -> None:
    """A study with several goals has no single one."""
    assert results.study.goal is None
    assert [goal["name"] for goal in results.study.goals] == ["first", "second"]
    assert results.study.goals[1]["limits"] == {"band_exits[1]": 0.0, "tolerance_settling_time[1e-05]": 0.05}


def test_the_headline_names_every_missed_goal(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """Two goals that no move can meet are both named, and the one that is met is not."""
    never, always = {"band": 0, "within": 1e-3, "moves": 0.9}, {"band": 10000, "within": 0.5, "moves": 0.5}
    study = axis.without("goal").set({"goals": {"early": never, "wide": always, "soon": never}}, trials=200).at(2)
    headline = study.run(tmp_path / "goals.h5", progress=False).judge().headline
    assert "the goals 'early' and 'soon' are missed" in headline


def test_friction_without_a_smallest_value_cannot_hold_a_load(axis: zc.Study) -> None:
    """The message says so, and not that the friction is 0."""
    held = axis.set({"initial.holding": True, "disturbance.torque": 1e-3, "friction.breakaway": {"lognormal": {"median": 0.3, "cv": 0.2}}})
    with pytest.raises(zc.ManifestError, match="friction.breakaway is drawn without a smallest value above 0"):
        held.labels
    assert axis.set({"initial.holding": True, "disturbance.torque": 1e-3, "friction.breakaway": {"uniform": [0.2, 0.4]}}).labels
