"""Studies: manifests as files and dicts, settings, sweeps and errors."""

from __future__ import annotations

import pathlib
import pickle
import random
from typing import Any

import h5py
import numpy as np
import pytest
import zerocount as zc
from support import SHIPPED, by_program, dear_by_night, said_by_program, same, same_trace
from zerocount.checked import manifest_tree
from zerocount.manifests import flow_text, yaml_text

AWKWARD = [
    "", " ", " leading", "trailing ", "two  blanks", "1", "1.0", "-1", "+1", "1e5", ".5", "0x10", "010", "1_000", "_1",
    "1:30", "nan", ".nan", ".inf", "-.inf", "Infinity", "yes", "No", "ON", "y", "true", "True", "null", "Null", "~",
    "a: b", "a:b", ":", "a #b", "#", "# a", "-", "- a", "--", "---", "...", ".", "?", "? a", "!", "!a", "&a", "*a",
    "%a", "@a", "`a", "|", ">", "'", '"', "it's", 'say "so"', "\\", "a\\nb", "a\nb", "\n", "a\n", "\ta", "a\tb", "{",
    "}", "[a]", "a, b", ",", "=", "<<", "é", "β", "10 µm", "K→∞", "𝛼", "ß: ", "a.b", "a/b", "/", "./a", "../b.csv",
    "a b-c_d", "x-", "x+", "a=b", "a\u00a0b", "\ufeffa", "a\u200bb", "x" * 300,
]  # fmt: skip
KEYS = ["a", "b1", "friction", "x_y", "kp", "some-name", "A"]


def random_value(rng: random.Random, depth: int) -> Any:
    """A value that a manifest can have."""
    kind = rng.randrange(9 if depth > 0 else 6)
    if kind == 0:
        return rng.choice([None, True, False])
    if kind == 1:
        return rng.choice([0, 7, -3, 2**53 + 1, 2**63, 2**64 - 1, -(2**63), rng.randrange(-1000, 1000)])
    if kind == 2:
        return rng.choice([0.0, -0.0, 1.0, 1e16, 1e-7, 5e-324, 1.7976931348623157e308, rng.gauss(0, 1), 10 ** rng.uniform(-300, 300)])
    if kind < 6:
        return rng.choice(AWKWARD) if kind < 5 else "".join(rng.choices(" :#-'\"\\,[]{}&*!|>%@`?.eE0123456789_xyn~é\n\t", k=5))
    if kind == 6:
        return [random_value(rng, depth - 1) for _ in range(rng.randrange(4))]
    return random_map(rng, depth - 1)


def random_map(rng: random.Random, depth: int) -> dict[str, Any]:
    return {key: random_value(rng, depth) for key in rng.sample(KEYS, rng.randrange(1 if depth < 3 else 0, 5))}


@pytest.mark.parametrize("path", dear_by_night(SHIPPED), ids=lambda path: path.stem)
def test_a_shipped_manifest_survives_a_dict(path: pathlib.Path) -> None:
    """A shipped manifest that was made a dict and a study again is the same study."""
    study = zc.study(path)
    again = zc.study(study.to_dict())
    for what in ("labels", "trials", "machines", "worlds", "moves", "goal", "name"):
        assert getattr(again, what) == getattr(study, what)
    for what in ("inputs", "axes", "bands", "seed", "description"):
        assert repr(getattr(again.checked, what)) == repr(getattr(study.checked, what))
    assert same_trace(zc.trial(again), zc.trial(study))


def test_a_shipped_study_comes_with_the_program() -> None:
    """A study is found by its name, with its observations; an unknown name is refused with the nearest."""
    for path in SHIPPED[::9]:
        assert zc.shipped(path.stem).text == path.read_text(encoding="utf-8")
    assert zc.shipped("why-presliding").observed["presliding"] == "stable in all tests"
    with pytest.raises(zc.ManifestError, match="paper-gains"):
        zc.shipped("paper-gain")


@pytest.mark.parametrize("text", AWKWARD, ids=ascii)
def test_a_text_reads_back(text: str) -> None:
    """A text is the same after it was written as YAML: as a value, in a list, in a map and in a setting."""
    tree = {"a": text, "b": {"c": text, "d": [text, {"e": text}]}}
    assert manifest_tree(yaml_text(tree), "<test>", []) == tree
    assert manifest_tree("a: 1\n", "<test>", ["b=" + flow_text(text)]) == {"a": 1, "b": text}


@pytest.mark.parametrize("letter", ["\0", "\a", "\x1b", "\x7f", "\x85", "\u2028", "\u2029"], ids=ascii)
def test_a_text_that_cannot_be_printed_is_refused(axis: zc.Study, letter: str) -> None:
    """A control character is refused where the text is used."""
    with pytest.raises(zc.ManifestError, match=rf"control character U\+{ord(letter):04X} in a text; expected a printable text"):
        axis.set(description=f"a{letter}b").checked
    with pytest.raises(zc.ManifestError, match=rf"control character U\+{ord(letter):04X} in a text; expected a printable text"):
        zc.study({**axis.to_dict(), "description": f"a{letter}b"})


def test_a_dict_reads_back() -> None:
    """A dict is the same, to the types of its values, after it was written as YAML or given as settings."""
    rng = random.Random(1)
    for _ in range(400):
        tree = {"z": 1, **random_map(rng, 3)}
        assert repr(manifest_tree(yaml_text(tree), "<test>", [])) == repr(tree)
        settings = [f"{key}={flow_text(value)}" for key, value in tree.items()]
        assert repr(manifest_tree("z: 0\n", "<test>", settings)) == repr(tree)


def test_numbers_of_numpy_are_written_as_those_of_python() -> None:
    """Arrays and numbers of NumPy are lists and numbers of a manifest."""
    values = {"a": np.float64(0.1), "b": np.int64(3), "c": np.bool_(True), "d": np.array([1.5, 2]), "e": (1, 2)}
    assert yaml_text(values) == "a: 0.1\nb: 3\nc: true\nd: [1.5, 2.0]\ne: [1, 2]\n"


@pytest.mark.parametrize("value", [float("nan"), float("inf"), object(), b"bytes", {"a": {1, 2}}], ids=repr)
def test_a_value_that_a_manifest_cannot_have_is_refused(axis: zc.Study, value: Any) -> None:
    """What YAML cannot express is refused where it is given."""
    with pytest.raises(zc.ManifestError, match="a manifest has no value"):
        axis.set(**{"friction.k1": value})
    with pytest.raises(zc.ManifestError, match="a manifest has no value"):
        zc.study({**axis.to_dict(), "description": value})


def test_a_setting_equals_the_option_set_of_the_program(axis: zc.Study, folder: pathlib.Path) -> None:
    """The hash of a study with settings is the one that `zerocount run --set` records, and their order counts."""
    values: dict[str, Any] = {
        "trials": 4, "machines": 2, "controller.delay": 1, "friction.k1": {"lognormal": {"median": 80, "cv": 0.1}},
        "command.targets.0": 5, "sweep.grid.controller.ki": [5000.0, 2e4], "description": "yes: a #text",
    }  # fmt: skip
    for number, order in enumerate([list(values), list(values)[::-1]]):
        study = axis.set(**{key: values[key] for key in order})
        output = folder / f"set-{number}.h5"
        words = [word for key in order for word in ("--set", f"{key}={flow_text(values[key])}")]
        by_program("run", folder / "my-axis.yaml", "-o", output, "-q", *words)
        assert study.sha256 == h5py.File(output).attrs["study_sha256"]
        assert study.run(folder / f"set-by-package-{number}.h5").checked.sha256 == study.sha256
        assert zc.open(output).study.sha256 == study.sha256


def test_the_last_setting_of_a_key_holds(axis: zc.Study) -> None:
    """A study does not change; a later setting takes the place of an earlier one, also of a part of it."""
    study = axis.set(trials=2000, machines=10).set(trials=30)
    assert (axis.trials, study.trials, study.machines) == (400, 30, 10)
    part = axis.set(**{"command.targets.0": 5}).set(command={"targets": [7, 8, 9], "hold": 0.5})
    assert part.moves == 3 and part.set(**{"command.targets.0": 5}).to_dict()["command"]["targets"] == [5, 8, 9]


def test_a_sweep_has_the_given_values(axis: zc.Study) -> None:
    """A sweep takes the place of one of the same key; with another key the points are all pairs."""
    gains, delays = np.geomspace(5e3, 1e5, 4), [0, 0.5, 1]
    one = axis.sweep("controller.ki", gains)
    assert [swept["values"] for swept in one.checked.axes] == [gains.tolist()]
    two = one.sweep("controller.delay", delays)
    assert list(zip(*(swept["values"] for swept in two.checked.axes))) == [(ki, d) for ki in gains for d in delays]
    assert all(zc.trial(two, point).inputs["controller.ki"] == gains[point // 3] for point in range(12))
    cases = axis.set(**{"sweep.cases": {"soft": {"friction.k1": 60}, "stiff": {"friction.k1": 120}}})
    assert len(cases.labels) == 16 and cases.labels[8].startswith("stiff, controller.ki=5000")


def test_without_removes_keys(axis: zc.Study) -> None:
    """A study without some keys has their defaults, keeps everything else, and ignores keys that it lacks."""
    study = axis.set(trials=3000, **{"controller.delay": 1, "controller.kp": 10.0, "dac.bits": 14})
    tree = study.to_dict()
    less = study.without("sweep", "controller.delay", "friction.alpha", "no.such.key", "name.x")
    for section, key in (("controller", "delay"), ("friction", "alpha")):
        del tree[section][key]
    del tree["sweep"]
    assert less.to_dict() == tree
    one = less.set({"controller.ki": 1e4})
    assert (one.labels, one.trials) == (["all"], 3000)
    assert "friction.alpha" not in zc.trial(one).inputs
    assert study.without().to_dict() == study.to_dict()


def test_a_study_is_checked_only_when_it_is_asked(axis: zc.Study) -> None:
    """Two keys that exclude one another can change places in either order."""
    changed = [
        axis.without("dac.resolution").set(**{"dac.range": 0.5}),
        axis.set(**{"dac.range": 0.5}).without("dac.resolution"),
    ]
    assert changed[0].to_dict() == changed[1].to_dict() and changed[1].trials == 400


@pytest.mark.parametrize("path", dear_by_night(SHIPPED), ids=lambda path: path.stem)
def test_a_study_at_a_point_has_its_trials(path: pathlib.Path) -> None:
    """A study at its last point, by number or label, has the trials of that point, unless the point has distributions."""
    study = zc.study(path)
    point = len(study.labels) - 1
    try:
        one = study.at(point)
        assert len(one.labels) == 1 and study.at(study.labels[point]).to_dict() == one.to_dict()
    except zc.ManifestError as error:
        assert "has a distribution at the point" in str(error)
        return
    there, here = zc.trial(study, point, 3), zc.trial(one, 0, 3)
    for name in ("t", "error", "torque", "theta", "omega", "xp"):
        assert same(here.samples[name], there.samples[name])
    assert here.outcome["outcome"].tolist() == there.outcome["outcome"].tolist()
    for wrong in (-1, len(study.labels), "no such label"):
        with pytest.raises(zc.ManifestError, match="there is no point"):
            study.at(wrong)


def test_a_study_survives_conversion_and_pickling(axis: zc.Study) -> None:
    """A study is taken as it is, survives pickling, and is shown also where it is wrong."""
    assert zc.study(axis) is axis
    study = axis.set({"controller.delay": 1}, trials=3000)
    assert study.trials == 3000 and study.to_dict() == axis.set(trials=3000, **{"controller.delay": 1}).to_dict()
    again = pickle.loads(pickle.dumps(study))
    assert again.sha256 == study.sha256 and repr(again) == "<Study 'my-axis': 8 design points × 3000 trials>"
    assert axis.sweep("controller.ki", {"logspace": [5e3, 1e5, 8]}).labels == axis.labels
    assert "my-axis" in repr(axis.set(machines=0))


def test_a_saved_study_reads_again(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """A study that is saved and read is the same; without settings its text stays as it was."""
    axis.save(tmp_path / "same.yaml")
    assert (tmp_path / "same.yaml").read_bytes() == axis.text.encode() and zc.study(tmp_path / "same.yaml").sha256 == axis.sha256
    study = axis.set(name="β: #1", **{"controller.delay": 1})
    study.save(tmp_path / "changed.yaml")
    again = zc.study(tmp_path / "changed.yaml")
    assert again.to_dict() == study.to_dict() and same_trace(zc.trial(again, 3, 5), zc.trial(study, 3, 5))


JOINT = """\
zerocount: 1
name: joint
seed: 3
trials: 60
samples: posterior.csv
goal: {band: 1, within: 0.2, moves: 0.9}
command: {targets: [{integers: [1, 30]}], hold: 0.3}
initial: {encoder_phase: {uniform: [0, 1]}}
"""
POSTERIOR = "friction.k1,friction.k2,friction.beta\n108,741,81200\n112,752,79650\n95,700,1.1e5\n130,620,1.3e5\n"


@pytest.fixture(scope="module")
def joint(tmp_path_factory: pytest.TempPathFactory) -> zc.Study:
    """A study that names a table in the folder of its manifest."""
    place = tmp_path_factory.mktemp("joint")
    (place / "joint.yaml").write_text(JOINT, encoding="utf-8")
    (place / "posterior.csv").write_text(POSTERIOR, encoding="utf-8")
    return zc.study(place / "joint.yaml")


def test_a_file_that_a_manifest_names_is_found_from_its_folder(
    joint: zc.Study, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A table is found from any folder, by this process and by the program, for all variants of the study."""
    monkeypatch.chdir(tmp_path)
    for study in (joint, joint.set(seed=4), joint.without("goal"), joint.sweep("controller.delay", [0, 1])):
        assert zc.trial(study).inputs["friction.k1"] in (108, 112, 95, 130)
        assert "joint" in str(study.check())
        assert study.run("joint.h5", force=True).path == tmp_path / "joint.h5"


def test_results_need_no_file_that_their_manifest_names(joint: zc.Study, tmp_path: pathlib.Path) -> None:
    """A results file in another folder than its manifest gives all tables, traces and samples: the table is in it."""
    r = joint.run(tmp_path / "elsewhere.h5")
    assert r.judge().status == "met" and r.checked.trials == 60
    assert zc.trial(r).inputs == r.trace().inputs
    assert len(r.trials()) == 60 and r.table.loc[0, "goal"] == "met"
    assert len(zc.sample(r).names) == 3


def test_an_error_of_a_manifest_has_its_place(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """Every error of a file has its line, column and key."""
    text = axis.text.replace("k2:", "k22:").replace("bits: 16", "bits: 99")
    path = tmp_path / "bad.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(zc.ManifestError) as raised:
        zc.study(path)
    error = raised.value
    lines = text.splitlines()
    assert [problem.key for problem in error.problems] == ["friction.k22", "dac.bits"]
    for problem, word in zip(error.problems, ("k22", "99")):
        assert problem.file == str(path) and problem.setting is None
        assert lines[problem.line - 1].encode()[problem.column - 1 :].startswith(word.encode())
        assert problem.text.startswith(problem.key + ": ") and "; expected" in problem.text
    assert (error.file, error.line, error.key, error.code) == (str(path), error.problems[0].line, "friction.k22", 2)
    assert isinstance(error, ValueError) and error.message == str(error) == said_by_program("check", path)


def test_an_error_of_a_dict_has_its_key(axis: zc.Study) -> None:
    """An error of a dict has the key, and no place in a text that the user has not seen."""
    tree = axis.to_dict()
    tree["friction"]["k11"] = 3
    tree["command"]["hold"] = -1
    with pytest.raises(zc.ManifestError) as raised:
        zc.study(tree)
    assert [problem.key for problem in raised.value.problems] == ["friction.k11", "command.hold"]
    assert {(problem.file, problem.line, problem.column) for problem in raised.value.problems} == {(None, None, None)}


def test_a_study_at_a_point_has_the_lists_that_are_swept(axis: zc.Study) -> None:
    """A swept list has its entries at the point."""
    study = axis.without("sweep").set({"controller.ki": 1e4}).sweep("command.targets", [[0, 5], [1, 2]]).sweep("controller.kp", [0, 10])
    for point in range(4):
        ours, whole = zc.trial(study.at(point), 0, 3), zc.trial(study, point, 3)
        assert all((ours.samples[name] == whole.samples[name]).all() for name in whole.samples)


BAD_SETTINGS: list[tuple[str, Any, str]] = [
    ("dac.bits", 99, "dac.bits"),
    ("friction.k11", 3, "friction.k11"),
    ("machines", 0, "machines"),
    ("controller.sample_rate", "fast", "controller.sample_rate"),
    ("controller.sample_rate", "very fast", "controller.sample_rate"),
    ("friction.k1", {"uniform": [-1, 2]}, "friction.k1.uniform"),
    ("friction.k1", {"normal": {"mean": 110, "sd": 15}}, "friction.k1.normal"),
    ("sweep.grid.controller.delay", [0, -1], "sweep.grid.controller.delay.1"),
    ("description", 3, "description"),
    ("goal", {"band": 1, "within": 9, "moves": 0.9}, "goal.within"),
]


@pytest.mark.parametrize(("key", "value", "named"), BAD_SETTINGS, ids=lambda value: flow_text(value))
def test_an_error_of_a_setting_has_the_setting(axis: zc.Study, key: str, value: Any, named: str) -> None:
    """An error of a setting has the whole setting and the key, in this process and from the program."""
    study = axis.set(**{key: value})
    for ask in (lambda: study.checked, study.check):
        with pytest.raises(zc.ManifestError) as raised:
            ask()
        (problem,) = raised.value.problems
        assert (problem.setting, problem.key) == (f"{key}={flow_text(value)}", named)
        assert problem.text.startswith(named + ": ") and problem.file is None


def test_an_error_that_a_setting_causes_elsewhere_names_the_manifest(axis: zc.Study) -> None:
    """An error in the text has the name of the manifest, also where the program finds it."""
    study = axis.set(**{"dac.range": 0.5})
    for ask in (lambda: study.checked, study.check):
        with pytest.raises(zc.ManifestError) as raised:
            ask()
        assert (raised.value.file, raised.value.key) == (axis._source, "dac.resolution")


def test_errors_can_be_sent_to_another_process(axis: zc.Study) -> None:
    """An error survives pickling with all its parts."""
    with pytest.raises(zc.ManifestError) as raised:
        axis.set(machines=0).checked
    again = pickle.loads(pickle.dumps(raised.value))
    assert type(again) is zc.ManifestError and again.problems == raised.value.problems and again.code == 2


@pytest.mark.parametrize("name", ["missing.yaml", ".", "no-text.yaml"])
def test_files_that_are_not_manifests_are_refused(name: str, tmp_path: pathlib.Path) -> None:
    """A missing file, a folder and a file that is no text give an error with the file's name."""
    (tmp_path / "no-text.yaml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(zc.ManifestError, match="expected a manifest") as raised:
        zc.study(tmp_path / name)
    assert str(tmp_path) in str(raised.value)
