"""Runs of the program: interruption, extension, progress, errors and cost."""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import signal
import statistics
import stat
import subprocess
import sys
import time
from collections.abc import Callable, Iterator

import pytest
import zerocount as zc
import zerocount.program
import zerocount.studies
from support import datasets_of, program, said_by_program, same


def assert_same_data(one: zc.Results, other: zc.Results) -> None:
    """Two files have the same datasets, to the bit, except for the texts that tell how they were made."""
    mine, its = datasets_of(one.path), datasets_of(other.path)
    assert set(mine) == set(its)
    assert [name for name in mine if name != "overrides" and not same(mine[name], its[name])] == []


def shown_by(monkeypatch: pytest.MonkeyPatch, show: Callable[[str], None]) -> None:
    """Gives the progress of runs to a function, as a terminal or a notebook would get it."""
    monkeypatch.setattr(zerocount.studies, "progress_bar", lambda name, wanted: contextlib.nullcontext(show))


@pytest.fixture
def interrupted_run(axis: zc.Study, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> tuple[pathlib.Path, list[str]]:
    """A run of the first study that was interrupted at its first line of progress, and what it showed."""
    lines: list[str] = []

    def show(line: str) -> None:
        if not lines:
            os.kill(os.getpid(), signal.SIGINT)
        lines.append(line)

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        shown_by(patch, show)
        axis.run(tmp_path / "interrupted.h5", threads=1)
    return tmp_path / "interrupted.h5", lines


def test_an_interrupted_run_continues(
    axis: zc.Study, first: zc.Results, interrupted_run: tuple[pathlib.Path, list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same call goes on after an interruption; the data are those of a run without one, on other threads."""
    output, lines = interrupted_run
    assert "%" in lines[0] and not output.exists()
    later: list[str] = []
    shown_by(monkeypatch, later.append)
    result = axis.run(output, threads=1)
    before, *percents = [float(line.partition("(")[2].partition(" %")[0]) for line in [lines[0], *later]]
    assert percents == sorted(percents) and percents[0] >= before > 0.0
    assert_same_data(result, first)


def test_a_finished_run_is_opened(axis: zc.Study, first: zc.Results, capfd: pytest.CaptureFixture[str]) -> None:
    """Running a finished study again does not change the file. Without a terminal nothing is shown."""
    before = first.path.read_bytes()
    assert axis.run(first.path).table.equals(first.table)
    assert first.study.run(first.path).path == first.path
    assert first.path.read_bytes() == before
    assert capfd.readouterr() == ("", "")


def test_a_study_that_stopped_is_opened(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """A finished study that chose its number of trials is opened by its own study."""
    stop = {"success_rate_halfwidth": 0.1, "max_trials": 1000}
    study = axis.without("goal", "machines").sweep("controller.ki", [5e3]).set(trials=100, stop=stop)
    r = study.run(tmp_path / "stop.h5")
    assert 100 < len(r.trials()) < 1000
    assert study.run(r.path).trials().equals(r.trials())


def test_another_study_is_refused_and_force_replaces_it(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """A file of another study stays as it was, unless it is to be replaced."""
    few = axis.set(machines=2, trials=4)
    few.run(tmp_path / "r.h5")
    before = (tmp_path / "r.h5").read_bytes()
    with pytest.raises(zc.ManifestError, match="results of another study: seed is 1 there and 2 here"):
        few.set(seed=2).run(tmp_path / "r.h5")
    assert (tmp_path / "r.h5").read_bytes() == before
    assert few.set(seed=2).run(tmp_path / "r.h5", force=True).checked.seed == 2


def test_a_run_is_extended(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """More trials of the same study are added to those of the file: all are as in one run."""
    some, more = axis.set(machines=4, trials=40), axis.set(machines=4, trials=100)
    some.run(tmp_path / "extended.h5")
    r = more.run(tmp_path / "extended.h5")
    assert_same_data(r, more.run(tmp_path / "whole.h5", threads=1))
    assert len(r.trials(0)) == 100


def test_progress_is_passed_on(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """A function for progress gets whole lines while the program runs."""
    lines: list[str] = []
    words = ["--set", "trials=6000", "--set", "sweep.grid.controller.ki=[4.0e+4]", "--threads", "1"]
    command = ["run", "-", "-o", tmp_path / "r.h5", *words]
    assert zerocount.program.run(command, text=axis.text, progress=lines.append) == (0, "")
    assert len(lines) >= 2 and all(" of 6000 trials (" in line and line.isprintable() for line in lines)


def test_a_watched_run_leaves_its_report(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """The page of a watched run ends as its report."""
    axis.set(trials=20, machines=20).run(tmp_path / "w.h5", watch=tmp_path / "w.html")
    assert "Requirements" in (tmp_path / "w.html").read_text()


@pytest.mark.parametrize("arguments", [("check", "bad.yaml"), ("run", "bad.yaml", "-o", "x.h5"), ("judge", "missing.h5"), ("runs",)])
def test_messages_equal_those_of_the_program(
    axis: zc.Study, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...]
) -> None:
    """The message of an error is all that the program says, line for line, with and without progress."""
    monkeypatch.chdir(tmp_path)
    tree = axis.to_dict()
    tree["friction"].update({f"unknown_{'x' * 200}_{number}": number for number in range(30)})
    pathlib.Path("bad.yaml").write_text(zc.manifests.yaml_text(tree), encoding="utf-8")
    expected = said_by_program(*arguments)
    for progress in (None, lambda line: None):
        with pytest.raises(zc.Error) as raised:
            zerocount.program.run(arguments, progress=progress)
        assert raised.value.message == expected and raised.value.code == program(*arguments).returncode
    assert len(raised.value.problems) == (30 if "bad.yaml" in arguments else 1)


def test_a_run_costs_little_more_than_the_program(axis: zc.Study, folder: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """A run takes at most 0.15 s longer than the same command of the program, the check of its manifest included."""
    path, settings = folder / "my-axis.yaml", {"machines": 2, "trials": 2}
    alone, by_package = [], []
    for number in range(5):
        start = time.perf_counter()
        done = program("run", path, "-o", tmp_path / f"{number}.h5", "--set", "machines=2", "--set", "trials=2")
        alone.append(time.perf_counter() - start)
        assert done.returncode == 0
        start = time.perf_counter()
        zc.study(path).set(**settings).run(tmp_path / f"{number}-package.h5")
        by_package.append(time.perf_counter() - start)
    assert statistics.median(by_package) - statistics.median(alone) < 0.15


@pytest.fixture
def found_anew(monkeypatch: pytest.MonkeyPatch) -> Iterator[pytest.MonkeyPatch]:
    """The program is looked for again, in this test and after it."""
    zerocount.program.path.cache_clear()
    yield monkeypatch
    monkeypatch.undo()
    zerocount.program.path.cache_clear()


def refused(axis: zc.Study) -> zc.MachineError:
    """The error of a call that needs the program."""
    with pytest.raises(zc.MachineError) as raised:
        axis.check()
    assert isinstance(raised.value, OSError) and raised.value.code == 5
    return raised.value


def test_a_missing_program_is_reported(axis: zc.Study, found_anew: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    """Without the program the error says how to install it; what runs in this process still does."""
    found_anew.delenv("ZEROCOUNT_PROGRAM")
    found_anew.setenv("PATH", str(tmp_path))
    found_anew.setattr(sys, "prefix", str(tmp_path))
    message = refused(axis).message
    assert "not found" in message and "apt-get install" in message and "ZEROCOUNT_PROGRAM" in message
    assert len(zc.trial(axis.set(seed=3)).t) > 0


def test_the_program_of_the_path_is_used(axis: zc.Study, found_anew: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    """Without a variable and an installation beside the package, the program of the path runs."""
    (tmp_path / "zerocount").symlink_to(os.environ["ZEROCOUNT_PROGRAM"])
    found_anew.delenv("ZEROCOUNT_PROGRAM")
    found_anew.setenv("PATH", str(tmp_path))
    found_anew.setattr(sys, "prefix", str(tmp_path))
    assert "my-axis" in str(axis.check()) and zerocount.program.path() == str(tmp_path / "zerocount")


@pytest.mark.parametrize(
    ("script", "told"),
    [
        ("echo zerocount 0.0.1", "zerocount 0.0.1; expected zerocount " + zc.__version__),
        ("echo other " + zc.__version__, "expected zerocount " + zc.__version__),
        ("exit 3", "is not a program that runs here"),
        ("", "expected zerocount"),
        (None, "is not a program that runs here"),
    ],
)
def test_another_program_is_refused(
    axis: zc.Study, found_anew: pytest.MonkeyPatch, tmp_path: pathlib.Path, script: str | None, told: str
) -> None:
    """A program of another version, or that is none, is refused by its path."""
    other = tmp_path / "other"
    other.write_text(f"#!/bin/sh\n{script}\n" if script is not None else "no program", encoding="utf-8")
    other.chmod(other.stat().st_mode | (stat.S_IXUSR if script is not None else 0))
    found_anew.setenv("ZEROCOUNT_PROGRAM", str(other))
    message = refused(axis).message
    assert message.startswith(str(other)) and told in message


FAKE = """#!/usr/bin/python3
import json, pathlib, signal, sys, time
here = pathlib.Path(__file__).parent
if sys.argv[1] == "--version":
    print("zerocount", {version!r})
    sys.exit()
(here / "arguments").write_text(json.dumps(sys.argv[1:]))
said, code = json.loads((here / "task").read_text())
if code == "wait":
    signals = []
    signal.signal(signal.SIGINT, lambda *_: signals.append(1))
    (here / "waits").touch()
    while not signals:
        time.sleep(0.01)
    time.sleep(0.3)
    (here / "signals").write_text(str(len(signals)))
    sys.exit(130)
sys.stderr.buffer.write(said.encode())
sys.stderr.flush()
if code < 0:
    signal.raise_signal(-code)
sys.exit(code)
"""


@pytest.fixture
def fake(found_anew: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> Callable[[str, int | str], pathlib.Path]:
    """Puts another program in place of zerocount, which says something and ends with an exit code."""

    def program_that(said: str, code: int | str) -> pathlib.Path:
        (tmp_path / "fake").write_text(FAKE.format(version=zc.__version__), encoding="utf-8")
        (tmp_path / "fake").chmod(0o700)
        (tmp_path / "task").write_text(json.dumps([said, code]), encoding="utf-8")
        found_anew.setenv("ZEROCOUNT_PROGRAM", str(tmp_path / "fake"))
        return tmp_path

    return program_that


CODES = {1: zc.Error, 2: zc.ManifestError, 3: zc.TooLittleDataError, 4: zc.DataError, 5: zc.MachineError, 77: zc.Error}


@pytest.mark.parametrize("progress", [None, lambda line: None], ids=["quiet", "progress"])
@pytest.mark.parametrize("code", CODES)
def test_each_exit_code_raises_its_error(fake: Callable[..., pathlib.Path], code: int, progress: Callable[[str], None] | None) -> None:
    """Each exit code raises its own error, with all that was said, also in a last line without an end and between progress."""
    fake("1 %\r\x1b[Ka.yaml:3:4: key: β is wrong\r\n2 %\r\x1b[Kb.h5: no end", code)
    with pytest.raises(zc.Error) as raised:
        zerocount.program.run(["run"], progress=progress)
    assert type(raised.value) is CODES[code] and raised.value.code == code
    first, last = raised.value.problems
    assert (first.file, first.line, first.column, first.key, first.text) == ("a.yaml", 3, 4, "key", "key: β is wrong")
    assert (last.file, last.text) == ("b.h5", "no end")
    with pytest.raises(CODES[code], match="β is wrong"):  # there is no answer
        zerocount.program.run(["run"], accepted=frozenset({code}))


def test_a_silent_failure_is_reported_with_its_exit_code(fake: Callable[..., pathlib.Path]) -> None:
    """An end without a message tells the program and the exit code."""
    folder = fake("", 77)
    with pytest.raises(zc.Error, match="ended with exit code 77") as raised:
        zerocount.program.run(["run"])
    assert str(folder / "fake") in str(raised.value) and len(raised.value.problems) == 1


def test_a_killed_program_is_reported_with_its_signal(fake: Callable[..., pathlib.Path]) -> None:
    """The end by a signal is a failure of the machine, with what was said before."""
    fake("a last word", -9)
    with pytest.raises(zc.MachineError, match="was ended by the signal SIGKILL\na last word"):
        zerocount.program.run(["run"])


@pytest.mark.parametrize("code", [0, 4])
def test_a_warning_of_the_program_becomes_a_python_warning(fake: Callable[..., pathlib.Path], code: int) -> None:
    """A warning is passed on, whether the program succeeds or not, and is none of the errors."""
    fake("zerocount plot: warning: few trials\nwarning: little memory\na.h5: damaged", code)
    with pytest.warns(UserWarning) as warned:
        if code == 0:
            zerocount.program.run(["run"])
        else:
            with pytest.raises(zc.DataError) as raised:
                zerocount.program.run(["run"])
            assert [problem.file for problem in raised.value.problems] == ["a.h5"]
    assert [str(warning.message) for warning in warned] == ["few trials", "little memory"]


def test_an_interrupted_program_raises_keyboard_interrupt(fake: Callable[..., pathlib.Path]) -> None:
    """A program that was interrupted by somebody else raises KeyboardInterrupt, too."""
    fake("interrupted", 130)
    with pytest.raises(KeyboardInterrupt, match="interrupted"):
        zerocount.program.run(["run"])


def test_options_of_a_run_become_options_of_the_command(small: zc.Results, fake: Callable[..., pathlib.Path], monkeypatch: pytest.MonkeyPatch) -> None:
    """Options of a run are those of the command, and paths are absolute."""
    small.study.checked  # noqa: B018
    folder = fake("", 0)
    monkeypatch.chdir(small.path.parent)
    for options, words in (({}, []), ({"threads": 3}, ["--threads", "3"]), ({"force": True}, ["--force"])):
        small.study.run("small.h5", **options)
        arguments = json.loads((folder / "arguments").read_text(encoding="utf-8"))
        settings = [word for key, value in small.study.settings.items() for word in ("--set", f"{key}={value}")]
        assert arguments == ["run", "-", *settings, "--output", str(small.path.resolve()), *words]


def test_an_interruption_from_the_terminal_reaches_the_program_once(fake: Callable[..., pathlib.Path]) -> None:
    """Ctrl-C in a terminal, which goes to all processes of its group, interrupts the program once, as a second time would end it."""
    folder = fake("", "wait")
    script = "import zerocount.program\nzerocount.program.run(['run'])\n"
    process = subprocess.Popen([sys.executable, "-c", script], stderr=subprocess.PIPE, text=True, start_new_session=True)
    wait_until((folder / "waits").exists)
    os.killpg(process.pid, signal.SIGINT)
    said = process.communicate(timeout=20)[1]
    assert said.rstrip().splitlines()[-1].startswith("KeyboardInterrupt") and process.returncode == -signal.SIGINT
    assert (folder / "signals").read_text(encoding="utf-8") == "1"


def test_the_program_ends_with_the_process_that_called_it(folder: pathlib.Path, axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """Where the calling process is killed, as when a kernel restarts, the program ends and keeps what is finished."""
    script = f"import zerocount as zc\nzc.study({str(folder / 'my-axis.yaml')!r}).set(trials=20000).run('long.h5', threads=1)\n"
    process = subprocess.Popen([sys.executable, "-c", script], cwd=tmp_path)
    wait_until(lambda: any(tmp_path.iterdir()))
    children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text(encoding="utf-8").split()
    assert len(children) == 1
    process.kill()
    process.wait()
    wait_until(lambda: not is_running(int(children[0])))


def is_running(process: int) -> bool:
    """Whether a process exists that has not ended."""
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def wait_until(holds: Callable[[], bool]) -> None:
    """Waits until something holds, for 20 s at most."""
    deadline = time.monotonic() + 20
    while not holds():
        assert time.monotonic() < deadline
        time.sleep(0.02)
