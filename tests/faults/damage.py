"""Files that are damaged: shards of a run that goes on, what a killed run leaves, and results that are read."""

import random
import shutil
import time

import h5py

from bench import Lost, RUN, TRAILER, append_checksum, copy_tree, shards_of, trials_of


def truncated(path, draw):
    data = path.read_bytes()
    path.write_bytes(data[:draw.randrange(len(data))])


def zeroed(path, draw):
    """A block that was never written, as after a power failure."""
    data = bytearray(path.read_bytes())
    first = draw.randrange(0, len(data), 512)
    size = min(draw.choice([512, 4096, 65536]), len(data) - first)
    data[first:first + size] = b"\xff" + bytes(size - 1) if not any(data[first:first + size]) else bytes(size)
    path.write_bytes(data)


def bit_flipped(path, draw):
    data = bytearray(path.read_bytes())
    data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
    path.write_bytes(data)


def emptied(path, draw):
    path.write_bytes(b"")


def missing(path, draw):
    path.unlink()


DAMAGES = {"truncated": truncated, "zeroed": zeroed, "one bit flipped": bit_flipped, "empty": emptied}


def change_value(path, draw, name, change):
    """Another value of a dataset, and a right checksum."""
    data = path.read_bytes()[:-TRAILER]
    path.write_bytes(data)
    with h5py.File(path, "r+", locking=False) as file:
        values = file[name][...]
        place = draw.randrange(values.size)
        values.flat[place] = change(values.flat[place])
        file[name][...] = values
    path.write_bytes(path.read_bytes() + bytes(TRAILER))
    append_checksum(path)


def unfinished_run(bench, name):
    """A folder with the shards of a run that was killed."""
    folder = bench.folder(name)
    copy_tree(bench.unfinished, folder)
    return folder


def damaged_shard(bench, name, damage, seed):
    draw = random.Random(seed)
    folder = unfinished_run(bench, name)
    chosen = draw.choice(shards_of(folder))
    damage(chosen, draw)
    bench.require_going_on("long", folder, sum(trials_of(path) for path in shards_of(folder)))


def plausible_value(bench, name, seed):
    """`verify` finds a value that could be right, under a right checksum, and names its file; without the file the run goes on."""
    draw = random.Random(seed)
    folder = unfinished_run(bench, name)
    part = folder / "out.h5.shards" / "part.h5"
    ended = bench.run(["run", "study.yaml", "-q", "-o", "out.h5.shards/part.h5", "--shard", "40/40"], folder)
    assert ended.code == 0, ended.err
    of_trials = ["outcome/holding_torque", "outcome/final_position", "outcome/creep", "trial/input/friction.k2"]
    change_value(part, draw, draw.choice(of_trials), lambda value: value + 1.0e-3)
    ended = bench.run(["verify", "out.h5.shards", "--trials", "1000000"], folder)
    found = [line for line in ended.out.splitlines() if line.startswith("FAILED") and "trials run again" in line]
    if ended.code != 4 or len(found) != 1 or part.name not in found[0]:
        raise Lost(f"verify does not find it: exit code {ended.code}: {ended.out[-300:]}{ended.err[-300:]}")
    part.unlink()
    bench.require_going_on("long", folder)


def foreign_shard(bench, name, replaces, seed):
    """The run says whose shard it is and touches nothing; without it, it goes on."""
    draw = random.Random(seed)
    folder = unfinished_run(bench, name)
    chosen = draw.choice(shards_of(folder))
    if replaces:
        chosen.unlink()
    chosen = chosen.with_name("other.h5")
    shutil.copy(bench.foreign, chosen)
    before = {path: path.read_bytes() for path in chosen.parent.iterdir()}
    ended = bench.run(RUN, folder)
    if ended.code != 2 or chosen.parent.name not in ended.err:
        raise Lost(f"exit code {ended.code}: {ended.err.strip()[-300:]}")
    if {path: path.read_bytes() for path in chosen.parent.iterdir()} != before:
        raise Lost("a shard was changed or removed")
    chosen.unlink()
    bench.require_going_on("long", folder)


def left_over_part(bench, name, place, content, seed):
    """What a killed process left beside the shards or the output, not yet on the disk, or not all of it."""
    draw = random.Random(seed)
    folder = unfinished_run(bench, name)
    shard = draw.choice(shards_of(folder))
    target = folder / place if "/" not in place else folder / "out.h5.shards" / (shard.name + ".part")
    if content == "garbage":
        target.write_bytes(draw.randbytes(draw.randrange(1, 100000)))
    elif content == "empty":
        target.write_bytes(b"")
    else:
        data = shard.read_bytes()
        target.write_bytes(data[:draw.randrange(len(data))] + bytes(draw.randrange(1, 5000)))
    bench.require_going_on("long", folder)


READING = {
    "summary": ["summary", "in.h5"],
    "trace": ["trace", "in.h5", "-o", "new.csv"],
    "export": ["export", "in.h5", "-o", "new"],
    "report": ["report", "in.h5", "-o", "new.html"],
    "plot": ["plot", "in.h5", "--figure", "success", "-o", "new.svg"],
    "compare, as baseline": ["compare", "in.h5", "good.h5"],
    "compare": ["compare", "good.h5", "in.h5"],
    "baseline": ["baseline", "in.h5", "-o", "new.h5", "--reason", "new"],
    "jerks": ["jerks", "in.h5"],
    "sensitivity": ["sensitivity", "in.h5"],
    "merge": ["merge", "in.h5", "-o", "new.h5"],
    "verify": ["verify", "in.h5"],
    "history add": ["history", "add", "in.h5"],
    "run": ["run", "study.yaml", "-o", "in.h5"],
}


def damaged_results(bench, name, words, damage, seed):
    """The command refuses the file with one message and makes nothing of it."""
    folder = bench.study_folder("short", name)
    good = bench.references["short"][1] / "out.h5"
    shutil.copy(good, folder / "good.h5")
    shutil.copy(good, folder / "in.h5")
    damage(folder / "in.h5", random.Random(seed))
    before = set(folder.rglob("*"))
    ended = bench.run(words, folder)
    allowed = {2} if words[0] == "run" else {4}
    if ended.code not in allowed:
        raise Lost(f"{' '.join(words)}: exit code {ended.code}: {ended.err.strip()[-300:]}")
    if "in.h5" not in ended.err + ended.out or "HDF5-DIAG" in ended.err:
        raise Lost(f"{' '.join(words)}: {ended.err.strip()[-300:]}")
    made = [path.name for path in set(folder.rglob("*")) - before if path.name not in (".out", ".err")]
    if made:
        raise Lost(f"{' '.join(words)} made {', '.join(made)}")


def leave_unfinished(bench):
    """Kills a run when it has two shards; False if it ends too early."""
    bench.unfinished = bench.study_folder("long", f"unfinished-{bench.references['long'][0]}")
    process = bench.start([*RUN, "--threads", "1"], bench.unfinished)
    while len(shards_of(bench.unfinished)) < 2 and process.poll() is None:
        time.sleep(0.005)
    process.kill()
    process.wait()
    for path in bench.unfinished.rglob("*.part"):
        path.unlink()
    return len(shards_of(bench.unfinished)) >= 2


def prepare_foreign(bench):
    """A part of another study, as a shard."""
    other = bench.folder("foreign")
    bench.write_manifest(other, 10)
    (other / "study.yaml").write_text((other / "study.yaml").read_text().replace("seed: 42", "seed: 43"))
    ended = bench.run(["run", "study.yaml", "-q", "-o", "part.h5", "--shard", "1/2"], other)
    assert ended.code == 0, ended.err
    bench.foreign = other / "part.h5"


def faults(bench, quick, seconds):
    prepare_foreign(bench)
    draw = random.Random(2)
    for kind, number in (("truncated", 8), ("zeroed", 8), ("one bit flipped", 12), ("empty", 2)):
        for _ in range(int(number > 6) if quick else number):
            yield f"shard {kind}", damaged_shard, (DAMAGES[kind], draw.random())
    for _ in range(1 if quick else 4):
        yield "shard missing", damaged_shard, (missing, draw.random())
    for _ in range(1 if quick else 6):
        yield "`verify` of a shard with a plausible wrong value", plausible_value, (draw.random(),)
    for replaces in (True,) if quick else (True, True, False, False):
        yield "shard of another study", foreign_shard, (replaces, draw.random())
    for place in ("out.h5.shards/",) if quick else ("out.h5.part", "out.h5.shards/"):
        for content in ("cut",) if quick else ("cut", "cut", "garbage", "empty"):
            yield "left-over .part", left_over_part, (place, content, draw.random())
    for command, words in READING.items():
        kinds = [draw.choice(list(DAMAGES))] if quick else DAMAGES
        for kind in kinds:
            yield "damaged results given to a reading command", damaged_results, (words, DAMAGES[kind], draw.random())
