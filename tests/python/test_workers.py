"""Studies in parts on the workers of a Dask cluster of this machine."""

from __future__ import annotations

import contextlib
import os
import pathlib
import re
import signal
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import zerocount as zc
import zerocount.studies
from support import program
from zerocount import workers

distributed = pytest.importorskip("distributed")

pytestmark = pytest.mark.long  # workers are processes, and each of them takes seconds to start

SEAL = 87
CREATED = re.compile(rb"20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ")


def undated(path: pathlib.Path) -> bytes:
    """The bytes of a results file without the date, and without the checksum, which depends on it."""
    whole, dates = CREATED.subn(b"", path.read_bytes()[:-SEAL])
    assert dates == 1
    return whole


def identity(path: pathlib.Path) -> tuple[str, int, int]:
    """The name of a file, its number and its date, which are others once it is written again."""
    state = path.stat()
    return path.name, state.st_ino, state.st_mtime_ns


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    """Of two workers, each a process with one thread."""
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as its,
    ):
        yield its


@pytest.fixture(scope="module")
def long(axis: zc.Study) -> zc.Study:
    """The first study at three gains, which takes a second or two."""
    return axis.set(machines=200, trials=400).sweep("controller.ki", [5e3, 1.2e4, 4e4])


@pytest.fixture(scope="module")
def alone(long: zc.Study, folder: pathlib.Path) -> pathlib.Path:
    """The results of it by one machine."""
    return long.run(folder / "long-alone.h5").path


def shown_by(monkeypatch: pytest.MonkeyPatch, show: Callable[[str], None]) -> None:
    monkeypatch.setattr(zerocount.studies, "progress_bar", lambda name, wanted: contextlib.nullcontext(show))


def test_the_file_equals_that_of_one_computer(
    long: zc.Study, alone: pathlib.Path, client: Any, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A run on workers gives the file of a run without them, tells its progress, and leaves nothing else."""
    lines: list[str] = []
    shown_by(monkeypatch, lines.append)
    r = long.run(tmp_path / "r.h5", client=client)
    assert undated(r.path) == undated(alone)
    assert [path.name for path in tmp_path.iterdir()] == ["r.h5"]
    assert lines[0] == "1 of 8 parts (12.5 %)" and lines[-1] == "8 of 8 parts (100.0 %)" and len(lines) == 8
    before = identity(r.path)
    assert identity(long.run(r.path, client=client).path) == before


def test_options_of_the_wrong_kind_of_run_are_refused(axis: zc.Study, client: Any, tmp_path: pathlib.Path) -> None:
    """No option is ignored."""
    with pytest.raises(zc.ManifestError, match="parts: a run on this machine"):
        axis.run(tmp_path / "r.h5", parts=2)
    with pytest.raises(zc.ManifestError, match="watch: a run on workers"):
        axis.run(tmp_path / "r.h5", client=client, watch=tmp_path / "r.html")


@pytest.mark.long
def test_a_killed_worker_costs_only_its_parts(
    long: zc.Study, alone: pathlib.Path, client: Any, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A worker that is killed with SIGKILL while it runs a part: the others and its successor run what it had."""
    killed: list[int] = []
    before = set(client.scheduler_info()["workers"])

    def kill(line: str) -> None:
        busy = [worker for worker, calls in client.processing().items() if calls]
        if not killed and busy:
            killed.append(client.run(os.getpid, workers=busy[:1])[busy[0]])
            os.kill(killed[0], signal.SIGKILL)

    shown_by(monkeypatch, kill)
    r = long.run(tmp_path / "r.h5", client=client, parts=12)
    assert len(killed) == 1 and undated(r.path) == undated(alone)
    client.wait_for_workers(2)
    assert set(client.scheduler_info()["workers"]) != before


def test_an_interrupted_call_continues_with_the_missing_parts(
    long: zc.Study, alone: pathlib.Path, client: Any, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After Ctrl-C the finished parts are there; the same call runs the others, in the same division without being told."""

    def interrupt(line: str) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        shown_by(patch, interrupt)
        long.run(tmp_path / "r.h5", client=client, parts=6)
    kept = set(map(identity, (tmp_path / "r.h5.parts").iterdir()))
    assert len(kept) == 1 and not (tmp_path / "r.h5").exists()
    with pytest.raises(zc.ManifestError, match="a division by 6; expected parts=6"):
        long.run(tmp_path / "r.h5", client=client, parts=7)
    with pytest.raises(zc.ManifestError, match="another study: seed is 1 there and 2 here"):
        long.set(seed=2).run(tmp_path / "r.h5", client=client)
    assert set(map(identity, (tmp_path / "r.h5.parts").iterdir())) == kept
    lines: list[str] = []
    shown_by(monkeypatch, lines.append)
    assert undated(long.run(tmp_path / "r.h5", client=client).path) == undated(alone)
    assert lines[0].startswith("2 of 6 parts")


@pytest.mark.long
def test_force_discards_what_is_there(axis: zc.Study, client: Any, tmp_path: pathlib.Path) -> None:
    """Parts, shards and results of another study are replaced only with force."""
    few = axis.set(machines=2, trials=4)
    (tmp_path / "r.h5.shards").mkdir()
    with pytest.raises(zc.ManifestError, match=r"continue it without a client"):
        few.run(tmp_path / "r.h5", client=client)
    few.run(tmp_path / "r.h5", client=client, parts=2, force=True)
    with pytest.raises(zc.ManifestError, match="seed is 1 there and 2 here"):
        few.set(seed=2).run(tmp_path / "r.h5", client=client)
    assert few.set(seed=2).run(tmp_path / "r.h5", client=client, parts=3, force=True).checked.seed == 2
    assert [path.name for path in tmp_path.iterdir()] == ["r.h5"]


@pytest.mark.parametrize("parts", [0, 33])
def test_a_study_cannot_have_more_parts_than_trials(axis: zc.Study, client: Any, tmp_path: pathlib.Path, parts: int) -> None:
    """The number of parts is from 1 to that of the trials; the default is at most the latter."""
    few = axis.set(machines=2, trials=4)
    with pytest.raises(zc.ManifestError, match=rf"parts={parts}: expected a number from 1 to 32"):
        few.run(tmp_path / "r.h5", client=client, parts=parts)
    assert list(tmp_path.iterdir()) == []


def test_a_study_that_cannot_be_divided_is_refused_at_once(axis: zc.Study, client: Any, tmp_path: pathlib.Path) -> None:
    """What is wrong with the study has the error of the program, and no other worker tries it."""
    stop = {"success_rate_halfwidth": 0.1, "max_trials": 1000}
    study = axis.without("goal", "machines").sweep("controller.ki", [5e3]).set(trials=100, stop=stop)
    with pytest.raises(zc.ManifestError, match="a study with `stop` cannot be divided"):
        study.run(tmp_path / "r.h5", client=client)


def test_workers_need_no_folder_of_the_client(long: zc.Study, client: Any, tmp_path: pathlib.Path) -> None:
    """A study whose folder a worker does not have runs there."""
    study = zc.studies.Study(long.text, "elsewhere.yaml", tmp_path / "only-here", ["trials=4", "machines=2"])
    (tmp_path / "only-here").mkdir()
    build = program("--version").stdout.strip()
    sent = client.submit(workers.run_part, study, 1, 2, 1, build).result()
    (tmp_path / "only-here").rmdir()
    again = client.submit(workers.run_part, study, 1, 2, 1, build, pure=False).result()
    assert isinstance(sent, bytes) and sent[:1000] == again[:1000] and len(sent) == len(again)


def use_program(path: str) -> None:
    """Runs on a worker: takes another program from now on."""
    from zerocount import program

    os.environ["ZEROCOUNT_PROGRAM"] = path
    program.path.cache_clear()


@contextlib.contextmanager
def program_of_workers(client: Any, path: str) -> Iterator[None]:
    """The workers have another program meanwhile."""
    client.run(use_program, path)
    try:
        yield
    finally:
        client.run(use_program, os.environ["ZEROCOUNT_PROGRAM"])


@pytest.mark.long
def test_a_failure_of_every_worker_raises_a_machine_error(axis: zc.Study, client: Any, tmp_path: pathlib.Path) -> None:
    """A part that fails on every worker ends the run with what the package says there."""
    few = axis.set(machines=2, trials=4)
    with program_of_workers(client, "/nowhere/zerocount"):
        with pytest.raises(zc.MachineError, match="/nowhere/zerocount is not a program that runs here"):
            few.run(tmp_path / "r.h5", client=client, parts=2)
    assert few.run(tmp_path / "r.h5", client=client).trials(0).shape[0] == 4


FAILS_ONCE = """#!/bin/sh
if [ "$1" = run ] && mkdir {folder}/failed 2>/dev/null; then
  echo "part.h5: cannot be written: No space left on device" >&2
  exit 5
fi
exec {program} "$@"
"""


def test_a_part_whose_machine_fails_runs_again(axis: zc.Study, client: Any, tmp_path: pathlib.Path) -> None:
    """After exit code 5 on a worker the part is tried again."""
    script = tmp_path / "fails-once"
    script.write_text(FAILS_ONCE.format(folder=tmp_path, program=os.environ["ZEROCOUNT_PROGRAM"]), encoding="utf-8")
    script.chmod(0o700)
    few = axis.set(machines=2, trials=4)
    with program_of_workers(client, str(script)):
        r = few.run(tmp_path / "r.h5", client=client, parts=2)
    assert (tmp_path / "failed").is_dir()
    assert undated(r.path) == undated(few.run(tmp_path / "alone.h5").path)


def test_another_build_is_refused_before_it_runs(axis: zc.Study, client: Any) -> None:
    """A worker with a program of another build says so, rather than that the merge refuses its trials."""
    with pytest.raises(zc.MachineError, match=r"is zerocount .*; expected zerocount 0\.0"):
        client.submit(workers.run_part, axis, 1, 2, 1, "zerocount 0.0").result()


def test_a_cluster_without_workers_is_reported(axis: zc.Study, tmp_path: pathlib.Path) -> None:
    """Without workers the default number of parts is not known."""
    with (
        distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
        pytest.raises(zc.MachineError, match="no workers yet"),
    ):
        axis.run(tmp_path / "r.h5", client=client)
