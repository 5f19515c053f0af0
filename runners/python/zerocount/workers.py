"""A study that runs in parts on the workers of a Dask cluster.

    for each part that is not in OUTPUT.parts yet:  submit run_part
    for each part that a worker has finished:       write it to OUTPUT.parts
    merge OUTPUT.parts to OUTPUT, and remove it

The workers need no file system in common with the client: a part travels as the bytes of its file.
"""

from __future__ import annotations

import os
import pathlib
import re
import shutil
import tempfile
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from . import program
from .errors import Error, MachineError, ManifestError
from .optional import required
from .options import options

if TYPE_CHECKING:
    from .studies import Study

PARTS_PER_THREAD = 4
"""Default number of parts for each thread of the workers: what is lost with a worker, and how evenly they end."""

RETRIES = 3
"""How often a part is run again after a failure of the machine on which it was."""

_PART = re.compile(r"part-0*(\d+)-of-(\d+)\.h5")


def run_on_workers(
    study: Study,
    output: pathlib.Path,
    client: Any,
    *,
    parts: int | None = None,
    threads: int | None = None,
    force: bool = False,
    progress: Callable[[str], None] | None = None,
) -> None:
    """Run a study in parts on the workers of a Dask cluster, and merge them to its results file.

    Parameters
    ----------
    study : Study
        The study.
    output : path
        The results file.
    client : distributed.Client
        Of the cluster.
    parts : int, optional
        Number of parts; default: that of the parts which exist, or 4 for each thread of the workers.
    threads : int, optional
        Threads of each part; default: 1, because a worker runs as many parts at a time as it has threads.
    force : bool
        Discard existing parts, and replace the output.
    progress : callable, optional
        Is given a line of progress after each part.

    Raises
    ------
    ManifestError
        If the existing parts are of another study or number, or the study cannot be divided.
    MachineError
        If a part failed on every worker that tried it.
    """
    required("distributed", "a run on workers")
    folder, shards = (output.with_name(output.name + ending) for ending in (".parts", ".shards"))
    if force:
        for begun in (folder, shards):
            shutil.rmtree(begun, ignore_errors=True)
    elif shards.exists():
        raise ManifestError(
            f"{output}: a run on this machine has begun and left shards in {shards}; continue it without a client, or give "
            "force=True to discard them",
            2,
        )
    count = _number_of_parts(study, folder, client, parts)
    places = [folder / f"part-{number:0{len(str(count))}}-of-{count}.h5" for number in range(1, count + 1)]
    missing = [number for number, place in enumerate(places, 1) if not _is_complete(study, place, number, count)]
    _make(folder)
    for warning in study.warnings:  # the workers tell them to their logs
        warnings.warn(warning, stacklevel=3)
    _collect(study, client, places, missing, threads or 1, progress)
    program.run(["merge", folder, *options(output=output, force=force)])
    shutil.rmtree(folder, ignore_errors=True)


def run_part(study: Study, number: int, count: int, threads: int, build: str) -> bytes | Error:
    """Run a part of a study on a worker.

    Parameters
    ----------
    study : Study
        The study.
    number, count : int
        Part `number`, from 1, of `count`.
    threads : int
        Threads to use.
    build : str
        What the client's program says of its version: trials of different builds are not mixed.

    Returns
    -------
    bytes or Error
        The part file, or why the study cannot be run on any machine.

    Raises
    ------
    MachineError
        If this machine failed. Another one may not.
    """
    its = program.run(["--version"])[1].strip()
    if its != build:
        raise MachineError(f"{program.path()} is {its}; expected {build}, as where the run was started", 5)
    # Dask removes the folder of a worker that was killed.
    scratch = required("distributed", "a run on workers").get_worker().local_directory
    with tempfile.TemporaryDirectory(prefix="zerocount-", dir=scratch) as folder:
        part = pathlib.Path(folder, "part.h5")
        try:
            study.command(
                "run", *options(shard=f"{number}/{count}", study=study.sha256, threads=threads, quiet=True, output=part)
            )
            return part.read_bytes()
        except MachineError:
            raise
        except Error as error:
            return error


def _number_of_parts(study: Study, folder: pathlib.Path, client: Any, parts: int | None) -> int:
    """As asked for, as there are, or by the threads of the workers."""
    there = {int(name[2]) for path in folder.glob("part-*") if (name := _PART.fullmatch(path.name))}
    if parts is None and len(there) == 1:
        return there.pop()
    if there - {parts}:
        raise ManifestError(
            f"{folder}: holds parts of a division by {', '.join(map(str, sorted(there)))}; expected parts={min(there)}, or "
            "force=True to discard them",
            2,
        )
    available: int = sum(client.nthreads().values())
    if available == 0 and parts is None:
        raise MachineError("the cluster has no workers yet; wait for them (client.wait_for_workers), or give parts=…", 5)
    count = PARTS_PER_THREAD * available if parts is None else parts
    trials = study.trials * len(study.labels)
    if parts is not None and not 1 <= count <= trials:
        raise ManifestError(f"parts={parts}: expected a number from 1 to {trials}, which is that of the trials", 2)
    return min(count, trials)


def _is_complete(study: Study, place: pathlib.Path, number: int, count: int) -> bool:
    """Whether a part is there. Raises ManifestError if the file is anything else: the program says what."""
    if not place.exists():
        return False
    study.command("run", *options(shard=f"{number}/{count}", quiet=True, output=place))
    return True


def _collect(
    study: Study, client: Any, places: list[pathlib.Path], missing: list[int], threads: int, progress: Callable[[str], None] | None
) -> None:
    """Has the missing parts run, and writes each to its place when it is finished."""
    count, build = len(places), program.run(["--version"])[1].strip()
    futures = {
        client.submit(run_part, study, number, count, threads, build, retries=RETRIES, pure=False): number
        for number in missing
    }
    done = count - len(missing)
    try:
        for future in required("distributed", "a run on workers").as_completed(futures):
            number = futures.pop(future)
            _write(places[number - 1], _part_of(future, number, count))
            future.release()
            done += 1
            if progress is not None:
                progress(f"{done} of {count} parts ({100 * done / count:.1f} %)")
    finally:
        client.cancel(list(futures))


def _part_of(future: Any, number: int, count: int) -> bytes:
    """The part that a worker has run, or an error of this package."""
    try:
        part: bytes | Error = future.result()
    except Error:
        raise
    except Exception as error:  # of Dask: the workers died, or lack the package
        raise MachineError(f"part {number} of {count} failed on the workers: {error}", 5) from error
    if isinstance(part, Error):
        raise part
    return part


def _make(folder: pathlib.Path) -> None:
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise MachineError(f"{folder}: cannot be made: {error.strerror}", 5) from None


def _write(path: pathlib.Path, part: bytes) -> None:
    """The file appears whole, after it is on the disk."""
    unfinished = path.with_suffix(".h5.part")
    try:
        with unfinished.open("wb") as file:
            file.write(part)
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(path)
    except OSError as error:
        raise MachineError(f"{path}: cannot be written: {error.strerror}", 5) from None
