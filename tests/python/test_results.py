"""Results files as tables, beside the datasets, the CSV and the JSON of the program."""

from __future__ import annotations

import dataclasses
import json
import pathlib
import pickle
import random
from collections.abc import Callable
from typing import Any

import h5py
import numpy as np
import pandas as pd
import pytest
import zerocount as zc
from support import SHIPPED, by_program, dear_by_night, program, same, same_trace
from zerocount.tables import short_name

ResultsOf = Callable[[str], zc.Results]

CLOSED = ["unknown-friction", "linear-stage", "repeatability", "contact-variation"]
OPEN = ["identification", "paper-fig4"]


def exported(r: zc.Results, folder: pathlib.Path) -> dict[str, pd.DataFrame]:
    """The tables of `zerocount export`, with the units of their columns in ``attrs``."""
    by_program("export", r.path, "-o", folder)
    tables = {}
    for path in folder.glob("*.csv"):
        table = pd.read_csv(path, float_precision="round_trip", keep_default_na=False, na_values=["nan", "NaN", ""])
        units = {}
        for name in table:
            base, _, unit = name.partition(" [")
            units[base] = unit.rstrip("]") if unit else "1"
        table.columns = list(units)
        table.attrs["units"] = units
        tables[path.stem] = table
    return tables


def column_of(table: pd.DataFrame, name: str) -> str:
    """The only column of a table that a full name can mean."""
    (found,) = {column for column in table if column == name or name.endswith("." + column)}
    return found


def assert_same_table(table: pd.DataFrame, expected: pd.DataFrame) -> None:
    """A table has all columns of a CSV, with equal values and units."""
    assert len(table) == len(expected)
    for name in expected:
        column = column_of(table, name)
        values = table[column].astype(object).to_numpy() if table[column].dtype == "category" else table[column].to_numpy()
        wanted = expected[name].to_numpy()
        if values.dtype.kind in "bif":
            assert same(values.astype(float), wanted.astype(float)), name
            assert table.attrs["units"].get(column, "1") == expected.attrs["units"][name], name
        else:
            assert values.tolist() == wanted.tolist(), name


def flat(record: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Numbers of a point of the summary by the names of their datasets."""
    result: dict[str, Any] = {}
    for key, value in record.items():
        if isinstance(value, dict):
            result.update(flat(value, f"{prefix}{key}_"))
        elif isinstance(value, (int, float)) or value is None:
            result[prefix + key] = value
    for of_band in record.get("bands", []):
        for name, value in flat({k: v for k, v in of_band.items() if k != "band"}, "band_").items():
            result[f"{name}[{of_band['band']}]"] = value
    return result


@pytest.fixture(params=["small", *dear_by_night(CLOSED)])
def results(request: pytest.FixtureRequest, small: zc.Results, results_of: ResultsOf) -> zc.Results:
    """Results of closed loops: trials on machines, in worlds, with profiles, of a sequence, of a linear axis."""
    return small if request.param == "small" else results_of(request.param)


def test_tables_equal_those_of_export(results: zc.Results, tmp_path: pathlib.Path) -> None:
    """Statistics, inputs, moves and jerks have the values and units of the exported CSV."""
    tables = exported(results, tmp_path / "csv")
    assert_same_table(results.statistics.reset_index(), tables["points"])
    assert set(tables["trials"]) == {"trial", "point", "index", *inputs(results)}
    assert_same_table(results.trials().reset_index(), tables["trials"])
    assert_same_table(results.moves().reset_index(), tables["outcomes"])
    assert_same_table(results.jerks(), tables["jerks"])


def inputs(r: zc.Results) -> list[str]:
    """Full names of the inputs."""
    with h5py.File(r.path) as file:
        return list(file["trial/input"])


def test_the_table_has_the_statistics_of_the_summary(results: zc.Results) -> None:
    """Every number of `zerocount summary --format json` that the statistics have too is the same."""
    answer = json.loads(by_program("summary", results.path, "--format", "json"))
    table, compared = results.statistics, 0
    for point in answer["points"]:
        for name, value in flat(point).items():
            if name in table:
                stored = table.loc[point["point"], name]
                assert value == stored or (value is None and np.isnan(stored)), name
                compared += 1
    assert compared > 100 * len(table)
    shown = results.table
    assert len(shown) == len(answer["points"]) and list(shown["label"]) == [point["label"] for point in answer["points"]]
    for name in shown.columns.difference(["goal", "goal_rate", "goal_rate_low", "goal_rate_high"]):
        assert shown[name].equals(table[name].astype(shown[name].dtype))
    if results.checked.goal:
        goals = [[point["goal"][key] for key in ("status", "rate", "rate_low", "rate_high")] for point in answer["points"]]
        assert shown[["goal", "goal_rate", "goal_rate_low", "goal_rate_high"]].to_numpy().tolist() == goals
    assert set(shown.attrs["units"]) == set(shown.attrs["meanings"]) == set(shown)


SOME = {"saturated", "broke_away", "stopped", "controller_failed"}  # holds if some move has it
SUMS = {"jerk_count", "phase_changes", "encoder_disagreement", "band_exits"}
LAST = {
    "arrival", "final_settling_time", "zero_fraction", "holding_torque", "creep", "final_position", "midway_error", "final_error",
    "travel_time", "oscillation_amplitude", "oscillation_period", "jerk_agreement", "step_motion",
}  # fmt: skip


def test_measures_of_a_trial_follow_from_its_moves(results: zc.Results) -> None:
    """Every measure of a trial follows from those of its moves; success is zero counts at the end of each."""
    trials, moves = results.trials(), results.moves()
    of_moves = moves.groupby(level="trial")
    assert (trials["success"] == of_moves["outcome"].agg(lambda words: (words == "zero_count").all())).all()
    severity = ["open_loop", "zero_count", "one_count", "off_target", "oscillating", "nonfinite"]
    rank = moves["outcome"].astype(object).map(severity.index)
    assert [severity.index(word) for word in trials["outcome"]] == rank.groupby(level="trial").max().tolist()
    for name in moves.columns.drop("outcome"):
        base = name.partition("[")[0]
        values = moves[name].to_numpy().reshape(len(trials), -1)
        if values.dtype == bool:
            expected = values.any(axis=1) if base in SOME else values.all(axis=1)
        elif base in LAST:
            expected = values[:, -1]
        else:
            expected = values.sum(axis=1) if base in SUMS else np.abs(values).max(axis=1)
        assert same(trials[name].to_numpy(), expected), name


def test_a_trial_counts_as_its_worst_move(small: zc.Results) -> None:
    """The outcome of a trial is that of its worst move, for all pairs of outcomes."""
    worse = ["zero_count", "one_count", "off_target", "oscillating", "nonfinite"]
    recorded = small._file.group("outcome")["outcome"]
    pairs = [(one, other) for one in worse for other in worse]
    codes = np.array([[recorded.words.index(word) for word in pair] for pair in pairs], dtype=np.int8)
    of_trials = small._columns.of_trials({"outcome": dataclasses.replace(recorded, values=codes)})
    assert of_trials["outcome"].in_words.tolist() == [max(pair, key=worse.index) for pair in pairs]
    assert of_trials["success"].values.tolist() == [pair == ("zero_count", "zero_count") for pair in pairs]


def test_the_table_of_trials_states_how_moves_are_combined(small: zc.Results) -> None:
    """The table of trials tells for each measure how it follows from the moves."""
    told = small.trials().attrs["combined"]
    for rule, names in (("sum", SUMS), ("any", SOME), ("last", LAST)):
        assert {name.partition("[")[0] for name in told if told[name] == rule} == names & {name.partition("[")[0] for name in told}
    assert set(told.values()) == {"all", "any", "sum", "largest", "last"}
    assert set(small.moves()) - {"goal_met"} == set(told)


@pytest.mark.parametrize("shared", [{"machines": 6}, {"worlds": 3}, {"machines": 6, "worlds": 3}], ids=str)
def test_trials_under_a_condition_equal_those_of_its_study(shared: dict[str, int], tmp_path: pathlib.Path) -> None:
    """The trials under a condition are those of the study with its overrides, with machine and world."""
    manifest: dict[str, Any] = {
        "zerocount": 1,
        "name": "conditions",
        "seed": 3,
        "trials": 24,
        **shared,
        "friction": {"k1": {"uniform": [90.0, 130.0]}},
        "command": {"targets": [5, 8], "hold": 0.05},
    }
    if "worlds" in shared:
        manifest["friction"]["alpha"] = {"interval": [0.1, 2.0]}
    both = zc.study({**manifest, "trials": 48, "conditions": {"empty": {}, "loaded": {"plant.inertia": 9e-4}}})
    assert both.conditions == ["empty", "loaded"]
    found = both.run(tmp_path / "both.h5")
    trials, moves, dataset = found.trials(), found.moves(inputs=True), found.dataset
    counts = {one["condition"]: one["success"] for one in found.summary["points"][0]["conditions"]}
    assert trials.groupby("condition", observed=True)["success"].sum().to_dict() == counts
    assert moves["condition"].tolist() == np.repeat(trials["condition"].to_numpy(), 2).tolist()
    assert dataset["condition"].values.tolist() == trials["condition"].tolist()
    for condition, inertia in (("empty", None), ("loaded", 9e-4)):
        plant = {} if inertia is None else {"plant": {"inertia": inertia}}
        alone = zc.study({**manifest, **plant}).run(tmp_path / f"{condition}.h5").trials()
        assert "condition" not in alone
        mine = trials[trials["condition"] == condition]
        for name in alone.columns.drop("index"):
            assert mine[name].tolist() == alone[name].tolist() or same(mine[name].to_numpy(), alone[name].to_numpy()), name


def test_ages_and_lives_match_the_trials(tmp_path: pathlib.Path) -> None:
    """Ages and lives of machines, recomputed from the trials and their moves."""
    manifest: dict[str, Any] = {
        "zerocount": 1,
        "name": "ages",
        "seed": 3,
        "machines": 6,
        "trials": 144,
        "conditions": {"empty": {}, "loaded": {"plant.inertia": 9e-4}},
        "ages": {"at": [0, 10, 100], "unit": "h"},
        "friction": {"k1": {"uniform": [90.0, 130.0], "aging": {"linear": {"uniform": [-0.5, 0.0]}, "scale": 100}}},
        "controller": {"ki": 5e-5},
        "command": {"targets": [5, 8], "hold": 0.1},
        "goal": {"band": 1, "within": 0.04, "moves": 0.8, "machines": 0.5},
    }
    study = zc.study(manifest)
    assert study.ages == [0, 10, 100]
    assert study.conditions == ["empty, 0 h", "loaded, 0 h", "empty, 10 h", "loaded, 10 h", "empty, 100 h", "loaded, 100 h"]
    found = study.run(tmp_path / "ages.h5")
    trials, moves, ages, lives = found.trials(), found.moves(inputs=True), found.ages(), found.lives()
    assert set(trials["condition"]) == {"empty", "loaded"}
    assert found.dataset["age"].values.tolist() == trials["age"].tolist()
    young = trials["k1"] / (1 + trials["aging"] * trials["age"] / 100)
    np.testing.assert_allclose(young, young.groupby(trials["machine"]).transform("first"), rtol=1e-12)
    counts = trials.groupby("age")[["success", "goal_met"]].sum()
    assert counts["success"].tolist() == ages["success"].tolist()
    assert counts["goal_met"].tolist() == ages["goal_met"].tolist()
    meets = moves.groupby(["age", "condition", "machine"], observed=True)["goal_met"].mean() >= 0.8
    of_machines = meets.groupby(["age", "machine"]).all().unstack("age")
    assert of_machines.mean().tolist() == ages["machines"].tolist()
    alive = of_machines.cummin(axis=1)
    expected = [max((age for age in alive if row[age]), default=np.nan) for _, row in alive.iterrows()]
    assert same(lives["life"].to_numpy(), np.array(expected))
    assert lives.attrs["units"]["life"] == "h"
    del manifest["ages"], manifest["friction"]
    without = zc.study({**manifest, "trials": 12}).run(tmp_path / "without.h5")
    for table in (without.ages, without.lives):
        with pytest.raises(zc.DataError, match="no ages"):
            table()
    assert "age" not in without.trials()


def test_the_goal_is_met_where_the_file_says_so(small: zc.Results, results_of: ResultsOf, axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """Moves and trials that meet the goal are those that the program counted."""
    for r in (small, results_of("unknown-friction")):
        moves, trials = r.moves(), r.trials()
        goal = r.checked.goal
        times = moves[f"band_settling_time[{goal['band']}]" if goal["tolerance"] is None else f"tolerance_settling_time[{goal['tolerance']}]"]
        assert (moves["goal_met"] == (times <= goal["within"] * (1 + 1e-9))).all()
        assert (trials["goal_met"] == moves.groupby(level="trial")["goal_met"].all()).all()
    rate = trials.groupby(["point", "world"])["goal_met"].sum()
    assert all((r.worlds(point)["goal_met"] == rate.loc[point]).all() for point in r.table.index)
    rates = small.moves(inputs=True).groupby("point")["goal_met"].mean()
    assert rates.tolist() == small.table["goal_rate"].tolist()


def test_moves_can_have_their_inputs(results: zc.Results) -> None:
    """The inputs of a trial stand beside each of its moves."""
    trials, moves, joined = results.trials(), results.moves(), results.moves(inputs=True)
    assert joined[list(moves)].equals(moves)
    for name in joined.columns.difference(moves.columns):
        assert same(joined[name].to_numpy(), trials[name].to_numpy().repeat(len(moves) // len(trials)))
    assert {"point", "index"} <= set(joined)


def test_tables_agree_with_one_another(results: zc.Results) -> None:
    """Rates, machines, worlds, jerks and the tables of single points follow from the trials."""
    trials, table, jerks = results.trials(), results.table, results.jerks()
    rates = table["success_rate"].to_numpy()
    with h5py.File(results.path) as file:
        constant = {kind: list(file.get(f"{kind}/input", ())) for kind in ("machine", "world")}
    assert (trials.groupby("point")["success"].mean() == table["success_rate"]).all()
    assert (trials.groupby("point").size() == table["trials"]).all()
    per_trial = jerks.groupby("trial").size().reindex(trials.index, fill_value=0)
    assert (per_trial == trials["jerk_count"]).all()
    assert np.allclose(trials.groupby("point")["jerk_count"].mean(), table["jerk_count_mean"], rtol=1e-14)
    for kind in ("machine", "world"):
        if kind in trials:
            machines = getattr(results, kind + "s")
            assert (machines()["success"] == trials.groupby(kind)["success"].sum()).all()
            assert (machines()["trials"] == trials.groupby(kind).size()).all()
            numbers = np.array([machines(point)["success"].to_numpy() for point in table.index])
            assert same(numbers.sum(axis=0), machines()["success"].to_numpy()) and same(numbers.sum(axis=1), rates * table["trials"])
            inputs_of = [column_of(trials, name) for name in constant[kind]]
            assert (trials.groupby(kind)[inputs_of].nunique() == 1).all(axis=None)
            assert same(trials.groupby(kind)[inputs_of].first().to_numpy(), machines()[inputs_of].to_numpy())
        else:
            with pytest.raises(zc.DataError, match="has no " + ("machines" if kind == "machine" else kind + "s")):
                getattr(results, kind + "s")()
    for point in (0, len(table) - 1):
        mine = trials[trials["point"] == point]
        assert results.trials(point).equals(mine) and results.trials(table["label"][point]).equals(mine)
        assert results.jerks(point).equals(jerks[jerks["trial"].isin(mine.index)])


def test_moves_of_a_point_are_a_subset_of_all_moves(results: zc.Results) -> None:
    """The moves of a point are those of its trials."""
    trials, moves = results.trials(), results.moves()
    for point in (0, 1):
        assert results.moves(point).equals(moves.loc[trials.index[trials["point"] == point]])


def test_the_dataset_has_the_outcomes(results: zc.Results) -> None:
    """The dataset of xarray has the moves and the inputs, with units, and is that of the file."""
    dataset, moves, trials = results.dataset, results.moves(), results.trials()
    for name in moves.columns.drop("goal_met", errors="ignore"):
        base, _, band = name.partition("[")
        array = dataset[base]
        if band:
            (dimension,) = set(array.dims) - {"trial", "move"}
            # The tolerances of a dataset have no labels: the study has one.
            array = array.sel({dimension: float(band[:-1])}) if dimension in array.coords else array.squeeze(dimension)
        assert same(array.transpose("trial", "move").to_numpy().reshape(-1), moves[name].to_numpy())
        assert array.attrs["units"] == moves.attrs["units"][name]
        assert array.attrs["long_name"] == moves.attrs["meanings"][name]
    for name in ["point", "index", *map(lambda full: column_of(trials, full), inputs(results))]:
        assert same(dataset.coords[name].to_numpy(), trials[name].to_numpy())
        assert dataset.coords[name].attrs["units"] == trials.attrs["units"][name]


@pytest.mark.parametrize("name", OPEN)
def test_an_open_loop_has_levels(name: str, results_of: ResultsOf, tmp_path: pathlib.Path) -> None:
    """The torque levels of an open loop are those of the exported CSV; its trials have no success."""
    r = results_of(name)
    tables = exported(r, tmp_path / "csv")
    assert_same_table(r.levels().reset_index(), tables["levels"])
    assert_same_table(r.moves().reset_index(), tables["outcomes"])
    assert set(r.trials()["outcome"]) == {"open_loop"} and not r.trials()["success"].any()
    assert len(r.table) == len(tables["points"]) and r.table["success_rate"].isna().all()
    with pytest.raises(zc.DataError, match="jerks|machines"):
        r.machines()


def test_a_closed_loop_has_no_levels(small: zc.Results) -> None:
    """Asking for torque levels of a closed loop says so."""
    with pytest.raises(zc.DataError, match="has no torque levels: its loop is closed"):
        small.levels()


def test_kept_failures_are_the_failures(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """A study that keeps failures has the same statistics, and those trials, moves and jerks that failed."""
    study = axis.set(machines=20, trials=60).sweep("controller.ki", [1e4, 6e4])
    everything = study.run(tmp_path / "all.h5")
    failures = study.set(keep="failures").run(tmp_path / "failures.h5")
    assert failures.table.equals(everything.table) and failures.machines(1).equals(everything.machines(1))
    for point in (None, 0, 1):
        trials = everything.trials(point)
        failed = trials[~trials["success"]]
        assert len(failed) > 0 and failures.trials(point).equals(failed)
        jerks = everything.jerks(point)
        mine = failures.jerks(point).reset_index(drop=True)
        assert mine.equals(jerks[jerks["trial"].isin(failed.index)].reset_index(drop=True))
    assert failures.moves().equals(everything.moves().loc[failures.trials().index])
    statistics = study.set(keep="statistics").run(tmp_path / "statistics.h5")
    assert statistics.table.equals(everything.table)
    judged, without_moves = dict(everything.judge()), dict(statistics.judge())
    assert judged.pop("missed_saturated") == 0 and without_moves.pop("missed_saturated") is None
    assert without_moves == judged
    for ask in (statistics.trials, statistics.moves, statistics.jerks, lambda: statistics.dataset, lambda: statistics.trials(1)):
        with pytest.raises(zc.DataError, match="does not keep|has no jerks"):
            ask()


def test_a_point_is_named_by_its_number_or_label(small: zc.Results) -> None:
    """All numbers and labels are points, of NumPy too; nothing else is."""
    for number, label in enumerate(small.study.labels):
        assert small.point(number) == small.point(np.int64(number)) == small.point(label) == small.point(str(number)) == number
    asks = (small.point, small.trials, small.moves, small.jerks, small.machines, small.trace, small.judge)
    for wrong, ask in zip((-1, 3, "3", "0.5", "", "controller.ki", 99), asks):
        with pytest.raises(zc.ManifestError, match="expected 0 to 2 or a label"):
            ask(wrong)
    for ask in asks:
        with pytest.raises(zc.ArgumentError, match="expected a whole number"):
            ask(True)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_names_are_unique_and_short(path: pathlib.Path) -> None:
    """The names of the columns of trials are ends of the full names, tell them apart, and are no longer than needed."""
    study = zc.study(path).checked
    full = ["trial", "point", "index", "machine", "world", *(column["name"] for column in study.inputs), *study.descriptions["outcome"]]
    short = [short_name(name, full) for name in full]
    assert len(set(short)) == len(full)
    for name, less in zip(full, short):
        assert name == less or name.endswith("." + less)
        end = less.partition("[")[0].partition(".")[2]  # a tolerance may have a point: [8.7e-05]
        while end and end.split(".")[0].isdigit():
            end = end.partition(".")[2]
        assert not end or sum(other == end or other.endswith("." + end) for other in full) > 1


def test_units_are_those_of_the_file(results: zc.Results) -> None:
    """Every column has the unit and the meaning that its dataset has."""
    tables = {"point": results.statistics, "outcome": results.moves(), "trial/input": results.trials(), "jerk": results.jerks()}
    with h5py.File(results.path, locking=False) as file:
        for group, table in tables.items():
            for name, dataset in file[group].items():
                columns = [column for column in table if ("." + name).endswith("." + column) or column.startswith(name + "[")]
                for column in columns:
                    assert table.attrs["units"][column] == dataset.attrs["units"], name
                    assert table.attrs["meanings"][column] == dataset.attrs["long_name"], name
                assert columns or name in ("point", "trial", "move", "jerk", "index")
    assert results.statistics.attrs["units"]["holding_torque_mean"] == ("N" if results.checked.linear else "N m")


def test_a_file_that_is_open_can_be_read(small: zc.Results) -> None:
    """A results file that h5py or xarray has open gives its tables."""
    with h5py.File(small.path) as file:
        assert file.attrs["name"] == zc.open(small.path).name
        assert len(small.trials()) == 600


def test_without_a_goal_nothing_is_judged(results_of: ResultsOf) -> None:
    """A study without a goal has no columns of one, and says that it cannot be judged."""
    r = results_of("stability-map")
    assert not [name for name in r.table if name.startswith("goal")] and r.study.goal is None
    with pytest.raises(zc.ManifestError, match="goal"):
        r.judge()


TRACED = ["small", "unknown-friction", "linear-stage", "contact-variation", "identification", "two-encoders", "compensators"]


@pytest.mark.parametrize("name", dear_by_night(TRACED))
def test_a_trace_equals_that_of_this_process(name: str, small: zc.Results, results_of: ResultsOf) -> None:
    """A trial that the program replays and one of this process have the same values, and the recorded outcome."""
    r = small if name == "small" else results_of(name)
    rng, moves = random.Random(name), r.moves()
    for _ in range(2):
        point, trial = rng.randrange(len(r.checked.labels)), rng.randrange(r.checked.trials)
        replayed, here = r.trace(point, trial), zc.trial(r, point, trial)
        assert same_trace(replayed, here) and same_trace(zc.trial(r.study, point, trial), here)
        assert (replayed.title, replayed.units, replayed.bands) == (here.title, here.units, here.bands)
        recorded = moves.loc[point * r.checked.trials + trial]
        assert list(recorded["outcome"].astype(object)) == list(here.outcome["outcome"])
        assert same(recorded["jerk_count"].to_numpy(), here.outcome["jerk_count"])


def test_a_trace_of_the_program_has_the_types_and_signs_of_this_process(results_of: ResultsOf) -> None:
    """Numbers of a replayed trial are whole or not as in this process, and zeros have their signs."""
    for r, point, trial in ((results_of("unknown-friction"), 0, 0), (results_of("identification"), 0, 1)):
        replayed, here = r.trace(point, trial), zc.trial(r, point, trial)
        for of in ("samples", "outcome"):
            for name, values in getattr(here, of).items():
                again = getattr(replayed, of)[name]
                assert again.dtype == values.dtype
                if values.dtype.kind == "f":
                    assert (np.signbit(again) == np.signbit(values)).all()


def test_a_trace_is_a_table_and_a_picture(small: zc.Results, results_of: ResultsOf) -> None:
    """The frame has the samples by time; the plot has error and torque, with units and bands."""
    for r, unit in ((small, "torque (N m)"), (results_of("linear-stage"), "force (N)"), (results_of("identification"), "torque (N m)")):
        t = r.trace(0, 1)
        assert t.frame.index.name == "t" and t.frame["error"].to_numpy().tolist() == t.error.tolist()
        assert set(t.frame.attrs["units"]) >= set(t.frame) and t.frame.attrs["units"]["omega"] in ("rad/s", "m/s")
        upper, lower = t.plot().axes
        assert (upper.get_ylabel(), lower.get_ylabel(), lower.get_xlabel()) == ("error (counts)", unit, "time (s)")
        assert same(upper.lines[0].get_ydata(), t.error) and same(lower.lines[0].get_ydata(), t.torque)
        assert same(lower.lines[0].get_xdata(), t.t)


@pytest.mark.parametrize(("point", "trial"), [(99, 0), (-1, 0), (0, 200), (0, -1)])
def test_a_trial_that_does_not_exist_is_refused(small: zc.Results, point: int, trial: int) -> None:
    """A trace of a wrong point or trial names the range, from the program and in this process."""
    for ask in (small.trace, lambda p, t: zc.trial(small.study, p, t), lambda p, t: zc.trial(small, p, t)):
        with pytest.raises(zc.ManifestError):
            ask(point, trial)


def test_results_have_the_study_that_was_run(axis: zc.Study, folder: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """The study of a results file has its hash, also where the command line set a key twice."""
    words = ["--set", "trials=40", "--set", "machines=20", "--set", "command.targets.0=5", "--set", "trials=60"]
    by_program("run", folder / "my-axis.yaml", "-o", tmp_path / "r.h5", "-q", *words)
    r = zc.open(tmp_path / "r.h5")
    assert r.checked.sha256 == h5py.File(r.path).attrs["study_sha256"]
    assert r.study.trials == 60
    assert r.study.sha256 == r.checked.sha256


def test_files_that_are_not_results_are_refused(folder: pathlib.Path, axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """A missing file, a text, and an HDF5 file of something else give an error with the file's name."""
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["x"] = 1
    for path in (tmp_path / "missing.h5", folder / "my-axis.yaml", tmp_path / "other.h5", tmp_path):
        with pytest.raises(zc.DataError, match="results file") as raised:
            zc.open(path)
        assert raised.value.code == 4 and str(path) in str(raised.value)


def test_reports_and_other_commands_equal_those_of_the_program(small: zc.Results, tmp_path: pathlib.Path) -> None:
    """The report is a page, written again without a question; a command gives what the program prints."""
    for _ in range(2):
        assert small.report(tmp_path / "r.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    assert small.command("summary") == by_program("summary", small.path)
    assert "8 design points" not in repr(small) and repr(small) == "<Results 'my-axis': 3 design points × 200 trials>"
    assert repr(pickle.loads(pickle.dumps(small))) == repr(small)
    assert small._repr_html_().count("<tr") == 2 + 3 and small.name in small._repr_html_()
