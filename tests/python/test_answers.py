"""Answers of functions and commands, beside the JSON, the text and the schema of the program; options."""

from __future__ import annotations

import json
import pathlib
import pickle
import re
from collections.abc import Callable
from typing import Any

import jsonschema
import numpy as np
import pandas as pd
import pytest
import zerocount as zc
from support import by_program, program, same_trace
from zerocount.answers import Record
from zerocount.options import options

ResultsOf = Callable[[str], zc.Results]
Asked = tuple[Callable[[], zc.Answer], tuple[object, ...]]

QUICK = """\
zerocount: 1
name: quick
seed: 2
trials: 100
goal: {band: 1, within: 0.1, moves: 0.9}
controller: {ki: 3.0e-5}
friction: {k1: {uniform: [100, 120]}}
command: {targets: [{integers: [1, 30]}], hold: 0.12}
initial: {encoder_phase: {uniform: [0, 1]}}
tune: {free: {controller.ki: {log: [1.0e-5, 6.0e-5]}}, margins: off}
"""


SLIDE = """\
zerocount: 1
name: slide
trials: 1
seed: 3
friction: {model: coulomb, breakaway: 0.2, coulomb_ratio: 0.8}
command: {torque: {levels: [0, 0.5, -0.5, 0.5, -0.5], rate: 10}, hold: 0.3}
"""


@pytest.fixture(scope="module")
def schema() -> Any:
    """The schema of all answers."""
    return json.loads(by_program("schema", "--answers"))


@pytest.fixture(scope="module")
def other(small: zc.Results, folder: pathlib.Path) -> zc.Results:
    """The study `small` with another delay."""
    return small.study.set(**{"controller.delay": 2}).run(folder / "slower.h5")


def asked(axis: zc.Study, small: zc.Results, other: zc.Results, results_of: ResultsOf, folder: pathlib.Path) -> dict[str, Asked]:
    """Calls that answer, and the same commands."""
    manifest, margins, records = folder / "short-axis.yaml", folder / "margins.yaml", results_of("identification")
    axis.set(machines=50, trials=100).save(manifest)
    axis = zc.study(manifest)
    worlds, goal = results_of("unknown-friction"), {"band": 1, "within": 0.05, "moves": 0.8}
    machines = small.study.set(goal={"band": 2, "within": 0.05, "moves": 0.5, "machines": 0.7}, trials=400, machines=20).run(folder / "m.h5")
    wide = "{success_rate: 0.5, arrival_rate: 0.5, stable_rate: 0.5, jerk_count: 1000, arrival_time: 1}"
    margins.write_text(f"margins: {wide}\n", encoding="utf-8")
    few = axis.without("machines").set(trials=50, **{"command.hold": 0.1}).sweep("controller.ki", [1e4])
    few.save(folder / "few.yaml")
    margin, label = {"success_rate": 0.2, "arrival_time": "50%"}, small.study.labels[2]
    laws, steps = ["spring", "dahl"], ("identify", records.path, "--point", "steps")
    slide = folder / "slide.csv"
    (folder / "slide.yaml").write_text(SLIDE, encoding="utf-8")
    by_program("trace", folder / "slide.yaml", "--format", "csv", "-o", slide)
    shown = {"success": 0.97, "machines_share": 0.9}
    return {
        "judge the best": (small.judge, ("judge", small.path)),
        "judge a point": (lambda: small.judge(1), ("judge", small.path, "--point", 1)),
        "judge another point": (lambda: small.judge(0), ("judge", small.path, "--point", 0)),
        "judge machines": (machines.judge, ("judge", machines.path)),
        "judge worlds": (worlds.judge, ("judge", worlds.path)),
        "judge a path": (lambda: zc.ask("judge", small.path, point=2), ("judge", small.path, "--point", 2)),
        "summary": (lambda: small.summary, ("summary", small.path)),
        "summary of worlds": (lambda: worlds.summary, ("summary", worlds.path)),
        "compare": (lambda: zc.compare(small, other), ("compare", small.path, other.path)),
        "compare with margins": (
            lambda: zc.compare(str(small.path), other.path, margins=margins),
            ("compare", small.path, other.path, "--margins", margins),
        ),
        "compare points": (
            lambda: zc.compare(small, points=(0, 1), changed_fails=True),
            ("compare", small.path, "--points", 0, 1, "--changed-fails"),
        ),
        "compare labels": (lambda: zc.compare(small, points=(1, label)), ("compare", small.path, "--points", 1, label)),
        "compare equals": (lambda: zc.compare(small, small), ("compare", small.path, small.path)),
        "plan a rate": (lambda: zc.plan(success=0.99), ("plan", "--success", 0.99)),
        "plan failures": (
            lambda: zc.plan(success=0.999, confidence=0.99, failures=1),
            ("plan", "--success", 0.999, "--confidence", 0.99, "--failures", 1),
        ),
        "plan with power": (
            lambda: zc.plan(success=0.99, true_success=0.995, power=0.9),
            ("plan", "--success", 0.99, "--true-success", 0.995, "--power", 0.9),
        ),
        "plan a width": (lambda: zc.plan(halfwidth=0.01), ("plan", "--halfwidth", 0.01)),
        "plan machines": (lambda: zc.plan(**shown), ("plan", "--success", 0.97, "--machines-share", 0.9)),
        "plan machines that differ": (
            lambda: zc.plan(halfwidth=0.02, machine_sd=0.1, true_success=0.9),
            ("plan", "--halfwidth", 0.02, "--machine-sd", 0.1, "--true-success", 0.9),
        ),
        "plan a study": (lambda: zc.plan(axis), ("plan", manifest)),
        "plan a study with settings": (
            lambda: zc.plan(axis.set(goal=goal)),
            ("plan", manifest, "--set", f"goal={zc.manifests.flow_text(goal)}"),
        ),
        "plan a manifest": (lambda: zc.plan(manifest), ("plan", manifest)),
        "plan from a pilot": (lambda: zc.plan(small), ("plan", small.path)),
        "plan an equivalence": (
            lambda: zc.plan(few, margin=margin, power=0.9),
            ("plan", folder / "few.yaml", "--margin", "success_rate=0.2", "--margin", "arrival_time=50%", "--power", 0.9),
        ),
        "identify": (lambda: zc.identify(records.path, point="steps"), steps),
        "identify laws": (lambda: zc.identify(records.path, point="steps", model=laws), (*steps, "--model", laws[0], "--model", laws[1])),
        "identify sliding": (lambda: zc.identify(slide, sliding=True), ("identify", slide, "--sliding")),
        "limits": (lambda: zc.ask("limits", few, point=0), ("limits", folder / "few.yaml", "--point", 0)),
        "jerks": (lambda: zc.ask("jerks", other, creep_trials=1), ("jerks", other.path, "--creep-trials", 1)),
        "learn": (lambda: zc.ask("learn", worlds), ("learn", worlds.path)),
        "verify": (lambda: zc.ask("verify", small, trials=2), ("verify", small.path, "--trials", 2)),
        "check": (axis.check, ("check", manifest)),
        "parameters": (lambda: zc.ask("parameters"), ("parameters",)),
        "guides": (lambda: zc.ask("parameters", guides=True), ("parameters", "--guides")),
        "sensitivity": (
            lambda: zc.ask("sensitivity", small, output=["success", "arrival_time"]),
            ("sensitivity", small.path, "--output", "success", "--output", "arrival_time"),
        ),
    }


def timeless(value: Any) -> Any:
    """A part of an answer without times of computing, in which two runs differ."""
    if isinstance(value, dict):
        return {key: timeless(inner) for key, inner in value.items() if "seconds" not in key}
    if isinstance(value, list):
        return [timeless(inner) for inner in value]
    return re.sub(r"[\d.e-]+ [nµm]?s\b", "", value) if isinstance(value, str) else value


DEAR = ("identify", "identify laws", "jerks", "limits")


@pytest.mark.parametrize("dear", [False, pytest.param(True, marks=pytest.mark.long)])
def test_answers_equal_those_of_the_program(
    axis: zc.Study, small: zc.Results, other: zc.Results, results_of: ResultsOf, folder: pathlib.Path, schema: Any, dear: bool
) -> None:
    """Functions and commands answer with the JSON and the text of the program, and the attributes that its schema tells."""
    codes, texts = set(), {}
    for name, (ask, words) in asked(axis, small, other, results_of, folder).items():
        if (name in DEAR) != dear:
            continue
        answer, done = ask(), program(*words, "--format", "json")
        record, values = timeless(json.loads(done.stdout)), timeless(answer.to_dict())
        assert record == values, name
        codes.add((words[0], done.returncode))
        if words[0] not in texts:
            texts[words[0]] = str(answer)
            assert timeless(str(answer)) == timeless(program(*words).stdout.rstrip("\n")), name
        jsonschema.Draft202012Validator({"$ref": f"#/$defs/{answer.answer}", "$defs": schema["$defs"]}).validate(answer.to_dict())
        assert answer.headline in repr(answer) and answer._repr_html_().startswith("<"), name
        assert_as_annotated(answer, schema["$defs"][answer.answer])
        assert pickle.loads(pickle.dumps(answer)) == answer
    assert dear or {("judge", 0), ("judge", 1), ("judge", 3), ("compare", 0), ("compare", 1)} <= codes


def assert_as_annotated(record: Record, schema: Any) -> None:
    """A record has all attributes of its class, each with its value in the JSON or made of it."""
    names = {key for cls in type(record).__mro__ for key in vars(cls).get("__annotations__", {}) if not key.startswith("_")}
    assert {name.rstrip("_") for name in names} == set(schema["properties"])
    for name in names:
        key, value = name.rstrip("_"), getattr(record, name)
        if isinstance(value, Record):
            assert type(value) is type(record)._records[key] and value == record[key]
            assert_as_annotated(value, schema["properties"][key])
        elif isinstance(value, pd.DataFrame):
            assert len(value) == len(record[key]) and set(value) == set(value.attrs["meanings"]) >= set(value.attrs["units"])
        else:
            assert value == record.get(key)


def test_a_command_without_an_answer_raises_its_error(small: zc.Results) -> None:
    """A command that ends without an answer raises the error of its exit code."""
    with pytest.raises(zc.ManifestError, match="99"):
        zc.ask("judge", small, point=99)
    with pytest.raises(zc.ManifestError, match="unknown command"):
        zc.ask("nothing")


RECORD = {
    "one": 1,
    "unknown": None,
    "class": "a word of Python",
    "values": [1, 2],
    "part": {"inner": {"x": 0.5}},
    "rows": [{"a": 1, "b": {"c": None}, "axes": {"controller.ki": 2.0}}, {"a": 2, "b": {"c": None}, "axes": {"controller.ki": 4.0}}],
    "none": [],
    "named": {"first one": {"a": 1}, "second.one": {"a": 2}},
}
NUMBER = {"type": ["number", "null"], "unit": "s", "description": "a time"}
ROW = {
    "properties": {
        "a": {"type": "integer"},
        "b": {"properties": {"c": NUMBER}},
        "axes": {"additionalProperties": {"type": ["number", "null"]}, "description": "where it is"},
    }
}
SCHEMA = {
    "properties": {
        **{key: {} for key in ("one", "unknown", "class", "values", "left_out")},
        "part": {"properties": {"inner": {"properties": {"x": NUMBER}}}},
        "rows": {"type": "array", "items": ROW},
        "none": {"type": "array", "items": ROW},
        "named": {"type": "object", "additionalProperties": {"properties": {"a": {"type": "integer"}}}},
    }
}


def test_nested_tables_become_one_table() -> None:
    """Inner rows have the values of the outer ones, except those of the same name, and the units of both."""
    measure = {"properties": {"name": {"type": "string"}, "value": NUMBER, "notes": {"type": "array", "items": ROW}}}
    point = {"properties": {"point": {"unit": "1"}, "name": {}, "list": {"items": NUMBER}, "measures": {"items": measure}}}
    schema = {"properties": {"confidence": NUMBER, "points": {"items": point}}}
    inner = [[{"name": "b", "value": 0.5, "notes": [{"a": 3, "b": {"c": 1.0}, "axes": {}}]}, {"name": "c", "value": None, "notes": []}], None]
    points = [{"point": number, "name": "a", "list": [1.0], "measures": measures} for number, measures in enumerate(inner)]
    record = Record({"confidence": 0.95, "points": points}, schema)
    measures = record.rows_of("points.measures")
    assert list(measures) == ["point", "name", "value", "notes"] and measures.attrs["units"] == {"point": "1", "value": "s"}
    assert measures["point"].tolist() == [0, 0] and measures["name"].tolist() == ["b", "c"]
    notes = record.rows_of("points.measures.notes")
    assert notes.iloc[0].to_dict() == {"point": 0, "name": "b", "value": 0.5, "a": 3, "b.c": 1.0} and len(notes) == 1
    assert record.rows_of("points").equals(record.points)
    for wrong in ("measures", "confidence", "points.list"):
        with pytest.raises(KeyError, match="is not a table"):
            record.rows_of(wrong)


def test_members_of_a_record_are_attributes() -> None:
    """Objects are records, tables are DataFrames with units and meanings; items are the JSON."""
    record = Record(RECORD, SCHEMA)
    assert record == RECORD and record.to_dict() == RECORD and record.one == 1 and record.unknown is None and record.left_out is None
    assert getattr(record, "class_") == "a word of Python" and record.values_ == [1, 2] and record.part.inner.x == 0.5
    rows = record.rows
    assert list(rows) == ["a", "b.c", "axes.controller.ki"] and rows["b.c"].isna().all() and rows["b.c"].dtype == float
    assert rows.attrs["units"] == {"b.c": "s"}
    assert rows.attrs["meanings"] == {"a": "", "b.c": "a time", "axes.controller.ki": "where it is"}
    assert list(record.none) == ["a", "b.c", "axes"] and len(record.none) == 0
    assert record.named.index.tolist() == ["first one", "second.one"] and record.named["a"].tolist() == [1, 2]
    with pytest.raises(AttributeError, match="'Record' has no attribute 'other'"):
        record.other  # noqa: B018
    record.to_dict()["part"]["inner"]["x"] = 1
    assert record.part.inner.x == 0.5


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """A manifest that is tuned in a second."""
    path = tmp_path_factory.mktemp("tune") / "quick.yaml"
    path.write_text(QUICK, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def tuned(quick: pathlib.Path) -> zc.Tuning:
    """The same task, given by the call to a study that sweeps the free gain."""
    study = zc.study(quick).without("goal", "tune", "controller.ki").sweep("controller.ki", [1e-5, 9e-5])
    free = {"controller.ki": {"log": [1e-5, 6e-5]}}
    return zc.tune(study, quick.with_name("tuned.h5"), goal={"band": 1, "within": 0.1, "moves": 0.9}, free=free, margins="off", budget=2000)


def test_a_study_with_a_sweep_and_observations_is_tuned(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """A sweep is left out, with what was observed at its points; the ranges may be those of the manifest."""
    label = axis.labels[0]
    study = axis.set({"tune.free": {"controller.ki": {"log": [5e3, 5e4]}}, "tune.margins": {"gain": 1, "phase": 10}})
    study = study.set({"observed": {label: "met"}})
    assert zc.tune(study, tmp_path / "t.h5", budget=2000, watch=tmp_path / "t.html").gains.keys() == {"controller.ki"}
    assert "Tuning" in (tmp_path / "t.html").read_text()
    with pytest.raises(zc.ManifestError, match="controller.ki"):
        zc.tune(study, tmp_path / "u.h5", free={"controller.ki": [1]})


def test_a_tuning_equals_that_of_the_program(quick: pathlib.Path, tuned: zc.Tuning) -> None:
    """The answer of `tune` is the JSON of the program for the same call; its study has the gains, its results the proof."""
    record = json.loads(by_program("tune", quick, "-o", quick.with_name("again.h5"), "--format", "json", "--budget", 2000))
    answer = tuned.to_dict()
    for searched in (record["searched"], answer["searched"]):
        searched.pop("seconds")
    assert record == answer and tuned.status == "met"
    (gain,) = tuned.gains.values()
    assert tuned.manifest.to_dict()["controller"]["ki"] == gain and 1e-5 <= gain <= 6e-5
    assert len(tuned.results.trials()) == tuned.proof.trials and tuned.results.judge().rate == tuned.proof.rate
    assert same_trace(tuned.results.trace(0, 5), zc.trial(tuned.manifest, 0, 5))


def test_a_finished_tuning_is_kept(quick: pathlib.Path, tuned: zc.Tuning) -> None:
    """An output that exists is replaced only by force."""
    before = tuned.results.path.read_bytes()
    with pytest.raises(zc.ManifestError, match="exists already"):
        zc.tune(quick, tuned.results.path, budget=2000)
    assert tuned.results.path.read_bytes() == before


def test_a_search_that_finds_nothing_has_no_results(tuned: zc.Tuning) -> None:
    """Where nothing was proven there are neither results nor a study."""
    answer = {**tuned.to_dict(), "status": "unreachable", "gains": {}, "proof": None}
    nothing = zc.Tuning({**tuned._rendered, "answer": answer})
    assert (nothing.status, dict(nothing.gains), nothing.proof, nothing.results, nothing.manifest) == ("unreachable", {}, None, None, None)


def test_a_tuning_without_a_task_is_refused(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """A manifest without free parameters says what is missing."""
    with pytest.raises(zc.ManifestError, match="tune"):
        zc.tune(axis.without("sweep").set(**{"controller.ki": 1e4}), tmp_path / "none.h5")


def test_identified_parameters_can_be_set_in_a_study(results_of: ResultsOf) -> None:
    """The parameters hold the truth, and are settings of a study."""
    r = results_of("identification")
    found = zc.identify(r.path, point="steps")
    truth, table = zc.trial(r, 1, 0).inputs, found.table
    assert found.passed and list(table.index) == [parameter["name"] for parameter in found["parameters"]]
    known = table[table["key"].isin(list(truth)) & (table["status"] == "estimated")]
    assert len(known) >= 3
    assert all(row["low"] * 0.9 <= truth[row["key"]] <= row["high"] * 1.1 for _, row in known.iterrows())
    study = r.study.set(**found.settings)
    assert study.trials == 10 and "friction.k1" in found.settings
    assert all(study.to_dict()[key.partition(".")[0]][key.partition(".")[2]] == value for key, value in found.settings.items())


@pytest.mark.long
def test_the_best_of_several_laws_gives_its_parameters(results_of: ResultsOf) -> None:
    """With two laws the exit code compares none, and the table is that of the first."""
    several = zc.identify(results_of("identification").path, point="steps", model=["spring", "dahl"])
    best = several["laws"][0]
    assert several.passed is None and several.table["value"].tolist() == [parameter["value"] for parameter in best["parameters"]]


def test_the_table_of_a_comparison_has_all_measures(small: zc.Results, other: zc.Results, axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """There is a row for each point and measure; what cannot be compared is an error."""
    comparison = zc.compare(small, other)
    rows = comparison.table
    assert comparison.verdict == "regression" and len(rows) == sum(len(point["measures"]) for point in comparison["points"])
    assert {"label", "measure"} <= set(rows)
    with pytest.raises(zc.DataError, match="cannot be compared"):
        zc.compare(small, small.study.without("sweep").set(**{"controller.ki": 1e4}).run(tmp_path / "one.h5"))
    for files in (("nowhere.h5", small), (small, "nowhere.h5")):
        with pytest.raises(zc.DataError, match="nowhere.h5: no such file; expected a results file"):
            zc.compare(*files)


def test_a_plan_without_a_question_is_refused() -> None:
    """A call that asks nothing says what is expected."""
    with pytest.raises(zc.ManifestError, match="expected --success or --halfwidth"):
        zc.plan()


def test_keyword_arguments_become_command_line_options() -> None:
    """Names have hyphens; None and False are left out, lists and dicts repeat the option."""
    words = options(
        dac_bits=16, quiet=True, none=None, no=False, zero=0, exclude=["0:1", "2:3"], fix={"friction.n": 2, "a": 0.5, "t": "5%"},
        posterior=pathlib.Path("/a b.csv"), point=("x", 1), text="--odd", number=np.float64(0.1), margin={"f": {"relative": 0.1}}, empty=[],
    )  # fmt: skip
    assert words == [
        "--dac-bits", "16", "--quiet", "--zero", "0", "--exclude", "0:1", "--exclude", "2:3", "--fix", "friction.n=2", "--fix", "a=0.5",
        "--fix", "t=5%", "--posterior", "/a b.csv", "--point", "x", "--point", "1", "--text", "--odd", "--number", "0.1",
        "--margin", "f={relative: 0.1}",
    ]  # fmt: skip
