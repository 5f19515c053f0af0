"""Tuning, identification, comparison and planning, beside the JSON of the program; options."""

from __future__ import annotations

import dataclasses
import json
import pathlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import zerocount as zc
from support import by_program, same_trace
from zerocount.options import dataclass_of, options

ResultsOf = Callable[[str], zc.Results]

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


def has_all_of(answer: Any, record: dict[str, Any], *, but: set[str] = frozenset()) -> bool:
    """Whether a dataclass has the values of an object of JSON for all its fields but some, and the object itself."""
    fields = {field.name for field in dataclasses.fields(answer)} - {"answer"} - but
    return answer.answer == record and all(getattr(answer, name) == record[name] for name in fields if name in record)


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
    assert zc.tune(study, tmp_path / "t.h5", budget=2000).gains.keys() == {"controller.ki"}
    with pytest.raises(zc.ManifestError, match="controller.ki"):
        zc.tune(study, tmp_path / "u.h5", free={"controller.ki": [1]})


def test_a_tuning_is_that_of_the_program(quick: pathlib.Path, tuned: zc.Tuning) -> None:
    """The answer of `tune` is the JSON of the program for the same call; its study has the gains, its results the proof."""
    record = json.loads(by_program("tune", quick, "-o", quick.with_name("again.h5"), "--format", "json", "--budget", 2000))
    for seconds in (record["searched"], tuned.answer["searched"], tuned.searched):
        seconds.pop("seconds", None)
    assert has_all_of(tuned, record, but={"proof", "manifest", "results"})
    proof = {name: record["proof"][name] for name in ("rate", "rate_low", "machines_low", "rigs", "trials", "criterion")}
    assert tuned.status == "met" and dataclasses.asdict(tuned.proof) == proof
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


NOTHING = """{
  "status": "unreachable", "gains": {}, "proof": null, "at_edges": [], "room": {}, "alternatives": [], "frontier": [],
  "limits": [], "worst": null, "wider_band_rate": null, "searched": {"points": 0, "trials": 0, "seconds": 8.1, "converged": false}
}"""
"""What the program answers, after a while, where no values keep the margins."""


def test_a_search_that_finds_nothing_is_an_answer(quick: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no values keep the margins the answer is unreachable, without gains."""
    monkeypatch.setattr(zc.Study, "command", lambda *arguments, **options: NOTHING)
    nothing = zc.tune(quick, tmp_path / "nothing.h5")
    assert (nothing.status, nothing.gains, nothing.proof, nothing.results) == ("unreachable", {}, None, None)
    assert not nothing.margins and nothing.answer == json.loads(NOTHING)


def test_a_tuning_without_a_task_is_refused(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """A manifest without free parameters says what is missing."""
    with pytest.raises(zc.ManifestError, match="tune"):
        zc.tune(axis.without("sweep").set(**{"controller.ki": 1e4}), tmp_path / "none.h5")


def test_an_identification_is_that_of_the_program(results_of: ResultsOf) -> None:
    """The parameters are the JSON of the program; they can be put into a study, and hold the truth."""
    r = results_of("identification")
    found = zc.identify(r.path, point="steps")
    record = json.loads(by_program("identify", r.path, "--format", "json", "--point", "steps", accepted=(0, 3)))
    assert has_all_of(found, record, but={"manifest", "passed"}) and found.text == record["manifest"]
    assert found.passed == bool(record["residuals"]["passed"]) is True
    truth, table = zc.trial(r, 1, 0).inputs, found.table
    assert list(table.index) == [parameter["name"] for parameter in found.parameters]
    known = table[table["key"].isin(list(truth)) & (table["status"] == "estimated")]
    assert len(known) >= 3
    assert all(row["low"] * 0.9 <= truth[row["key"]] <= row["high"] * 1.1 for _, row in known.iterrows())
    study = r.study.set(**found.settings)
    for section, keys in found.manifest.items():
        assert {key: value for key, value in study.to_dict()[section].items() if key in keys} == keys
    assert study.trials == 10


def test_several_laws_are_identified(results_of: ResultsOf) -> None:
    """Of several friction laws the parameters of the best are given, and the answer has all."""
    r, laws = results_of("identification"), ["spring", "dahl"]
    words = [word for law in laws for word in ("--model", law)]
    record = json.loads(by_program("identify", r.path, "--format", "json", "--point", "steps", *words, accepted=(0, 3)))
    found = zc.identify(r.path, point="steps", model=laws)
    assert found.answer == record and {of["law"] for of in record["laws"]} == set(laws)
    assert found.parameters == min(record["laws"], key=lambda of: of["bic_above_least"])["parameters"]


def test_a_comparison_is_that_of_the_program(small: zc.Results, axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """Two files, and two points by number or label, are compared as by the program; margins and options are passed on."""
    slower = small.study.set(**{"controller.delay": 2}).run(tmp_path / "slower.h5")
    margins = tmp_path / "margins.yaml"
    wide = "{success_rate: 0.5, arrival_rate: 0.5, stable_rate: 0.5, jerk_count: 1000, settling_time: 1}"
    margins.write_text(f"margins: {wide}\n", encoding="utf-8")
    label = small.study.labels[2]
    calls: list[tuple[zc.Comparison, tuple[object, ...]]] = [
        (zc.compare(small, slower), (small.path, slower.path)),
        (zc.compare(str(small.path), slower.path, margins=margins), (small.path, slower.path, "--margins", margins)),
        (zc.compare(small, points=(0, 1), changed_fails=True), (small.path, "--points", 0, 1, "--changed-fails")),
        (zc.compare(small, points=(1, label)), (small.path, "--points", 1, label)),
        (zc.compare(small, small), (small.path, small.path)),
    ]
    for comparison, words in calls:
        assert has_all_of(comparison, json.loads(by_program("compare", *words, "--format", "json", accepted=(0, 1, 3))))
        rows = comparison.table
        assert len(rows) == sum(len(point["measures"]) for point in comparison.points) and {"label", "measure"} <= set(rows)
    verdicts = [comparison.verdict for comparison, _ in calls]
    assert verdicts[0] == "regression" and verdicts[-1] == "passed" and verdicts[3] == "regression"
    with pytest.raises(zc.DataError, match="cannot be compared"):
        zc.compare(small, small.study.without("sweep").set(**{"controller.ki": 1e4}).run(tmp_path / "one.h5"))
    for files in (("nowhere.h5", small), (small, "nowhere.h5")):
        with pytest.raises(zc.DataError, match="nowhere.h5: no such file; expected a results file"):
            zc.compare(*files)


PLANS: list[tuple[dict[str, Any], list[str]]] = [
    ({"success": 0.99}, ["--success", "0.99"]),
    ({"success": 0.999, "confidence": 0.99, "failures": 1}, ["--success", "0.999", "--confidence", "0.99", "--failures", "1"]),
    ({"success": 0.99, "true_success": 0.995, "power": 0.9}, ["--success", "0.99", "--true-success", "0.995", "--power", "0.9"]),
    ({"halfwidth": 0.01}, ["--halfwidth", "0.01"]),
    ({"success": 0.97, "rigs_share": 0.9}, ["--success", "0.97", "--rigs-share", "0.9"]),
    ({"halfwidth": 0.02, "rig_sd": 0.1, "true_success": 0.9}, ["--halfwidth", "0.02", "--rig-sd", "0.1", "--true-success", "0.9"]),
]


@pytest.mark.parametrize(("given", "words"), PLANS, ids=lambda value: str(value) if isinstance(value, dict) else "")
def test_a_plan_is_that_of_the_program(given: dict[str, Any], words: list[str]) -> None:
    """The plans are those of the JSON, one row each."""
    plan, record = zc.plan(**given), json.loads(by_program("plan", *words, "--format", "json"))
    assert plan.answer == record and plan.plans == record.get("plans", [record])
    assert len(plan.table) == len(plan.plans) > 0


def test_a_plan_is_made_for_a_study_or_a_pilot(axis: zc.Study, folder: pathlib.Path, small: zc.Results) -> None:
    """A study, with its settings, a manifest and results are planned as by the program."""
    manifest = folder / "my-axis.yaml"
    goal = {"band": 1, "within": 0.05, "moves": 0.8}
    calls: list[tuple[Any, tuple[object, ...]]] = [
        (axis, (manifest,)),
        (axis.set(goal=goal), (manifest, "--set", f"goal={zc.manifests.flow_text(goal)}")),
        (manifest, (manifest,)),
        (small, (small.path,)),
        (str(small.path), (small.path,)),
    ]
    for pilot, words in calls:
        assert zc.plan(pilot).answer == json.loads(by_program("plan", *words, "--format", "json"))
    margin = {"success_rate": 0.2, "settling_time": "50%"}
    few = axis.without("rigs").set(trials=50, **{"command.hold": 0.1}).sweep("controller.ki", [1e4])
    few.save(folder / "few.yaml")
    words = ["--margin", "success_rate=0.2", "--margin", "settling_time=50%", "--power", 0.9]
    record = json.loads(by_program("plan", folder / "few.yaml", *words, "--format", "json"))
    assert zc.plan(few, margin=margin, power=0.9).answer == record


def test_a_plan_without_a_question_is_refused() -> None:
    """A call that asks nothing says what is expected."""
    with pytest.raises(zc.ManifestError, match="expected --success or --halfwidth"):
        zc.plan()


def test_options_are_words() -> None:
    """Names have hyphens; None and False are left out, lists and dicts repeat the option."""
    words = options(
        dac_bits=16, quiet=True, none=None, no=False, zero=0, exclude=["0:1", "2:3"], fix={"friction.n": 2, "a": 0.5, "t": "5%"},
        posterior=pathlib.Path("a b.csv"), point=("x", 1), text="--odd", number=np.float64(0.1), margin={"f": {"relative": 0.1}}, empty=[],
    )  # fmt: skip
    assert words == [
        "--dac-bits", "16", "--quiet", "--zero", "0", "--exclude", "0:1", "--exclude", "2:3", "--fix", "friction.n=2", "--fix", "a=0.5",
        "--fix", "t=5%", "--posterior", "a b.csv", "--point", "x", "--point", "1", "--text", "--odd", "--number", "0.1",
        "--margin", "f={relative: 0.1}",
    ]  # fmt: skip


def test_a_dataclass_takes_its_fields_from_an_object() -> None:
    """Fields are taken by their names, others are left; what is given takes the place of the object's."""
    record = {"point": 1, "label": "a", "status": "met", "rate": 1.0, "rate_low": 0.9, "rate_high": 1.0, "unknown": 5}
    judgement = zc.Judgement.of(record)
    assert (judgement.point, judgement.machines_low, judgement.chosen_from) == (1, None, 1)
    assert dataclass_of(zc.Judgement, record, point=7).point == 7
    with pytest.raises(TypeError):
        dataclass_of(zc.Judgement, {})
