#!/usr/bin/python3
"""`zerocount slurm` and `zerocount status` with a Slurm cluster of this machine alone.

Exits with 77 (skipped) where Slurm or munge is not installed, or this is not root.

usage: slurm_cases.py PROGRAM
"""

import json
import os
import pathlib
import signal
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


class SlurmCase(unittest.TestCase):
    max_array_size = 1001

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="zerocount-slurm-")
        self.addCleanup(temporary.cleanup)
        root = pathlib.Path(temporary.name)
        (root / "slurm").mkdir()
        self.folder = root / "study"
        self.folder.mkdir()
        self.cluster = LocalCluster(root / "slurm", max_array_size=self.max_array_size)
        self.cluster.__enter__()
        self.addCleanup(self.cluster.__exit__)

    def manifest(self, trials, more=""):
        (self.folder / "study.yaml").write_text(MANIFEST.format(trials=trials) + more)

    def zerocount(self, *words, code=0):
        ended = subprocess.run([PROGRAM, *words], cwd=self.folder, env=self.cluster.env, capture_output=True, text=True,
                               check=False)
        self.assertEqual(ended.returncode, code, ended.stdout + ended.stderr)
        return ended

    def submit(self, *more, code=0):
        return self.zerocount("slurm", "study.yaml", "-o", "out.h5", *more, code=code)

    def status(self):
        return json.loads(self.zerocount("status", "out.h5", "--format", "json").stdout)

    def wait_for_shards(self):
        """Until some trials are finished and others are not."""
        self.cluster.wait_for("shards", lambda: any((self.folder / "out.h5.parts").glob("*.shards/*.h5")))

    def logs(self):
        return "".join(f"{log.name}: {log.read_text()}" for log in (self.folder / "out.h5.parts").glob("*.log"))

    def require_same_as_local_run(self):
        self.cluster.wait_for_jobs()
        self.assertTrue((self.folder / "out.h5").exists(), self.logs())
        self.zerocount("run", "study.yaml", "-q", "-o", "local.h5")
        self.assertEqual(datasets(self.folder / "out.h5"), datasets(self.folder / "local.h5"))


class Arrays(SlurmCase):
    def test_an_array_of_8_gives_the_data_of_a_local_run(self):
        self.manifest(400)
        said = self.submit("--tasks", "8", "--time", "5").stdout
        self.assertIn("array job of 8 elements", said)
        self.require_same_as_local_run()
        self.assertIn("complete", self.zerocount("status", "out.h5").stdout)

    def test_status_and_summary_of_a_running_array(self):
        self.manifest(60000)
        self.submit("--tasks", "8")
        self.wait_for_shards()
        status = self.status()
        self.assertTrue(status["running"])
        self.assertEqual(status["parts"]["all"], 8)
        self.assertGreater(status["parts"]["running"], 0)
        self.assertGreater(status["finished"], 0)
        self.assertLess(status["finished"], status["trials"])
        self.assertIn("unfinished", self.zerocount("summary", "out.h5").stdout)
        self.submit("--tasks", "8", code=2)  # while its jobs are in the queue
        self.submit("--tasks", "4", code=2)

    def test_what_a_killed_task_leaves_goes_on(self):
        self.manifest(60000)
        self.submit("--tasks", "8")
        self.wait_for_shards()
        killed = 0
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                words = (process / "cmdline").read_bytes().split(b"\0")
                if words[0] == PROGRAM.encode() and b"--shard" in words:
                    os.kill(int(process.name), signal.SIGKILL)
                    killed += 1
            except OSError:
                pass
        self.assertGreater(killed, 0)
        self.cluster.wait_for_jobs()
        self.assertFalse((self.folder / "out.h5").exists())
        self.assertIn("trials", (self.folder / "out.h5.parts/merge.log").read_text())
        before = self.status()
        self.assertGreater(before["finished"], 0)
        self.assertEqual(before["parts"]["running"], 0)
        said = self.submit("--tasks", "8").stdout
        self.assertIn(f"array job of {before['parts']['interrupted'] + before['parts']['waiting']} elements", said)
        self.require_same_as_local_run()

    def test_a_cancelled_array_goes_on(self):
        self.manifest(60000)
        self.submit("--tasks", "8")
        self.wait_for_shards()
        self.cluster.run("scancel", "--me")
        self.cluster.wait_for_jobs()
        self.assertFalse((self.folder / "out.h5").exists())
        self.submit("--tasks", "8")
        self.require_same_as_local_run()

    def test_a_requeued_element_does_only_what_is_missing(self):
        self.manifest(60000)
        self.submit("--tasks", "2")
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
        self.require_same_as_local_run()

    def test_the_controller_may_be_restarted(self):
        self.manifest(60000)
        self.submit("--tasks", "8")
        self.wait_for_shards()
        self.cluster.stop("slurmctld")
        time.sleep(1)
        self.cluster.start_controller()
        self.require_same_as_local_run()

    def test_a_merge_without_a_part_names_the_missing_trials(self):
        self.manifest(400)
        self.submit("--tasks", "8")
        self.cluster.wait_for_jobs()
        parts = sorted((self.folder / "out.h5.parts").glob("part-*.h5"))
        (self.folder / "out.h5").unlink()
        parts[2].unlink()
        merge = self.cluster.output("sbatch", "--parsable", str(self.folder / "out.h5.parts/merge.sbatch")).strip()
        self.cluster.wait_for_jobs()
        self.assertFalse((self.folder / "out.h5").exists())
        self.assertIn("of its 800 trials, 200 to 299 are missing", (self.folder / "out.h5.parts/merge.log").read_text())
        self.assertIn("ExitCode=4:0", self.cluster.output("scontrol", "show", "job", merge))
        self.assertIn("array job of 1 element ", self.submit("--tasks", "8").stdout)
        self.require_same_as_local_run()

    def test_a_study_that_stops_itself_is_one_job(self):
        self.manifest(4000, "stop: {success_rate_halfwidth: 0.2, max_trials: 8000}\n")
        self.submit("--tasks", "8", code=2)
        self.submit("--tasks", "1")
        self.require_same_as_local_run()
        self.assertIn(": complete", self.zerocount("status", "out.h5").stdout)


class SmallArrays(SlurmCase):
    max_array_size = 3

    def test_more_parts_than_the_largest_array_are_shared_among_its_elements(self):
        self.manifest(400)
        self.assertIn("array job of 3 elements", self.submit("--tasks", "8").stdout)
        self.require_same_as_local_run()


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    missing = missing_programs()
    if missing or os.geteuid() != 0:
        print(f"skipped: {'not root' if not missing else 'not installed: ' + ', '.join(missing)}")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)
