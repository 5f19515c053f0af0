"""Processes that are killed, interrupted, started twice, or whose clocks jump."""

import random
import shutil
import signal

from bench import Lost, RUN, datasets, kill_after, shards_of

SIGNALS = {"KILL": signal.SIGKILL, "TERM": signal.SIGTERM, "INT": signal.SIGINT}


def killed_at_a_moment(bench, name, number, seconds):
    folder = bench.study_folder("long", name)
    process = bench.start(RUN, folder)
    kill_after(process, seconds, number)
    bench.end(process, folder)
    bench.require_going_on("long", folder)


def killed_again_and_again(bench, name, numbers, seconds):
    """Every start goes on from where the last one was killed."""
    folder = bench.study_folder("long", name)
    complete = 0
    for number in numbers:
        process = bench.start(RUN, folder)
        kill_after(process, seconds, number)
        bench.end(process, folder)
        before, complete = complete, len(shards_of(folder))
        if complete < before and not (folder / "out.h5").exists():
            raise Lost("a finished shard is gone")
    bench.require_going_on("long", folder)


def killed_at_a_call(bench, name, at, number):
    folder = bench.study_folder("short", name)
    bench.run(RUN, folder, bench.failing(folder, at, f"signal{number}"))
    bench.require_going_on("short", folder)


def parts(bench, folder):
    """The study in two parts, to be merged."""
    for part in (1, 2):
        ended = bench.run(["run", "study.yaml", "-q", "-o", f"{part}.h5", "--shard", f"{part}/2"], folder)
        assert ended.code == 0, ended.err
    return ["merge", "1.h5", "2.h5", "-o", "out.h5"]


def killed_merge(bench, name, at, number):
    folder = bench.study_folder("short", name)
    words = parts(bench, folder)
    before = [datasets(folder / part) for part in ("1.h5", "2.h5")]
    bench.run(words, folder, bench.failing(folder, at, f"signal{number}"))
    if [datasets(folder / part) for part in ("1.h5", "2.h5")] != before:
        raise Lost("a part was changed")
    if (folder / "out.h5").exists():
        bench.require_served_right("short", folder)
        return
    bench.require_going_on("short", folder, words=words)


def texts(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def killed_text_output(bench, name, command, target, at):
    """An export or a report: what has its name is whole, and the next attempt makes all of it."""
    folder = bench.study_folder("short", name)
    shutil.copy(bench.references["short"][1] / "out.h5", folder / "in.h5")
    words = [command, "in.h5", "-o", target, "--force"]
    ended = bench.run(words, folder)
    assert ended.code == 0, ended.err
    right = texts(folder / target) if (folder / target).is_dir() else {target: (folder / target).read_bytes()}
    shutil.rmtree(folder / target) if (folder / target).is_dir() else (folder / target).unlink()
    bench.run(words, folder, bench.failing(folder, at, "signal9"))

    def found():
        place = folder / target
        return texts(place) if place.is_dir() else {target: place.read_bytes()} if place.exists() else {}

    for path, content in found().items():
        if not str(path).endswith(".part") and content != right[path]:
            raise Lost(f"{path} is not whole")
    if bench.run(words, folder).code != 0 or found() != right:
        raise Lost("the same command does not make the same files")


def two_runs(bench, name, seconds):
    """One of two runs on one output is refused; the other ends as if it were alone."""
    folder = bench.study_folder("long", name)
    first = bench.start(RUN, folder)
    kill_after(first, seconds, 0)  # signal 0 is none: this waits
    codes = [bench.run(RUN, folder).code, bench.end(first, folder).code]
    if not set(codes) <= {0, 5} or 0 not in codes:
        raise Lost(f"exit codes {codes}")
    if not bench.require_served_right("long", folder):
        raise Lost("no output")


def clock_that_jumps(bench, name, at, jump, study):
    folder = bench.study_folder(study, name)
    env = {"LD_PRELOAD": bench.libraries["clock_jumps"], "CLOCK_AT": str(at), "CLOCK_JUMP": str(jump)}
    ended = bench.run(RUN, folder, env)
    if ended.code != 0:
        raise Lost(f"exit code {ended.code}: {ended.err.strip()[-300:]}")
    bench.require_going_on(study, folder)


def faults(bench, quick, seconds):
    """(kind, function, arguments) of every fault. seconds: duration of the long run without a fault"""
    draw = random.Random(1)
    for number in SIGNALS:
        for _ in range(int(number != "INT") if quick else 9):
            yield f"{number} at a random moment of run", killed_at_a_moment, (SIGNALS[number], draw.uniform(0.0, 1.1 * seconds))
    for _ in range(0 if quick else 4):
        numbers = [draw.choice(list(SIGNALS.values())) for _ in range(4)]
        yield "run killed four times", killed_again_and_again, (numbers, draw.uniform(0.3, 0.6) * seconds)
    count = bench.calls_of(RUN, bench.study_folder("short", "count-run"))
    for at in draw.sample(range(1, count + 1), 4 if quick else 36):
        yield "KILL at the n-th system call of run", killed_at_a_call, (at, signal.SIGKILL)
    for at in draw.sample(range(1, count + 1), 1 if quick else 8):
        yield "TERM, INT at the n-th system call of run", killed_at_a_call, (at, draw.choice([signal.SIGTERM, signal.SIGINT]))
    folder = bench.study_folder("short", "count-merge")
    count = bench.calls_of(parts(bench, folder), folder)
    for at in draw.sample(range(1, count + 1), 2 if quick else 24):
        yield "KILL at the n-th system call of merge", killed_merge, (at, signal.SIGKILL)
    for command, target, number in (("export", "tables", 12), ("report", "page.html", 6)):
        folder = bench.study_folder("short", f"count-{command}")
        shutil.copy(bench.references["short"][1] / "out.h5", folder / "in.h5")
        count = bench.calls_of([command, "in.h5", "-o", target, "--force"], folder)
        for at in draw.sample(range(1, count + 1), min(count, 1 if quick else number)):
            yield f"KILL at the n-th system call of {command}", killed_text_output, (command, target, at)
    for _ in range(1 if quick else 4):
        yield "two runs on one output", two_runs, (draw.uniform(0.05, 0.8) * seconds,)
    for jump in (-86400, 5, 3600, 10**9) if not quick else (3600,):
        for study in ("short", "long") if not quick else ("short",):
            yield "clock that jumps", clock_that_jumps, (draw.randint(1, 30), jump, study)
