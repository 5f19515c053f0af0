"""Runs that something ends go on, and files that something changed are treated as their owner means it.

usage: interruptions.py ZEROCOUNT
"""

import os
import pathlib
import resource
import signal
import sqlite3
import stat
import subprocess
import sys
import tempfile
import time
import unittest

import h5py

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
LONG = """zerocount: 1
name: long
seed: 11
trials: 100000
friction: {k1: {uniform: [90, 130]}}
command: {targets: [7], hold: 0.3}
sweep: {grid: {controller.kp: [0, 3.0e-4], controller.ki: [1.0e-5, 4.0e-5]}}
"""

# Its statistics take many seconds, so that a program that computes them to the end exceeds SOON.
MANY_POINTS = """zerocount: 1
name: points
seed: 1
trials: 1
plant: {inertia: 8.0e-4, presliding_damping: 0.2}
controller: {units: si, sample_rate: 4000}
command: {targets: [5], hold: 0.06}
sweep: {grid: {controller.ki: {logspace: [5.0e+3, 1.0e+5, 1000]}, controller.kp: {linspace: [0, 100, 100]}}}
"""

SOON = 3.0  # s, on a busy machine


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="zerocount-interruptions-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "long.yaml").write_text(LONG)
        (self.folder / "short.yaml").write_text(LONG.replace("100000", "8"))

    def run_program(self, *words, **more):
        return subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True, **more)

    def complete(self, *words):
        result = self.run_program(*words)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def interrupted(self, output, kind, manifest="long.yaml"):
        """The exit code of a run that gets a signal once it has written a shard."""
        shards = self.folder / f"{output}.shards"
        before = set(shards.glob("*.shard"))
        process = subprocess.Popen([PROGRAM, "run", manifest, "-o", output, "--threads", "1", "-q"], cwd=self.folder, stderr=subprocess.DEVNULL)
        while set(shards.glob("*.shard")) <= before:
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        process.send_signal(kind)
        return process.wait()


class Interruptions(Runs):
    def test_every_signal_that_ends_a_run_keeps_what_is_finished(self):
        for kind in (signal.SIGTERM, signal.SIGHUP, signal.SIGXCPU, signal.SIGUSR1):
            with self.subTest(kind.name):
                self.assertEqual(self.interrupted("out.h5", kind), 130)
                self.assertFalse(list((self.folder / "out.h5.shards").glob("*.part")))

    def test_a_limit_of_processor_time_interrupts(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (1, 60))
        result = self.run_program("run", "long.yaml", "-o", "out.h5", "--threads", "1", preexec_fn=limit)
        self.assertEqual(result.returncode, 130, result.stderr)
        self.assertIn("are kept", result.stderr)

    def test_a_manifest_with_the_same_values_continues(self):
        self.assertEqual(self.interrupted("out.h5", signal.SIGTERM), 130)
        for number, text in enumerate([f"# since yesterday\n{LONG}", LONG.replace("\n", "\r\n"),
                                       LONG.replace("0.3}", "0.30}").replace("4.0e-5", "0.00004"),
                                       "".join(sorted(LONG.splitlines(keepends=True), reverse=True))]):
            (self.folder / "same.yaml").write_text(text, newline="")
            before = sorted((self.folder / "out.h5.shards").glob("*.shard"))
            with self.subTest(number):
                self.assertEqual(self.interrupted("out.h5", signal.SIGTERM, "same.yaml"), 130)
                self.assertLessEqual(set(before), set((self.folder / "out.h5.shards").glob("*.shard")))

    def test_a_manifest_with_other_values_is_refused_by_their_names(self):
        self.assertEqual(self.interrupted("out.h5", signal.SIGTERM), 130)
        turned = "{controller.ki: [1.0e-5, 4.0e-5], controller.kp: [0, 3.0e-4]}"
        for old, new, said in [("hold: 0.3", "hold: 0.31", "command.hold is 0.3 there and 0.31 here"),
                               ("seed: 11", "seed: 9007199254740993", "seed is 11 there and 9007199254740993 here"),
                               ("{controller.kp: [0, 3.0e-4], controller.ki: [1.0e-5, 4.0e-5]}", turned,
                                "sweep.grid, order of keys is controller.kp, controller.ki there and controller.ki, controller.kp here")]:
            (self.folder / "other.yaml").write_text(LONG.replace(old, new))
            with self.subTest(new):
                result = self.run_program("run", "other.yaml", "-o", "out.h5")
                self.assertEqual(result.returncode, 2)
                self.assertIn(said, result.stderr)

    def test_a_finished_file_with_points_in_another_order_is_another_study(self):
        self.complete("run", "short.yaml", "-o", "out.h5")
        text = (self.folder / "short.yaml").read_text()
        (self.folder / "turned.yaml").write_text(text.replace(
            "{controller.kp: [0, 3.0e-4], controller.ki: [1.0e-5, 4.0e-5]}", "{controller.ki: [1.0e-5, 4.0e-5], controller.kp: [0, 3.0e-4]}"))
        self.assertEqual(self.run_program("run", "turned.yaml", "-o", "out.h5").returncode, 2)
        self.assertIn("nothing to run", self.complete("run", "short.yaml", "-o", "out.h5").stderr)

    @unittest.skipUnless(os.geteuid() == 0, "needs another user, so that the limit counts its processes alone")
    def test_a_refused_thread_gives_one_sentence(self):
        self.folder.chmod(0o777)
        for processes in (1, 2):
            def limit(processes=processes):
                resource.setrlimit(resource.RLIMIT_NPROC, (processes, processes))
                os.setuid(54321)
            result = self.run_program("run", "short.yaml", "-o", f"{processes}.h5", "--threads", "64", "-q", preexec_fn=limit)
            self.assertEqual(result.returncode, 5)
            said = [line for line in result.stderr.splitlines() if not line.startswith("warning: ")]
            self.assertEqual(len(said), 1, result.stderr)
            self.assertIn("ulimit -u", said[0])


class Signals(Runs):
    def begun(self, *words, seconds):
        """A command that has been running for so long."""
        process = subprocess.Popen([PROGRAM, *words], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(seconds)
        self.assertIsNone(process.poll(), "the command ended before the signal")
        return process

    def test_two_signals_within_a_second_are_one_request(self):
        process = subprocess.Popen([PROGRAM, "run", "long.yaml", "-o", "two.h5", "--threads", "1"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        while not list((self.folder / "two.h5.shards").glob("*.shard")):
            time.sleep(0.01)
        for _ in range(3):
            process.send_signal(signal.SIGTERM)
            time.sleep(0.02)
        _, said = process.communicate()
        self.assertEqual(process.returncode, 130)
        self.assertIn("are kept", said)

    def test_a_command_with_nothing_to_keep_ends_within_a_second(self):
        (self.folder / "days.csv").write_text("arrival_time\n" + "".join(f"{0.01 + (i * 7919 % 997) * 1e-6:.6f}\n" for i in range(2_000_000)))
        (self.folder / "baseline.csv").write_text("arrival_time\n" + "".join(f"{0.01 + (i * 7919 % 997) * 1e-6:.6f}\n" for i in range(1000)))
        for kind in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(kind.name):
                process = self.begun("monitor", "baseline.csv", "days.csv", "--measure", "arrival_time", seconds=0.3)
                start = time.monotonic()
                process.send_signal(kind)
                process.wait()
                self.assertEqual(process.returncode, 130)
                self.assertLess(time.monotonic() - start, SOON)

    def test_a_run_that_is_interrupted_while_it_computes_statistics_ends_soon_and_keeps_its_trials(self):
        (self.folder / "points.yaml").write_text(MANY_POINTS)
        process = subprocess.Popen([PROGRAM, "run", "points.yaml", "-o", "points.h5"], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        while not (self.folder / "points.h5.part").exists():
            time.sleep(0.01)
        time.sleep(0.7)  # the shards are joined
        start = time.monotonic()
        process.send_signal(signal.SIGTERM)
        process.communicate()
        self.assertEqual(process.returncode, 130)
        self.assertLess(time.monotonic() - start, SOON)
        self.assertIn("100000 of them from before", self.complete("run", "points.yaml", "-o", "points.h5").stderr)

    def test_verify_ends_within_a_second_and_removes_its_temporary_files(self):
        (self.folder / "points.yaml").write_text(MANY_POINTS)
        self.complete("run", "points.yaml", "-o", "points.h5")
        temporary = self.folder / "temporary"
        temporary.mkdir()
        process = subprocess.Popen(
            [PROGRAM, "verify", "points.h5"], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, "TMPDIR": str(temporary)},
        )
        while not list(temporary.glob("*/*")):
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        time.sleep(0.7)  # the trials are copied
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        process.wait()
        self.assertEqual(process.returncode, 130)
        self.assertLess(time.monotonic() - start, SOON)
        self.assertEqual(list(temporary.iterdir()), [])


class Files(Runs):
    def outputs(self):
        """Every kind of file that a command replaces, and the command that makes it."""
        self.complete("run", "short.yaml", "-o", "in.h5")
        return {"out.h5": ["run", "short.yaml", "-o", "out.h5"], "out.csv": ["trace", "in.h5", "-o", "out.csv"],
                "page.html": ["report", "in.h5", "-o", "page.html"], "copy.yaml": ["new", "paper-gains", "-o", "copy.yaml"],
                "merged.h5": ["merge", "in.h5", "-o", "merged.h5"]}

    def test_a_replaced_file_keeps_its_permissions(self):
        for name, words in self.outputs().items():
            for mode in (0o600, 0o664, 0o755):
                with self.subTest(name=name, mode=oct(mode)):
                    path = self.folder / name
                    path.write_text("earlier")
                    path.chmod(mode)
                    self.complete(*words, "--force")
                    self.assertEqual(stat.S_IMODE(path.stat().st_mode), mode)
                    self.assertNotEqual(path.read_bytes(), b"earlier")

    def test_a_write_protected_file_is_not_replaced(self):
        for name, words in self.outputs().items():
            with self.subTest(name=name):
                path = self.folder / name
                path.write_text("earlier")
                path.chmod(0o444)
                result = self.run_program(*words, "--force")
                self.assertEqual(result.returncode, 5, result.stderr)
                self.assertIn(f"{name}: cannot be replaced: it is write-protected", result.stderr)
                self.assertEqual(path.read_text(), "earlier")
                self.assertFalse(list(self.folder.glob(f"{name}.*")))

    def test_a_finished_write_protected_file_is_still_complete(self):
        self.complete("run", "short.yaml", "-o", "out.h5")
        (self.folder / "out.h5").chmod(0o444)
        self.assertIn("nothing to run", self.complete("run", "short.yaml", "-o", "out.h5").stderr)

    def test_a_file_that_h5py_opened_to_write_is_refused(self):
        self.complete("run", "short.yaml", "-o", "out.h5")
        with h5py.File(self.folder / "out.h5", "a") as file:
            file.attrs["note"] = "seen"
        for command in ("summary", "verify"):
            refused = self.run_program(command, "out.h5")
            self.assertEqual(refused.returncode, 4)
            self.assertIn("run its manifest again", refused.stdout + refused.stderr)

    def test_a_file_in_a_newer_format_of_hdf5_is_said_to_be_that(self):
        """As h5repack --latest writes it: every value is there, and nothing is damaged."""
        self.complete("run", "short.yaml", "-o", "out.h5")
        with h5py.File(self.folder / "out.h5") as old, h5py.File(self.folder / "new.h5", "w", libver="latest", track_order=True) as new:
            new.attrs.update(old.attrs)
            for name in old:
                old.copy(name, new)
        for words in (["summary"], ["verify"], ["trace"], ["merge", "-o", "merged.h5"]):
            refused = self.run_program(words[0], "new.h5", *words[1:])
            with self.subTest(words[0]):
                self.assertEqual(refused.returncode, 4)
                said = refused.stdout + refused.stderr
                self.assertIn("another program has rewritten it in the format of HDF5 1.10", said)
                self.assertNotIn("damaged", said)

    def test_a_history_that_another_process_holds_is_waited_for_and_said(self):
        self.complete("run", "short.yaml", "-o", "out.h5")
        self.complete("history", "add", "out.h5", "--database", "h.sqlite")
        other = sqlite3.connect(self.folder / "h.sqlite", isolation_level=None)
        other.execute("BEGIN EXCLUSIVE")
        waiting = subprocess.Popen([PROGRAM, "history", "show", "--database", "h.sqlite"], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertIn("h.sqlite: another process is writing it; waiting for at most 60 s", waiting.stderr.readline())
        other.execute("COMMIT")
        shown, _ = waiting.communicate()
        self.assertEqual(waiting.returncode, 0)
        self.assertIn("long", shown)


if __name__ == "__main__":
    unittest.main()
