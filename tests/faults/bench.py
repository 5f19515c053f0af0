"""Runs the program under a fault, and judges what it leaves behind."""

import dataclasses
import hashlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time

import h5py

RUN = ["run", "study.yaml", "-o", "out.h5"]
TRAILER = 87  # bytes of the checksum trailer, see results/integrity.md
LONGEST = 120  # s: a command that takes longer hangs

MANIFEST = """zerocount: 1
name: faults
seed: 42
trials: {trials}
friction:
  k1: {{profile: {{mean: 110, cv: 0.1, correlation_length: 0.2, marginal: lognormal}}}}
  k2: {{uniform: [600, 900]}}
  lambda: 0.5
command: {{targets: [{{integers: [1, 10]}}], hold: 0.15}}
initial: {{encoder_phase: {{uniform: [0, 1]}}, position: {{uniform: [0, 6.283185307179586]}}}}
verdict: {{dwell: 0.02, window: 0.02}}
sweep: {{cases: {{low: {{controller.ki: 3.85e-5}}, high: {{controller.ki: 2.08e-4}}}}}}
retain: {{trials: [0]}}
"""


class Lost(Exception):
    """A promise that was not kept."""


@dataclasses.dataclass
class Ending:
    code: int  # exit code; negative: the signal that ended it
    out: str
    err: str


def datasets(path):
    """Every dataset of a results file: shape, type and bytes."""
    found = {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset):
            values = item[()]
            content = repr(values.tolist() if hasattr(values, "tolist") else values) if item.dtype.kind == "O" else values.tobytes()
            found[name] = (item.shape, item.dtype.str, content)

    with h5py.File(path, "r", locking=False) as file:
        file.visititems(visit)
    return found


def has_valid_checksum(path):
    """The bytes of the file are those of its checksum trailer."""
    data = path.read_bytes()
    return data[-TRAILER:] == b"zerocount-seal sha256 %s\n" % hashlib.sha256(data[:-TRAILER]).hexdigest().encode()


def append_checksum(path):
    """Writes the checksum trailer of a changed file anew."""
    data = path.read_bytes()[:-TRAILER]
    path.write_bytes(data + b"zerocount-seal sha256 %s\n" % hashlib.sha256(data).hexdigest().encode())


def trials_of(path):
    """The number of trials of a valid shard, from its name; 0 of another file."""
    named = re.fullmatch(r"trials-(\d+)-(\d+)\.shard", path.name)
    return int(named[2]) - int(named[1]) + 1 if named and has_valid_checksum(path) else 0


def shards_of(folder, output="out.h5"):
    return sorted((folder / f"{output}.shards").glob("*.shard"))


class Bench:
    """The program, a folder, and the results of runs without faults."""

    def __init__(self, program, libraries, folder):
        self.program = str(pathlib.Path(program).resolve())
        self.libraries = {name: str(pathlib.Path(path).resolve()) for name, path in libraries.items()}
        self.root = pathlib.Path(folder)
        self.references = {}

    def folder(self, name):
        """A fresh folder for one fault."""
        path = self.root / name
        path.mkdir(parents=True)
        return path

    def start(self, words, folder, env=None, before=None, wrapper=()):
        out, err = (folder / ".out").open("w"), (folder / ".err").open("w")
        process = subprocess.Popen([*wrapper, self.program, *words], cwd=folder, env={**os.environ, **(env or {})},
                                   stdin=subprocess.DEVNULL, stdout=out, stderr=err, preexec_fn=before)
        out.close()
        err.close()
        return process

    def end(self, process, folder):
        try:
            code = process.wait(LONGEST)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            raise Lost(f"it did not end within {LONGEST} s") from None
        return Ending(code, (folder / ".out").read_text(errors="replace"), (folder / ".err").read_text(errors="replace"))

    def run(self, words, folder, env=None, before=None, wrapper=()):
        return self.end(self.start(words, folder, env, before, wrapper), folder)

    def failing(self, folder, at, error, lasting=False, calls="writes"):
        """The environment in which a call of the system fails (see tests/support/failing_calls.cpp)."""
        count = folder.parent / f"{folder.name}.count"
        env = {"LD_PRELOAD": self.libraries["failing_calls"], "FAIL_UNDER": str(folder), "FAIL_CALLS": calls,
               "FAIL_AT": str(at), "FAIL_ERROR": str(error), "FAIL_COUNT": str(count)}
        return {**env, "FAIL_LASTING": "1"} if lasting else env

    def calls_of(self, words, folder, calls="writes"):
        """The number of calls that the command makes."""
        ended = self.run(words, folder, self.failing(folder, 0, 5, calls=calls))
        assert ended.code == 0, ended.err
        return int((folder.parent / f"{folder.name}.count").read_text())

    def add_study(self, name, trials):
        """Writes the manifest, runs it without a fault and keeps the datasets; seconds that the run took."""
        folder = self.folder(f"reference-{name}")
        self.write_manifest(folder, trials)
        begun = time.monotonic()
        ended = self.run(["run", "study.yaml", "-o", "out.h5", "-q"], folder)
        assert ended.code == 0, ended.err
        self.references[name] = (trials, folder, datasets(folder / "out.h5"))
        return time.monotonic() - begun

    @staticmethod
    def write_manifest(folder, trials):
        (folder / "study.yaml").write_text(MANIFEST.format(trials=trials))

    def study_folder(self, study, name):
        folder = self.folder(name)
        self.write_manifest(folder, self.references[study][0])
        return folder

    def require_served_right(self, study, folder, output="out.h5"):
        """What stands at the output's name is readable and right, or nothing stands there."""
        path = folder / output
        if not path.exists():
            return False
        ended = self.run(["summary", output], folder)
        if ended.code != 0:
            raise Lost(f"{output} stands there and cannot be read: {ended.err.strip()}")
        found, right = datasets(path), self.references[study][2]
        wrong = sorted(name for name in found.keys() | right.keys() if found.get(name) != right.get(name))
        if wrong:
            raise Lost(f"{output} has wrong data: {', '.join(wrong[:5])}")
        return True

    def require_going_on(self, study, folder, kept=None, words=RUN):
        """The same command without the fault ends, with the right data, and keeps what was complete.

        kept: trials that must not be run again; None: those of all valid shards.
        """
        was_there = self.require_served_right(study, folder)
        if kept is None:
            kept = sum(trials_of(path) for path in shards_of(folder))
        ended = self.run(words, folder)
        if ended.code != 0:
            raise Lost(f"the same command does not go on: exit code {ended.code}: {ended.err.strip()[-300:]}")
        if not self.require_served_right(study, folder):
            raise Lost("the command ended with exit code 0 and there is no output")
        told = re.findall(r"(\d+) of them from before", ended.err)
        if words[0] == "run" and not was_there and int(told[-1] if told else 0) != kept:
            raise Lost(f"{kept} trials were complete, {told[-1] if told else 0} were kept")
        left = [path.name for path in folder.rglob("*") if path.suffix in (".part", ".lock")]
        if left or shards_of(folder):
            raise Lost(f"left behind: {', '.join(left) or 'shards'}")


def kill_after(process, seconds, number=signal.SIGKILL):
    """Sends the signal after this time, unless the process has ended before."""
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        process.send_signal(number)


def copy_tree(source, target):
    shutil.copytree(source, target, dirs_exist_ok=True)
