"""Results files of studies with ages, judged by numpy: indices, laws of aging, counts, machines and lives, from the trials alone;
and runs in pieces, interrupted, extended and by any number of threads, which give the same file.

usage: judge_ages.py ZEROCOUNT
"""

import json
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
LAWS = {
    "linear": lambda rate, ages: 1 + rate * ages,
    "exponential": lambda rate, ages: np.exp(rate * ages),
    "logarithmic": lambda rate, ages: 1 + rate * np.log10(1 + ages),
}
FORMS = {
    "friction.k1": ({"lognormal": {"median": 110, "cv": 0.3}}, {"uniform": [90, 130], "per": "trial"}),
    "friction.k2": ({"value": 750}, {"uniform": [600, 900]}),
    "friction.alpha": ({"uniform": [0.2, 0.9], "per": "study"}, {"value": 0.5}),
    "plant.inertia": ({"value": 5.54e-4}, {"uniform": [5e-4, 6e-4]}),
    "friction.lambda": ({"interval": [5, 20]},),
}
RATES = (0.1, -0.05, {"uniform": [-0.2, 0.1]}, {"normal": {"mean": -0.1, "sd": 0.02}})
OF_A_RUN = {"created", "REFERENCE_LIST", "DIMENSION_LIST"}  # attributes with times and addresses


def random_study(draw):
    """A manifest, and its aged values: {path: law, scale, rate of a number, value of a number}."""
    machines, conditions, ages, worlds = 2 * draw.randint(1, 3), draw.randint(0, 2), draw.randint(1, 4), draw.choice([0, 2])
    at = [draw.choice([0, 2])]
    while len(at) < ages:
        at.append((at[-1] + 1) * draw.randint(2, 40))
    each = draw.randint(1, 3)
    manifest = {
        "zerocount": 1, "name": "aged", "seed": draw.randint(0, 1 << 40), "machines": machines,
        "trials": machines * max(conditions, 1) * ages * each, "design": draw.choice(["monte_carlo", "latin_hypercube", "sobol"]),
        "ages": {"at": at, "unit": draw.choice(["cycles", "h", "km"])},
        "friction": {}, "plant": {}, "initial": {"position": {"uniform": [0, 6]}},
        "controller": {"ki": draw.choice([3e-5, 6e-5])},
        "sweep": {"grid": {"controller.kp": [0, 3e-4][:draw.randint(1, 2)]}},
        "command": {"targets": [{"integers": [1, 20]}, 3], "hold": 0.08},
        "goals": {"first": {"on": [0], "band": 1, "within": 0.03, "moves": 0.6, "machines": 0.5},
                  "second": {"on": [1], "band": 0, "within": 0.04, "moves": 0.5}},
    }
    if draw.random() < 0.5:
        manifest["goal"] = {"band": 1, "within": 0.03, "moves": 0.7}
        del manifest["goals"]
    if worlds:
        manifest["worlds"] = worlds
    if conditions:
        manifest["conditions"] = {f"c{c}": {"controller.ki": 2e-5 * (c + 1)} for c in range(conditions)}
        manifest["conditions"]["c0"] = {}
    values = {}
    for path in draw.sample(sorted(FORMS), 3):
        section, key = path.split(".")
        form = draw.choice(FORMS[path])
        if "interval" in form and not worlds:
            continue
        law, scale, rate = draw.choice(sorted(LAWS)), float(max(at[-1], 1) * draw.randint(1, 5)), draw.choice(RATES)
        manifest[section][key] = {**form, "aging": {law: rate, "scale": scale}}
        values[path] = (law, scale, rate if isinstance(rate, float) else None, form.get("value"))
    return manifest, values


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="zerocount-ages-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, *words, codes=(0,)):
        result = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        self.assertIn(result.returncode, codes, f"{words}: {result.stderr}")
        return result.stdout

    def write(self, name, manifest):
        (self.folder / name).write_text(json.dumps(manifest))  # JSON is YAML

    def contents(self, name):
        """All datasets and attributes, but for what tells when it was made."""
        found = {}
        with h5py.File(self.folder / name) as file:
            file.visititems(lambda path, item: found.__setitem__(path, item[()] if isinstance(item, h5py.Dataset) else None))
            for path in ["/", *found]:
                for key, value in file[path].attrs.items():
                    if key not in OF_A_RUN:
                        found[f"{path}@{key}"] = value
        return found

    def expect_equal(self, one, other):
        first, second = self.contents(one), self.contents(other)
        self.assertEqual(sorted(first), sorted(second))
        for path, value in first.items():
            np.testing.assert_array_equal(value, second[path], err_msg=path)


class Trials(Files):
    def judge(self, name, manifest, values):
        machines, at = manifest["machines"], np.array(manifest["ages"]["at"], float)
        conditions, worlds = max(len(manifest.get("conditions", {})), 1), manifest.get("worlds", 0)
        with h5py.File(self.folder / name) as file:
            index, point = file["trial/index"][:], file["trial/point"][:]
            machine, condition = index % machines, index // machines % conditions
            age = index // (machines * conditions) % len(at)
            draw = index % machines + machines * (index // (machines * conditions * len(at)))
            self.assertEqual(file["age/age"][:].tolist(), at.tolist())
            self.assertEqual(file["age/age"].attrs["units"], manifest["ages"]["unit"])
            inputs = {path: data[:] for path, data in file["trial/input"].items()}
            turns = {"machine": machine, "world": draw % worlds if worlds else None}
            for path, (law, scale, rate, number) in values.items():
                rates = inputs.get(f"{path}.aging", rate)
                if rate is None:
                    of_machine = file[f"machine/input/{path}.aging"][:]
                    np.testing.assert_array_equal(rates, of_machine[machine])
                    self.assertEqual(len(set(of_machine)), machines)
                new = inputs[path] / LAWS[law](rates, at[age] / scale)
                if number is not None:
                    np.testing.assert_allclose(new, number, rtol=1e-12)
                for group in set(zip(point, draw, condition)):  # one draw at every age
                    same = (point == group[0]) & (draw == group[1]) & (condition == group[2])
                    np.testing.assert_allclose(new[same], new[same][0], rtol=1e-12)
                if "interval" in str(manifest[path.split(".")[0]][path.split(".")[1]]):
                    for world in range(worlds):
                        np.testing.assert_allclose(new[turns["world"] == world], new[turns["world"] == world][0], rtol=1e-12)
            if conditions > 1:
                expected = np.array([manifest["conditions"][c].get("controller.ki", manifest["controller"]["ki"])
                                     for c in manifest["conditions"]])
                np.testing.assert_array_equal(inputs["controller.ki"], expected[condition])
            self.judge_counts(file, manifest, point, machine, condition, age)

    def judge_counts(self, file, manifest, point, machine, condition, age):
        at, machines, conditions = file["age/age"][:], manifest["machines"], max(len(manifest.get("conditions", {})), 1)
        groups = max(manifest.get("worlds", 0), 1)
        bands, times = file["band"][:].tolist(), file["outcome/band_settling_time"][:]
        success = (file["outcome/outcome"][:] == 0).all(axis=1)
        goals = list(manifest["goals"].values()) if "goals" in manifest else [manifest["goal"]]
        moves = [(times[:, goal.get("on", [0, 1]), bands.index(goal["band"])] <= goal["within"] * (1 + 1e-9), goal["moves"])
                 for goal in goals]
        meets = np.logical_and.reduce([met.all(axis=1) for met, _ in moves])
        for p in range(point.max() + 1):
            lives, alive = np.full(machines, np.nan), np.ones(machines, bool)
            for a in range(len(at)):
                here = (point == p) & (age == a)
                self.assertEqual([file[f"age/{name}"][p, a] for name in ("trials", "success", "goal_met")],
                                 [here.sum(), success[here].sum(), meets[here].sum()])
                meeting = np.array([all(met[here & (machine == r) & (condition == c)].mean() >= wanted
                                        for met, wanted in moves for c in range(conditions)) for r in range(machines)])
                proportion = min(meeting[world::groups].mean() for world in range(groups))
                self.assertAlmostEqual(file["age/machines"][p, a], proportion, 12)
                self.assertTrue(0 <= file["age/machines_low"][p, a] <= proportion <= file["age/machines_high"][p, a] <= 1)
                alive &= meeting
                lives[alive] = at[a]
            np.testing.assert_array_equal(file["machine/life"][p], lives)
            for c in range(conditions if conditions > 1 else 0):
                here = (point == p) & (condition == c)
                self.assertEqual([file[f"condition/{name}"][p, c] for name in ("trials", "success", "goal_met")],
                                 [here.sum(), success[here].sum(), meets[here].sum()])

    def test_random_studies_match_the_judge(self):
        draw = random.Random(66)
        for number in range(15):
            with self.subTest(number):
                manifest, values = random_study(draw)
                self.write("aged.yaml", manifest)
                self.run_program("run", "aged.yaml", "-o", "aged.h5", "-q", "--force")
                self.judge("aged.h5", manifest, values)

    def test_aging_changes_no_other_draw(self):
        manifest, _ = random_study(random.Random(3))
        manifest.update(friction={"k1": {"lognormal": {"median": 110, "cv": 0.3}}, "k2": {"uniform": [600, 900]}}, plant={})
        aged = json.loads(json.dumps(manifest))
        aged["friction"]["k2"]["aging"] = {"linear": {"uniform": [0, 0.1]}, "scale": 10.0}
        for name, one in (("plain", manifest), ("aged", aged)):
            self.write(f"{name}.yaml", one)
            self.run_program("run", f"{name}.yaml", "-o", f"{name}.h5", "-q")
        with h5py.File(self.folder / "plain.h5") as plain, h5py.File(self.folder / "aged.h5") as other:
            for path in plain["trial/input"]:
                if path != "friction.k2":
                    np.testing.assert_array_equal(plain[f"trial/input/{path}"], other[f"trial/input/{path}"])

    def test_both_engines_have_the_same_aged_inputs(self):
        manifest, _ = random_study(random.Random(8))
        self.write("aged.yaml", manifest)
        for engine in ("batch", "reference"):
            self.run_program("run", "aged.yaml", "-o", f"{engine}.h5", "-q", "--engine", engine)
        with h5py.File(self.folder / "batch.h5") as lanes, h5py.File(self.folder / "reference.h5") as reference:
            np.testing.assert_array_equal(lanes["outcome/outcome"], reference["outcome/outcome"])
            for path in lanes["trial/input"]:
                np.testing.assert_array_equal(lanes[f"trial/input/{path}"], reference[f"trial/input/{path}"])

    def test_answers_agree_with_the_file(self):
        manifest, _ = random_study(random.Random(12))
        manifest["ages"]["at"] = [0, 10]
        manifest["trials"] = 2 * manifest["machines"] * max(len(manifest.get("conditions", {})), 1) * 3
        manifest.update(friction={"k1": {"uniform": [100, 120], "aging": {"exponential": -0.1, "scale": 10.0}}}, plant={})
        self.write("aged.yaml", manifest)
        self.run_program("run", "aged.yaml", "-o", "aged.h5", "-q")
        points = json.loads(self.run_program("summary", "aged.h5", "--format", "json"))["points"]
        judged = json.loads(self.run_program("judge", "aged.h5", "--format", "json", codes=(0, 1, 3)))
        with h5py.File(self.folder / "aged.h5") as file:
            for number, point in enumerate(points):
                for name in ("trials", "success", "goal_met", "machines", "machines_low", "machines_high"):
                    self.assertEqual([row[name] for row in point["ages"]], file[f"age/{name}"][number].tolist())
                lives = file["machine/life"][number]
                self.assertEqual([row["living"] for row in point["ages"]], [(lives >= a).mean() for a in (0, 10)])
                for row in point["ages"]:  # the rate is that of a claim at this age
                    at_age = [c["rate"] for c in point["claims"] if c["condition"].endswith(f"{row['age']:g} {manifest['ages']['unit']}")]
                    self.assertIn(row["rate"], at_age)
        missed = [row["age"] for row in judged["ages"] if row["status"] == "missed"]
        self.assertEqual(judged.get("missed_from"), missed[0] if missed else None)
        met = [row["age"] for row in judged["ages"] if row["status"] == "met"]
        self.assertEqual(judged.get("met_until") is None, judged["ages"][0]["status"] != "met")
        self.assertEqual(judged["status"] == "met", len(met) == 2)


class Runs(Files):
    def study(self, trials):
        manifest, _ = random_study(random.Random(21))
        manifest.update(machines=6, worlds=3, trials=trials, design="monte_carlo", goal={"band": 1, "within": 0.03, "moves": 0.7},
                        conditions={"empty": {}, "loaded": {"plant.inertia": 7e-4}}, ages={"at": [0, 5, 50]}, plant={},
                        friction={"k1": {"uniform": [90, 130], "aging": {"linear": {"uniform": [-0.2, 0]}, "scale": 50.0}},
                                  "lambda": {"interval": [5, 20], "aging": {"logarithmic": 0.1, "scale": 5.0}}})
        manifest.pop("goals", None)
        return manifest

    def test_the_file_does_not_depend_on_how_it_was_run(self):
        for keep in ("trials", "statistics", "failures"):
            with self.subTest(keep):
                self.write(f"{keep}.yaml", {**self.study(144), "keep": keep})
                for threads in (1, 2):
                    self.run_program("run", f"{keep}.yaml", "-o", f"{keep}{threads}.h5", "-q", "--threads", threads)
                for part in (1, 2, 3):
                    self.run_program("run", f"{keep}.yaml", "--shard", f"{part}/3", "-o", f"{keep}-part{part}.h5", "-q")
                self.run_program("merge", *[f"{keep}-part{part}.h5" for part in (1, 2, 3)], "-o", f"{keep}-merged.h5")
                self.expect_equal(f"{keep}1.h5", f"{keep}2.h5")
                self.expect_equal(f"{keep}1.h5", f"{keep}-merged.h5")
        for group in ("age", "machine", "condition", "world"):
            whole, sums = self.contents("trials1.h5"), self.contents("statistics1.h5")
            for path in whole:
                if path.startswith(f"{group}/") and "@" not in path and whole[path] is not None:
                    np.testing.assert_array_equal(whole[path], sums[path], err_msg=path)

    def test_more_trials_extend_the_file(self):
        for trials in (72, 288):
            self.write(f"{trials}.yaml", self.study(trials))
        self.run_program("run", "72.yaml", "-o", "extended.h5", "-q")
        self.run_program("run", "288.yaml", "-o", "extended.h5", "-q")
        self.run_program("run", "288.yaml", "-o", "fresh.h5", "-q")
        self.expect_equal("extended.h5", "fresh.h5")

    def test_an_interrupted_run_continues(self):
        self.write("long.yaml", self.study(12024))
        shards = self.folder / "resumed.h5.shards"
        process = subprocess.Popen([PROGRAM, "run", "long.yaml", "-o", "resumed.h5", "--threads", "1", "-q"], cwd=self.folder)
        while process.poll() is None and not list(shards.glob("*.shard")):
            time.sleep(0.005)
        process.send_signal(signal.SIGTERM)
        self.assertIn(process.wait(), (0, 130))
        self.run_program("run", "long.yaml", "-o", "resumed.h5", "-q")
        self.run_program("run", "long.yaml", "-o", "whole.h5", "-q")
        self.expect_equal("resumed.h5", "whole.h5")


if __name__ == "__main__":
    unittest.main()
