#!/usr/bin/python3
"""examples/batch/slurm.sh and `zerocount status` with a Slurm cluster of this machine alone.

Exits with 77 (skipped) where Slurm or munge is not installed, or this is not root.

usage: slurm_cases.py PROGRAM
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from local_cluster import LocalCluster, missing_programs  # noqa: E402

PROGRAM = ""
SKIPPED = 77
SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "examples/batch/slurm.sh"

MANIFEST = """zerocount: 1
name: array
seed: 11
trials: {trials}
friction: {{k1: {{uniform: [100, 160]}}}}
command: {{targets: [20, 0], hold: 0.3}}
sweep: {{cases: {{low: {{controller.ki: 1.9e-5}}, high: {{controller.ki: 6.0e-5}}}}}}
"""


def datasets(path):
    """{name: bytes} of all datasets."""
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update({name: numpy.asarray(item[()]).tobytes()})
                        if isinstance(item, h5py.Dataset) and item.dtype.kind != "O" else None)
    return found


class Arrays(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="zerocount-slurm-")
        self.addCleanup(temporary.cleanup)
        root = pathlib.Path(temporary.name)
        (root / "slurm").mkdir()
        self.folder = root / "study"
        self.folder.mkdir()
        (root / "zerocount").symlink_to(PROGRAM)
        self.cluster = LocalCluster(root / "slurm")
        self.cluster.env["PATH"] = f"{root}:{os.environ['PATH']}"
        self.cluster.__enter__()
        self.addCleanup(self.cluster.__exit__)

    def ended(self, *words):
        ended = subprocess.run(words, cwd=self.folder, env=self.cluster.env, capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        return ended.stdout

    def submit(self, trials, elements=8):
        (self.folder / "study.yaml").write_text(MANIFEST.format(trials=trials))
        array = self.ended("sbatch", "--parsable", f"--array=1-{elements}", SCRIPT, "study.yaml", "8").strip()
        self.ended("sbatch", f"--dependency=afterok:{array}", "--kill-on-invalid-dep=yes", SCRIPT, "study.yaml", "8")

    def status(self):
        return json.loads(self.ended("zerocount", "status", "study.h5", "--format", "json"))

    def wait_for_shards(self):
        """Until some trials are finished and others are not."""
        self.cluster.wait_for("shards", lambda: any((self.folder / "study.h5.parts").glob("*.shards/*.shard")))

    def require_same_as_local_run(self):
        self.cluster.wait_for_jobs()
        logs = "".join(f"{log.name}: {log.read_text()}" for log in self.folder.glob("slurm-*.out"))
        self.assertTrue((self.folder / "study.h5").exists(), logs)
        self.ended("zerocount", "run", "study.yaml", "-q", "-o", "local.h5")
        self.assertEqual(datasets(self.folder / "study.h5"), datasets(self.folder / "local.h5"))

    def test_more_parts_than_elements_give_the_data_of_a_local_run(self):
        self.submit(400, elements=3)
        self.require_same_as_local_run()
        self.assertTrue(self.status()["complete"])

    def test_status_follows_an_array_that_is_cancelled_and_continued(self):
        self.submit(60000)
        self.wait_for_shards()
        status = self.status()
        self.assertTrue(status["running"])
        self.assertEqual(status["parts"]["all"], 8)
        self.assertGreater(status["parts"]["running"], 0)
        self.assertTrue(0 < status["finished"] < status["trials"])
        self.cluster.run("scancel", "--me")
        self.cluster.wait_for_jobs()
        self.assertFalse((self.folder / "study.h5").exists())
        self.assertGreater(self.status()["finished"], 0)
        self.submit(60000)
        self.require_same_as_local_run()

    def test_a_requeued_element_and_a_restarted_controller_lose_nothing(self):
        self.submit(60000, elements=2)
        self.wait_for_shards()
        before = self.status()["finished"]
        running = self.cluster.output("squeue", "--noheader", "--states=running", "--format=%A").split()
        self.assertTrue(running)
        for job in running:
            self.cluster.run("scontrol", "requeue", job)
        self.cluster.wait_for("the requeued jobs", lambda: "PENDING" in self.cluster.output("squeue", "--format=%T"))
        for job in running:  # which would begin after two minutes
            self.cluster.run("scontrol", "update", f"JobId={job}", "StartTime=now")
        self.cluster.wait_for("trials after the requeue", lambda: self.status()["finished"] > before)
        self.cluster.stop("slurmctld")
        time.sleep(1)
        self.cluster.start_controller()
        self.require_same_as_local_run()

    def test_nothing_is_merged_if_a_part_fails(self):
        (self.folder / "study.h5.parts").mkdir()
        (self.folder / "study.h5.parts/part-3-of-8.h5").write_text("no part")
        self.submit(400)
        self.cluster.wait_for_jobs()
        self.assertFalse((self.folder / "study.h5").exists())
        (self.folder / "study.h5.parts/part-3-of-8.h5").unlink()
        self.submit(400)
        self.require_same_as_local_run()


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    missing = missing_programs()
    if missing or os.geteuid() != 0:
        print(f"skipped: {'not root' if not missing else 'not installed: ' + ', '.join(missing)}")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)
