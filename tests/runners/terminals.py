"""What people read fits the terminal that it goes to, and a log stays short.

usage: terminals.py ZEROCOUNT
"""

import fcntl
import os
import pathlib
import pty
import re
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unicodedata
import unittest

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
MANIFEST = """
zerocount: 1
name: axis
seed: 4
trials: 400000
controller: {ki: 3.85e-5, sample_rate: 2000, delay: 1.5}
friction: {k1: {lognormal: {median: 110, cv: 0.3}}}
command: {targets: [{integers: [3, 30]}], hold: 0.25}
sweep: {grid: {controller.kp: [0, 3.0e-4, 6.0e-4], controller.ki: [3.0e-5, 3.0e-4]}}
"""


def columns(text):
    return sum(0 if unicodedata.combining(letter) else 1 for letter in text)


def on_terminal(width, *words, cwd, term="xterm", seconds=None):
    """What the program writes to a terminal of this width; it is interrupted after so many seconds."""
    process, terminal = pty.fork()
    if process == 0:
        fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack("HHHH", 40, width, 0, 0))
        os.chdir(cwd)
        os.execve(PROGRAM, ["zerocount", *words], {**os.environ, "TERM": term})
    shown = b""
    end = time.monotonic() + seconds if seconds else None
    while True:
        if end and time.monotonic() > end:
            os.kill(process, signal.SIGINT)
            end = None
        try:
            piece = os.read(terminal, 65536)
        except OSError:
            break
        if not piece:
            break
        shown += piece
    os.waitpid(process, 0)
    os.close(terminal)
    return shown.decode().replace("\r\n", "\n")


def lines(shown):
    """The lines as they stand on the terminal, those that were overwritten too."""
    return [re.sub(r"\x1b\[\w", "", part) for line in shown.split("\n") for part in line.split("\r")]


class Terminals(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="zerocount-terminals-")
        self.addCleanup(self.folder.cleanup)
        (pathlib.Path(self.folder.name) / "axis.yaml").write_text(MANIFEST)
        (pathlib.Path(self.folder.name) / "short.yaml").write_text(MANIFEST.replace("400000", "10"))

    def piped(self, *words, **environment):
        clean = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
        return subprocess.run([PROGRAM, *words], cwd=self.folder.name, env={**clean, **environment}, capture_output=True, text=True)

    def test_limits_shows_its_progress(self):
        shown = on_terminal(100, "limits", "axis.yaml", "--point", "0", cwd=self.folder.name, seconds=2)
        self.assertIn("zerocount limits: the point as it is, ", shown)

    def test_text_for_people_fits_the_terminal(self):
        commands = [["check", "short.yaml"], ["check", "--help"], ["verify", "--help"], ["--help"], ["parameters"], ["new", "--list"],
                    ["plan", "short.yaml"], ["plan", "short.yaml", "--success", "0.99"], ["parameters", "--guides"],
                    ["run", "axis.yaml", "--treads", "3"], ["check", "nowhere.yaml"], ["new"], []]
        for width in (40, 80, 120):
            for words in commands:
                with self.subTest(width=width, words=words):
                    shown = on_terminal(width, *words, cwd=self.folder.name)
                    self.assertTrue(shown.strip())
                    # A word that is wider than the terminal stands alone.
                    wide = [line for line in lines(shown) if columns(line) > width and " " in line.strip()]
                    self.assertEqual(wide, [])

    def test_a_terminal_shows_the_same_words_as_a_pipe(self):
        for words in (["run", "axis.yaml", "--treads", "3"], ["--help"], ["trace", "--help"]):
            with self.subTest(words=words):
                result = self.piped(*words)
                shown = on_terminal(120, *words, cwd=self.folder.name)
                self.assertEqual(sorted(shown.split()), sorted((result.stderr + result.stdout).split()))

    def test_piped_text_follows_the_variable_columns(self):
        for words in (["check", "short.yaml"], ["parameters"]):
            free = self.piped(*words)
            self.assertGreater(max(map(columns, (free.stdout + free.stderr).splitlines())), 100)
            fitted = self.piped(*words, COLUMNS="60")
            self.assertLessEqual(max(columns(line) for line in (fitted.stdout + fitted.stderr).splitlines() if " " in line.strip()), 60)
        self.assertEqual(self.piped("parameters", COLUMNS="0").stdout, self.piped("parameters").stdout)
        self.assertEqual(self.piped("schema", COLUMNS="60").stdout, self.piped("schema").stdout)

    def test_a_progress_line_fits_and_keeps_its_ends(self):
        for width in (30, 80):
            with self.subTest(width=width):
                shown = on_terminal(width, "run", "axis.yaml", "-o", "a.h5", "--threads", "1", cwd=self.folder.name, seconds=2)
                told = [line for line in lines(shown) if " trials (" in line and "kept" not in line]
                self.assertTrue(told, shown)
                self.assertLessEqual(max(map(columns, told)), width)
                if width == 80:
                    self.assertTrue([line for line in told if re.fullmatch(r"\d+ of \d+ trials .*to go", line)], told)

    def test_a_dumb_terminal_gets_no_escapes(self):
        shown = on_terminal(80, "run", "axis.yaml", "-o", "a.h5", "--threads", "1", cwd=self.folder.name, term="dumb", seconds=1)
        self.assertNotIn("\x1b", shown)
        self.assertNotIn("\r", shown)
        self.assertIn("interrupted", shown)

    def test_a_misspelt_option_is_named(self):
        for wrong, right in (("--treads", "--threads"), ("--qiet", "--quiet"), ("--ouput", "--output")):
            self.assertIn(f"unknown option '{wrong}'; did you mean {right}?", self.piped("run", "axis.yaml", wrong).stderr)
        self.assertNotIn("did you mean", self.piped("run", "axis.yaml", "--something-else").stderr)


if __name__ == "__main__":
    unittest.main()
