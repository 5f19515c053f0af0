"""The contract of parts and of their merge, and the examples of examples/batch, each killed in the middle and started again.

usage: batch_examples.py ZEROCOUNT ROOT
"""

import contextlib
import fcntl
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(sys.argv.pop(2)).resolve()
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
EXAMPLES = ROOT / "examples" / "batch"
STUDY = """zerocount: 1
name: parts
seed: 11
trials: {trials}
friction: {{k1: {{uniform: [90, 130]}}}}
command: {{targets: [7], hold: 0.3}}
sweep: {{grid: {{controller.ki: [1.0e-5, 4.0e-5]}}}}
"""
SSHD = pathlib.Path("/usr/sbin/sshd")
SEAL = 87
CREATED = re.compile(rb"20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ")


def undated(path):
    """The bytes of a results file without the date, and without the checksum, which depends on it."""
    whole, dates = CREATED.subn(b"", path.read_bytes()[:-SEAL])
    assert dates == 1, dates
    return whole


class Batch(unittest.TestCase):
    trials = 40000  # a part of half of them takes long enough to leave shards

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="zerocount-batch-")
        cls.addClassCleanup(folder.cleanup)
        cls.kept = pathlib.Path(folder.name)
        (cls.kept / "zerocount").symlink_to(PROGRAM)
        (cls.kept / "study.yaml").write_text(STUDY.format(trials=cls.trials))
        subprocess.run([PROGRAM, "run", "study.yaml", "-q", "-o", "alone.h5"], cwd=cls.kept, check=True, stderr=subprocess.DEVNULL)
        cls.alone = undated(cls.kept / "alone.h5")

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="zerocount-batch-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        shutil.copy(self.kept / "study.yaml", self.folder)
        self.env = {**os.environ, "PATH": f"{self.kept}:{os.environ['PATH']}", "HOME": str(self.folder)}

    def ended(self, *words, code=0, folder=None):
        ended = subprocess.run(words, cwd=folder or self.folder, env=self.env, capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, code, ended.stdout + ended.stderr)
        return ended.stdout + ended.stderr

    def killed(self, when, *words, kind=signal.SIGKILL):
        """Starts a command, and kills it with all its processes once something holds."""
        process = subprocess.Popen(words, cwd=self.folder, env=self.env, start_new_session=True,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while not when():
            self.assertIsNone(process.poll(), "it has ended already")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.005)
        os.killpg(process.pid, kind)
        return process.wait()

    def names(self, folder=None):
        return sorted(path.name for path in (folder or self.folder).iterdir())

    def part(self, number, parts, output, *more):
        return ("zerocount", "run", "study.yaml", "--quiet", "--threads", "1", "--shard", f"{number}/{parts}", "-o", output, *more)

    def require_alone(self, output="study.h5"):
        self.assertEqual(undated(self.folder / output), self.alone)


class Contract(Batch):
    def has_shard(self, output):
        return lambda: any((self.folder / f"{output}.shards").glob("*.shard"))

    def test_a_killed_part_continues_here_or_elsewhere(self):
        """After SIGKILL the part is absent, its shards are whole, and the same command runs only what is missing, also where the folder
        of shards has been moved to."""
        self.assertEqual(self.killed(self.has_shard("1.h5"), *self.part(1, 2, "1.h5")), -signal.SIGKILL)
        self.assertEqual(set(self.names()) - {"1.h5.lock", "1.h5.part"}, {"1.h5.shards", "study.yaml"})
        self.assertEqual(self.killed(self.has_shard("2.h5"), *self.part(2, 2, "2.h5"), kind=signal.SIGTERM), 130)
        self.assertNotIn("2.h5.lock", self.names())
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        shutil.copy(self.folder / "study.yaml", elsewhere)
        (self.folder / "2.h5.shards").rename(elsewhere / "2.h5.shards")
        finished = [word for word in self.part(1, 2, "1.h5") if word != "--quiet"]
        self.assertRegex(self.ended(*finished), r"[1-9]\d* of them from before")
        finished = [word for word in self.part(2, 2, "2.h5") if word != "--quiet"]
        self.assertRegex(self.ended(*finished, folder=elsewhere), r"[1-9]\d* of them from before")
        self.assertEqual(self.names(), ["1.h5", "elsewhere", "study.yaml"])
        self.ended("zerocount", "merge", "elsewhere/2.h5", "1.h5", "-o", "study.h5")
        self.require_alone()

    def test_a_second_run_of_the_same_part_is_refused(self):
        """The second of two runs of a part ends with 5, and does not disturb the first."""
        first = subprocess.Popen(self.part(1, 2, "1.h5"), cwd=self.folder, env=self.env, stderr=subprocess.DEVNULL)
        while not (self.folder / "1.h5.lock").exists():
            time.sleep(0.005)
        self.assertIn("another run is writing", self.ended(*self.part(1, 2, "1.h5"), code=5))
        self.assertEqual(first.wait(), 0)

    def test_a_killed_merge_begins_again(self):
        """After SIGKILL there is no output, and the same command makes it."""
        for number in (1, 2):
            self.ended(*self.part(number, 2, f"{number}.h5"))
        merge = ("zerocount", "merge", "1.h5", "2.h5", "-o", "study.h5", "--force")
        self.killed(lambda: any(self.folder.glob("study.h5*.part")), *merge)
        self.assertFalse((self.folder / "study.h5").exists())
        self.ended(*merge)
        self.require_alone()
        self.assertEqual(self.names(), ["1.h5", "2.h5", "study.h5", "study.yaml"])

    def test_a_merge_accepts_parts_of_different_divisions(self):
        """Halves and quarters together have the bytes of one machine."""
        for number, parts in ((1, 2), (3, 4), (4, 4)):
            self.ended(*self.part(number, parts, f"{number}-of-{parts}.h5"))
        self.ended("zerocount", "merge", *[name for name in self.names() if "-of-" in name], "-o", "study.h5")
        self.require_alone()

    def test_errors_that_no_retry_repairs_exit_with_two(self):
        """A wrong division, a study with `stop` and another manifest than meant: exit code 2."""
        self.ended(*self.part(9, 8, "9.h5"), code=2)
        self.ended(*self.part(1, 8, "1.h5", "--study", "0" * 64), code=2)
        self.ended(*self.part(1, 8, "1.h5", "--set", "stop={success_rate_halfwidth: 0.1, max_trials: 50000}"), code=2)
        self.assertEqual(self.names(), ["study.yaml"])


class Parts(Batch):
    trials = 4000

    def test_a_finished_part_is_left_as_it_is(self):
        """Once more the same command: exit code 0, and the file is not touched; another part or study does not replace it."""
        self.ended(*self.part(1, 8, "1.h5"))
        before = (self.folder / "1.h5").stat()
        self.ended(*self.part(1, 8, "1.h5"))
        self.ended(*self.part(2, 8, "1.h5"), code=2)
        self.ended(*self.part(1, 8, "1.h5", "--set", "seed=12"), code=2)
        after = (self.folder / "1.h5").stat()
        self.assertEqual((before.st_mtime_ns, before.st_ino), (after.st_mtime_ns, after.st_ino))

    def test_an_incomplete_merge_is_refused(self):
        """A missing part, one twice, and one of another study: exit code 4 and no file; with all parts the bytes of one machine."""
        for number in (1, 2, 4):
            self.ended(*self.part(number, 4, f"{number}.h5"))
        said = self.ended("zerocount", "merge", "1.h5", "2.h5", "4.h5", "-o", "study.h5", code=4)
        self.assertIn("4000 to 5999 are missing", said)
        self.ended(*self.part(3, 4, "3.h5", "--set", "seed=12"))
        self.ended("zerocount", "merge", "1.h5", "2.h5", "3.h5", "4.h5", "-o", "study.h5", code=4)
        self.ended(*self.part(3, 4, "3.h5", "--force"))
        self.ended("zerocount", "merge", "1.h5", "2.h5", "3.h5", "4.h5", "4.h5", "-o", "study.h5", code=4)
        self.assertFalse((self.folder / "study.h5").exists())
        merge = ("zerocount", "merge", "4.h5", "3.h5", "2.h5", "1.h5", "-o", "study.h5")
        self.ended(*merge)
        self.require_alone()
        self.ended(*merge, code=2)  # there already
        self.ended(*merge, "--force")
        self.require_alone()

    def test_a_damaged_part_is_refused_and_made_again_with_force(self):
        """It is refused by merge (4) and by its own command (2), which makes it again with --force."""
        for number in (1, 2):
            self.ended(*self.part(number, 2, f"{number}.h5"))
        whole = (self.folder / "2.h5").read_bytes()
        (self.folder / "2.h5").write_bytes(whole[:len(whole) // 2])
        self.assertIn("2.h5", self.ended("zerocount", "merge", "1.h5", "2.h5", "-o", "study.h5", code=4))
        self.ended(*self.part(2, 2, "2.h5"), code=2)
        self.ended(*self.part(2, 2, "2.h5", "--force"))
        self.ended("zerocount", "merge", "1.h5", "2.h5", "-o", "study.h5")
        self.require_alone()


class Examples(Batch):
    trials = 16000
    parts = "parts"  # their folder

    def some_parts(self):
        return 0 < len(list((self.folder / self.parts).glob("*-of-8.h5"))) < 8

    def require_goes_on(self, *words, before=(), unseen=0):
        """The same bytes as by one machine, after a kill in the middle, and without running again what was finished.

        unseen: parts that may run again, because the system was killed before it saw that they had ended
        """
        self.killed(self.some_parts, *words)
        kept = {path.name: path.stat().st_ino for path in (self.folder / self.parts).glob("*-of-8.h5")}
        self.assertFalse((self.folder / "study.h5").exists())
        self.wait_for_locks()
        if before:
            self.ended(*before)
        self.ended(*words)
        self.require_alone()
        again = [name for name in kept if (self.folder / self.parts / name).stat().st_ino != kept[name]]
        self.assertLessEqual(len(again), unseen)

    def wait_for_locks(self):
        """Until the runs have ended that a kill has not reached, such as those of another machine."""
        deadline = time.monotonic() + 60
        for lock in self.folder.rglob("*.lock"):
            with contextlib.suppress(FileNotFoundError), lock.open() as file:
                while True:
                    with contextlib.suppress(BlockingIOError):
                        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                        break
                    self.assertLess(time.monotonic(), deadline)
                    time.sleep(0.05)

    def test_make(self):
        self.require_goes_on("make", "-f", EXAMPLES / "Makefile", "-j", "2", "STUDY=study.yaml", "PARTS=8")
        self.assertIn("up to date", self.ended("make", "-f", EXAMPLES / "Makefile", "STUDY=study.yaml", "PARTS=8"))

    def test_slurm(self):
        """What Slurm does with slurm.sh (really: tests/slurm), of an array with fewer elements than parts; `status` counts the parts."""
        self.parts = "study.h5.parts"
        (self.folder / "slurm").write_text(
            f"for id in 1 2 3; do SLURM_ARRAY_TASK_ID=$id SLURM_ARRAY_TASK_MAX=3 {EXAMPLES}/slurm.sh study.yaml 8 || exit; done\n"
            f"exec {EXAMPLES}/slurm.sh study.yaml 8\n")
        self.require_goes_on("sh", "slurm", before=("sh", "-c", "zerocount status study.h5 --format json > status"))
        counts = json.loads((self.folder / "status").read_text())["parts"]
        self.assertEqual((counts["all"], counts["running"]), (8, 0))
        self.assertTrue(0 < counts["complete"] < 8, counts)
        edited = (self.folder / "study.yaml").read_text().replace("130", "150")
        (self.folder / "study.yaml").write_text(edited)
        self.ended("sh", "slurm", code=2)
        self.require_alone()

    @unittest.skipUnless(shutil.which("parallel"), "no GNU parallel here")
    def test_parallel(self):
        self.require_goes_on(EXAMPLES / "parallel.sh", "study.yaml", "8")

    @unittest.skipUnless(shutil.which("parallel") and shutil.which("rsync") and SSHD.exists(), "no GNU parallel, rsync or sshd here")
    def test_parallel_over_ssh(self):
        """The machine at the other end has a folder of its own: only the manifest goes there, and the parts come back."""
        home = self.folder / "home"
        home.mkdir()
        self.env["PARALLEL_SSH"] = f"ssh -F {self.local_ssh(home)}"
        self.require_goes_on(EXAMPLES / "parallel.sh", "study.yaml", "8", "2/there")
        self.assertEqual(self.names(home), ["zerocount"])
        self.assertEqual(set(self.names(home / "zerocount")), {"parts", "study.yaml"})

    def local_ssh(self, home):
        """Starts a server of this user on this machine, whose sessions begin in `home`; the configuration for its clients."""
        place = self.folder / "ssh"
        place.mkdir(mode=0o700)
        for key in ("server", "client"):
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", place / key], check=True)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        (place / "begin").write_text(
            f'#!/bin/sh\ncd {home}\nexport PATH="{self.env["PATH"]}" HOME={home}\nexec sh -c "$SSH_ORIGINAL_COMMAND"\n')
        (place / "begin").chmod(0o700)
        (place / "sshd_config").write_text(
            f"ListenAddress 127.0.0.1:{port}\nHostKey {place}/server\nAuthorizedKeysFile {place}/client.pub\nPidFile none\n"
            f"StrictModes no\nUsePAM no\nPermitRootLogin yes\nMaxStartups 100\nForceCommand {place}/begin\n")
        (place / "config").write_text(
            f"Host there\n HostName 127.0.0.1\n Port {port}\n IdentityFile {place}/client\n IdentitiesOnly yes\n LogLevel ERROR\n"
            f" StrictHostKeyChecking no\n UserKnownHostsFile {place}/known\n")
        if os.getuid() == 0:
            pathlib.Path("/run/sshd").mkdir(exist_ok=True)  # the server asks for it
        server = subprocess.Popen([SSHD, "-D", "-f", place / "sshd_config"], stderr=subprocess.DEVNULL)
        self.addCleanup(server.wait)
        self.addCleanup(server.terminate)
        while subprocess.run(["ssh", "-F", place / "config", "there", "true"], capture_output=True, check=False).returncode != 0:
            self.assertIsNone(server.poll(), "sshd has ended")
            time.sleep(0.05)
        return place / "config"

    @unittest.skipUnless(shutil.which("snakemake"), "no Snakemake here")
    def test_snakemake(self):
        words = ("snakemake", "-s", EXAMPLES / "Snakefile", "--cores", "2", "--rerun-incomplete", "--config", "study=study.yaml", "parts=8")
        self.require_goes_on(*words, before=(*words, "--unlock"), unseen=2)


class Studies(Batch):
    """Parts of an earlier manifest, and of others in the same folder, are not merged."""
    trials = 16

    def hash_of(self, name):
        return self.ended("zerocount", "check", name, "--hash").strip()

    def require_own_results(self, run, other="other.yaml"):
        """@param run runs a study by its name"""
        text = (self.folder / "study.yaml").read_text()
        (self.folder / other).write_text(text.replace("name: parts", "name: other"))
        edited = text.replace("130", "150")
        for name, written in (("study.yaml", text), ("study.yaml", edited), (other, None), ("study.yaml", text), ("study.yaml", f"# again\n{text}")):
            if written:
                (self.folder / name).write_text(written)
            run(name)
            self.assertEqual(self.hash_of(name.replace(".yaml", ".h5")), self.hash_of(name))
        self.assertEqual(len(list((self.folder / "parts").glob("*-of-2.h5"))), 3 * 2, "parts of three studies")
        self.assertNotEqual(self.hash_of("study.h5"), self.hash_of(other.replace(".yaml", ".h5")))

    def test_make(self):
        self.require_own_results(lambda name: self.ended("make", "-f", EXAMPLES / "Makefile", f"STUDY={name}", "PARTS=2"))
        self.ended("make", "-f", EXAMPLES / "Makefile", "STUDY=missing.yaml", code=2)

    @unittest.skipUnless(shutil.which("parallel"), "no GNU parallel here")
    def test_parallel(self):
        self.require_own_results(lambda name: self.ended(EXAMPLES / "parallel.sh", name, "2"))
        self.ended(EXAMPLES / "parallel.sh", "missing.yaml", "2", code=2)

    @unittest.skipUnless(shutil.which("parallel"), "no GNU parallel here")
    def test_parallel_of_any_name(self):
        self.require_own_results(lambda name: self.ended(EXAMPLES / "parallel.sh", name, "2"), other="a b's \"$HOME\" & `c`.yaml")

    @unittest.skipUnless(shutil.which("snakemake"), "no Snakemake here")
    def test_snakemake(self):
        self.require_own_results(lambda name: self.ended("snakemake", "-s", EXAMPLES / "Snakefile", "--cores", "1", "--config", f"study={name}", "parts=2"))


if __name__ == "__main__":
    unittest.main()
