"""The memory of a command grows with its answer, and not with the statistics of every design point.

usage: memory.py ZEROCOUNT
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
# One trial at each point of a grid, with a goal.
STUDY = """zerocount: 1
name: points
seed: {seed}
trials: {trials}
plant: {{inertia: 8.0e-4, presliding_damping: 0.2}}
controller: {{units: si, sample_rate: 4000}}
command: {{targets: [5], hold: 0.06}}
goal: {{band: 1, within: 0.05, moves: 0.9}}
sweep: {{grid: {{controller.ki: {{logspace: [5.0e+3, 1.0e+5, {points}]}}, controller.kp: {{linspace: [0, 100, 10]}}}}}}
"""


class Memory(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="zerocount-memory-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_study(self, name, points, trials=1, seed=1):
        (self.folder / "study.yaml").write_text(STUDY.format(points=points // 10, trials=trials, seed=seed))
        subprocess.run([PROGRAM, "run", "study.yaml", "-o", name, "--quiet"], cwd=self.folder, check=True, capture_output=True)

    def peak_of(self, *words):
        """Largest resident memory of a command, bytes."""
        with subprocess.Popen([PROGRAM, *words], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        self.assertIn(process.returncode, (0, 1, 3), words)
        return usage.ru_maxrss * 1024

    def growth(self, command, *others, trials=1):
        """Growth of the memory per design point, bytes."""
        few, many = 1000, 9000
        peaks = []
        for points in (few, many):
            self.run_study(f"{points}.h5", points, trials)
            for i, other in enumerate(others):
                self.run_study(f"{points}-{i}.h5", points, trials, seed=other)
            peaks.append(self.peak_of(command, f"{points}.h5", *(f"{points}-{i}.h5" for i in range(len(others)))))
        return (peaks[1] - peaks[0]) / (many - few)

    def test_judge_keeps_of_each_point_what_a_comparison_needs(self):
        self.assertLess(self.growth("judge"), 5_000)  # all statistics of a point take 18 kB

    def test_sensitivity_keeps_its_answer(self):
        self.assertLess(self.growth("sensitivity"), 12_000)

    def test_compare_keeps_its_answer(self):
        self.assertLess(self.growth("compare", 2, trials=4), 20_000)


unittest.main()
