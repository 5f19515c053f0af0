"""What bash, zsh and fish complete is, when it is run, the name in the study.

usage: completions.py ZEROCOUNT

Each shell runs on a terminal. A line with a Tab at its end is typed, and run: in place of the program a script notes the
words that it got.
"""

import os
import pathlib
import pty
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
LABELS = [
    "a b c",
    "low=1, high=2",
    "~home",
    "t~x y",
    "@SUM(1)",
    "it's a",
    'say "no"',
    "$HOME is",
    "back\\slash",
    "star*?[x]",
    "colon:and;more&",
    "(paren) <b>",
    "!bang !1",
    "é ü ß",
    "#hash",
    "p|q",
]
MANIFEST = f"""
zerocount: 1
name: axis
seed: 4
trials: 4
goals:
  "fine one": {{band: 1, within: 0.1, moves: 0.5}}
  coarse: {{band: 5, within: 0.1, moves: 0.5}}
conditions: {{"no load": {{}}, "with = load": {{plant.inertia: 1.0e-3}}}}
command: {{targets: [3], hold: 0.2}}
sweep:
  cases:
{"".join(f"    {chr(39) + label.replace(chr(39), 2 * chr(39)) + chr(39)}: {{controller.ki: {i + 1}.0e-6}}{chr(10)}" for i, label in enumerate(LABELS))}
"""
GRID = """
zerocount: 1
name: grid
seed: 4
trials: 4
command: {targets: [3], hold: 0.2}
sweep: {grid: {controller.ki: [1.0e-5, 2.0e-5], controller.kp: [0, 1.0e-4]}}
"""


def typed(text):
    """The text as one types it: what the shell would take for something else has a backslash before it."""
    plain = "".join(letter if letter.isalnum() or letter in "._,=:/@" else "\\" + letter for letter in text)
    return "\\" + plain if plain[:1] == "=" else plain


class Shell:
    """A shell on a terminal, and the words that the program gets from it."""

    def __init__(self, words, setup, folder):
        self.words = folder / "words"
        environment = {"PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "HOME": str(folder), "TERM": "dumb", "LC_ALL": "C.UTF-8"}
        process, self.terminal = pty.fork()
        if process == 0:
            os.chdir(folder)
            os.execvpe(words[0], words, environment)
        self.process = process
        threading.Thread(target=self._drain, daemon=True).start()
        for line in setup:
            os.write(self.terminal, (line + "\r").encode())
        self.run("zerocount ready")  # the setup has ended

    def _drain(self):
        try:
            while os.read(self.terminal, 65536):
                pass
        except OSError:
            pass

    def run(self, line):
        """The words that the program gets from the line."""
        self.words.unlink(missing_ok=True)
        os.write(self.terminal, (line + "\r").encode())
        end = time.monotonic() + 10
        while not (self.words.exists() and self.words.read_bytes().endswith(b"\0end\0")):
            if time.monotonic() > end:
                os.write(self.terminal, b"\x03")  # the line may be open still
                raise TimeoutError(line)
            time.sleep(0.01)
        return self.words.read_bytes().decode().split("\0")[:-2]

    def close(self):
        os.kill(self.process, signal.SIGKILL)
        os.waitpid(self.process, 0)
        os.close(self.terminal)


class Completions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        place = tempfile.TemporaryDirectory(prefix="zerocount-completions-")
        cls.addClassCleanup(place.cleanup)
        cls.folder = folder = pathlib.Path(place.name)
        (folder / "bin").mkdir()
        (folder / "axis.yaml").write_text(MANIFEST)
        (folder / "grid.yaml").write_text(GRID)
        script = folder / "bin/zerocount"
        script.write_text(
            f'#!/bin/sh\ncase $1 in completion | plot) exec {shlex.quote(str(PROGRAM))} "$@" ;; esac\n'
            f"printf '%s\\0' \"$@\" end > {folder}/words.part && mv {folder}/words.part {folder}/words\n"
        )
        script.chmod(0o755)
        for shell, name in (("bash", "bash"), ("zsh", "_zerocount"), ("fish", "fish")):
            text = subprocess.run([PROGRAM, "completion", shell], capture_output=True, text=True, check=True).stdout
            (folder / name).write_text(text)

    def shell(self, name):
        if shutil.which(name.split()[0]) is None:
            self.skipTest(f"{name} is not installed")
        words, setup = {
            "bash": (["bash", "--norc", "--noprofile", "-i"], [f"source {self.folder}/bash"]),
            "zsh": (["zsh", "-f", "-i"], [f"fpath=({self.folder} $fpath)", "autoload -Uz compinit", "compinit -u -D"]),
            "zsh by source": (["zsh", "-f", "-i"], [f"source {self.folder}/_zerocount"]),
            "fish": (["fish", "--no-config", "-i"], [f"source {self.folder}/fish"]),
        }[name]
        shell = Shell(words, setup, self.folder)
        self.addCleanup(shell.close)
        return shell

    def check_all(self, name):
        shell = self.shell(name)
        for label in LABELS:
            for begin, file in ((label[: len(label) // 2], "~/axis.yaml"), (label[:2], "axis.yaml"), (label[:-1], "./axis.yaml")):
                with self.subTest(shell=name, label=label, typed=begin):
                    said = shell.run(f"zerocount trace {file} --point {typed(begin)}\t")
                    self.assertEqual(said[-2:], ["--point", label])
            with self.subTest(shell=name, label=label, form="--point="):
                self.assertEqual(shell.run(f"zerocount trace axis.yaml --point={typed(label[:2])}\t")[-1], f"--point={label}")
        grid = "controller.ki=2e-05, controller.kp=0.0001"
        for begin in ("controller.ki=2e-05, controller.kp=0.", "controller.ki=2e-05, controller.kp=0.00"):
            self.assertEqual(shell.run(f"zerocount trace grid.yaml --point {typed(begin)}\t")[-1], grid)
        for words, expected in (
            ("limits axis.yaml --condition w\t", "with = load"),
            ("rare axis.yaml --condition n\t", "no load"),
            ("rare axis.yaml --condition with\\ =\t", "with = load"),
            ("tune axis.yaml --extras ma\t", "ma"),  # margins or maps
            ("tune axis.yaml --extras mar\t", "margins"),
            ("tune axis.yaml --extras room,li\t", "room,limits"),
            ("report a.h5 --with limits,wo\t", "limits,worst"),
            ("run axis.yaml --set plant.inert\t1", "plant.inertia=1"),
            ("run axis.yaml --threads ax\t", "ax"),  # no file
            ("run axis.yaml --output ax\t", "axis.yaml"),
            ("summary ax\t", "axis.yaml"),
            ("summ\t", "summary"),
        ):
            with self.subTest(shell=name, line=words):
                self.assertEqual(shell.run("zerocount " + words)[-1], expected)

    def test_bash(self):
        self.check_all("bash")

    def test_zsh(self):
        self.check_all("zsh")

    def test_zsh_that_reads_the_script_with_source(self):
        shell = self.shell("zsh by source")
        self.assertEqual(shell.run("zerocount rare axis.yaml --condition n\t")[-1], "no load")
        self.assertEqual(shell.run("zerocount summary ax\t")[-1], "axis.yaml")

    def test_fish(self):
        self.check_all("fish")

    def test_bash_completes_inside_quotes(self):
        shell = self.shell("bash")
        for line, label in (
            ('--point "a b', "a b c"),
            ("--point 'low=1, h", "low=1, high=2"),
            ('--point "low=', "low=1, high=2"),
            ("--point=\"it's", "it's a"),
            ("--point 'say \"", 'say "no"'),
            ('--point "back', "back\\slash"),
            ("--point 'star", "star*?[x]"),
            ('--point low"=1, h', "low=1, high=2"),
        ):
            with self.subTest(line=line):
                self.assertEqual(shell.run(f"zerocount trace axis.yaml {line}\t")[-1].removeprefix("--point="), label)

    def test_completion_lists_points_conditions_goals_and_ages(self):
        def listed(what):
            words = [PROGRAM, "completion", what, self.folder / "axis.yaml"]
            return subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()

        self.assertEqual(listed("points"), LABELS)
        self.assertEqual(listed("conditions"), ["no load", "with = load"])
        self.assertEqual(listed("goals"), ["fine one", "coarse"])
        self.assertEqual(listed("ages"), [])


if __name__ == "__main__":
    unittest.main()
