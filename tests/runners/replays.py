"""`trace` of a results file fails only where `verify` does: both run a trial again with the engine that ran it.

usage: replays.py ZEROCOUNT
"""

import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import h5py

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
SLIDER = """
zerocount: 1
name: hunting
axis: linear
seed: 3
trials: 6
plant: {{inertia: 1, presliding_damping: 0{damping}}}
friction: {law}
encoder: {{resolution: 1.0e-6}}
dac: {{bits: 16, resolution: 1.0e-3}}
controller: {{units: si, sample_rate: 1000, kp: 300, ki: 400, kd: 60}}
command: {{targets: [{{choice: [800, 1000, 1300]}}], hold: 20}}
"""
STUDIES = {
    "lugre": SLIDER.format(damping=", sliding_damping: 11.1", law="{model: lugre, sigma0: 1.0e+5, sigma1: 500, breakaway: 4.9, coulomb_ratio: 0.6, stribeck_velocity: 6.7e-3}"),
    "dahl": SLIDER.format(damping="", law="{model: dahl, sigma0: 1.0e+5, breakaway: {uniform: [4, 5]}, coulomb_ratio: 0.5}"),
    "gms": SLIDER.format(damping=", sliding_damping: 11.1", law="{model: gms, breakaway: 5, coulomb_ratio: 0.6, stribeck_velocity: 5.0e-3, "
                             "gms: {stiffness: [6.0e+4, 4.0e+4], weight: [0.5, 0.5], attraction: 10}}").replace("hold: 20", "hold: 2"),
    "creep": """
zerocount: 1
name: creep
seed: 8
trials: 6
friction: {lambda: 0.02, alpha: {log_uniform: [0.5, 5]}, k1: {uniform: [80, 140]}}
controller: {ki: 3.0e-5, kp: 3.0e-4}
command: {sequence: {targets: [5, 20], overrun: 6, cycles: 2}, hold: 0.4}
""",
    "contacts": """
zerocount: 1
name: contacts
seed: 21
trials: 6
friction: {breakaway: {lognormal: {median: 0.02, cv: 0.3}, per: contact}, k1: {uniform: [80, 140], per: contact}}
controller: {ki: 4.0e-4, kp: 2.0e-3}
command: {targets: [4000, -3000], hold: 0.5}
""",
    "samples": """
zerocount: 1
name: samples
seed: 5
trials: 6
samples: machines.csv
controller: {ki: 2.5e-4}
command: {targets: [{integers: [2, 40]}], hold: 0.5}
""",
    "tuned": """
zerocount: 1
name: tuned
seed: 6
trials: 40
friction: {k1: {lognormal: {median: 110, cv: 0.2}}}
command: {targets: [{integers: [3, 30]}], hold: 0.4}
goal: {band: 1, within: 0.3, moves: 0.8}
tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}}, margins: off}
""",
}


class Replays(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="zerocount-replays-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "machines.csv").write_text("friction.k1,friction.k2\n" + "".join(f"{90 + 7 * i},{700 - 11 * i}\n" for i in range(9)))
        self.run_program("new", "repeatability", "-o", "repeatability.yaml")
        for name, text in STUDIES.items():
            (self.folder / f"{name}.yaml").write_text(text)

    def run_program(self, *words):
        return subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True)

    def made(self, name, *more):
        command = ["tune", f"{name}.yaml", "--budget", "4000"] if name == "tuned" else ["run", f"{name}.yaml"]
        result = self.run_program(*command, "-o", f"{name}.h5", "-q", *more)
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        return f"{name}.h5"

    def test_trials_that_pass_verify_are_never_called_damaged(self):
        parted = 0
        for name in STUDIES:
            with self.subTest(name):
                file = self.made(name)
                self.assertEqual(self.run_program("verify", file, "--trials", "6").returncode, 0)
                for trial in range(6):
                    traced = self.run_program("trace", file, "--trial", str(trial), "-o", "t.csv", "--force")
                    self.assertEqual(traced.returncode, 0, traced.stderr)
                    parted += "differ from it" in traced.stderr
                self.assertEqual(self.run_program("report", file, "-o", "page.html", "--force").returncode, 0)
        self.assertGreater(parted, 0)  # or this shows nothing

    def test_a_long_sequence_that_creeps_is_not_called_damaged(self):
        file = self.made("repeatability", "--set", "trials=2", "--set", "command.sequence.cycles=1")
        for trial in range(2):
            traced = self.run_program("trace", file, "--trial", str(trial), "-o", "t.csv", "--force")
            self.assertEqual(traced.returncode, 0, traced.stderr)

    def test_the_time_of_divergence_of_the_engines_is_right(self):
        said = 0
        for name in ("lugre", "dahl"):
            batch = self.made(name)
            for trial in range(6):
                message = self.run_program("trace", batch, "--trial", str(trial), "-o", "t.csv", "--force").stderr
                parting = re.search(r"from t = (\S+) s on \(sample (\d+)\)", message)
                if not parting:
                    continue
                said += 1
                with open(self.folder / "t.csv", newline="") as file:
                    rows = list(csv.DictReader(file))
                self.assertAlmostEqual(float(rows[int(parting[2])]["t"]), float(parting[1]), places=5)
                # It hunts: the end of the trial is recorded otherwise, and the beginning is not concerned.
                self.assertGreater(int(parting[2]), 100)
                self.assertLess(int(parting[2]), len(rows))
        self.assertGreater(said, 0)

    def test_the_reference_engine_replays_its_own_trials_exactly(self):
        file = self.made("lugre", "--engine", "reference")
        for trial in range(3):
            traced = self.run_program("trace", file, "--trial", str(trial), "-o", "t.csv", "--force")
            self.assertEqual((traced.returncode, traced.stderr), (0, ""))

    def test_trace_and_verify_call_a_changed_value_damage(self):
        file = self.made("lugre")
        with h5py.File(self.folder / file, "a") as changed:
            changed["outcome/overshoot"][2] += 1
            place = changed["outcome/overshoot"].id.get_offset()
        self.assertIsNone(place)  # chunked
        self.assertEqual(self.run_program("trace", file, "--trial", "2", "-o", "t.csv").returncode, 4)
        self.assertEqual(self.run_program("verify", file).returncode, 4)


if __name__ == "__main__":
    unittest.main()
