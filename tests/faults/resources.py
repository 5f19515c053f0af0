"""Disks, folders, memory and file handles that run out or fail."""

import errno
import random
import resource
import shutil
import subprocess
import sys

from bench import Lost, RUN, copy_tree, kill_after

MEBIBYTE = 1 << 20


def can_mount():
    mount = ["unshare", "-rm", "mount", "-t", "tmpfs", "none", "/mnt"]
    return subprocess.run(mount, capture_output=True, check=False).returncode == 0


def require_told(ended, codes=(0, 5)):
    """The command ends by itself, with one message where it fails."""
    if ended.code not in codes:
        raise Lost(f"exit code {ended.code}: {ended.err.strip()[-300:]}")


def full_disk(bench, name, kibibytes, more):
    """Runs on a file system of its own of this size, then goes on with what is left on a larger one."""
    folder = bench.study_folder("long", name)
    disk = folder / "disk"
    disk.mkdir()
    script = (f"mount -t tmpfs -o size={kibibytes}k{more} tmpfs disk && cp study.yaml disk 2>/dev/null; cd disk && "
              '"$@"; code=$?; cp -r . ../left; exit $code')
    ended = bench.run(RUN + ["--force"], folder, wrapper=["unshare", "-rm", "sh", "-c", script, "sh"])
    require_told(ended)
    left = folder / "left"
    shutil.copy(folder / "study.yaml", left)
    bench.require_going_on("long", left)


def read_only_folder(bench, name):
    folder = bench.study_folder("short", name)
    script = 'mount --bind . . && cd "$PWD" && mount -o remount,ro,bind . && "$@"'
    ended = bench.run(RUN, folder, wrapper=["unshare", "-rm", "sh", "-c", script, "sh"])
    require_told(ended, (5,))
    bench.require_going_on("short", folder)


def limit(what, value):
    def set_limit():
        resource.setrlimit(what, (value, value))

    return set_limit


def limited(bench, name, what, value, study, codes):
    folder = bench.study_folder(study, name)
    require_told(bench.run(RUN, folder, before=limit(what, value)), codes)
    bench.require_going_on(study, folder)


def failing_call(bench, name, at, error, lasting):
    folder = bench.study_folder("short", name)
    require_told(bench.run(RUN, folder, bench.failing(folder, at, error, lasting)))
    bench.require_going_on("short", folder)


def vanished_folder(bench, name, seconds, which, back):
    """The folder of the shards, or that of the output, is moved away while the run writes to it."""
    outer = bench.study_folder("long", name)
    folder = outer / "place"
    folder.mkdir()
    shutil.copy(outer / "study.yaml", folder)
    process = bench.start([RUN[0], "study.yaml", "-o", "place/out.h5"], outer)
    kill_after(process, seconds, 0)  # signal 0 is none: this waits
    source = outer / which
    moved = source.exists()
    if moved:
        shutil.move(source, outer / "away")
    ended = bench.end(process, outer)
    require_told(ended, (0, 2, 5))
    if moved and back:
        if source.exists():
            copy_tree(outer / "away", source)
        else:
            shutil.move(outer / "away", source)
    folder.mkdir(exist_ok=True)
    shutil.copy(outer / "study.yaml", folder)
    bench.require_going_on("long", folder)


def faults(bench, quick, seconds):
    draw = random.Random(3)
    size = (bench.references["long"][1] / "out.h5").stat().st_size
    if can_mount():
        for _ in range(1 if quick else 10):
            yield "disk full", full_disk, (draw.randint(16, 3 * size // 1024), "")
        for _ in range(0 if quick else 4):
            yield "no inodes left", full_disk, (100 * 1024, f",nr_inodes={draw.randint(3, 9)}")
        for _ in range(1 if quick else 2):
            yield "read-only folder", read_only_folder, ()
    else:
        print("not tried: disk full, no inodes left, read-only folder (unshare -rm mount is refused here)", file=sys.stderr)
    for _ in range(0 if quick else 8):
        yield "limit of the file size", limited, (resource.RLIMIT_FSIZE, draw.randint(1000, size), "long", (0, 5))
    count = bench.calls_of(RUN, bench.study_folder("short", "count-failing"))
    errors = (errno.EDQUOT, errno.EROFS, errno.ENOENT, errno.ENOSPC, errno.EIO)
    for at in draw.sample(range(1, count + 1), 2 if quick else 20):
        yield "open, write, fsync or rename fails", failing_call, (at, draw.choice(errors), draw.random() < 0.5)
    for which, back in (("place/out.h5.shards", True),) if quick else (
            ("place/out.h5.shards", True), ("place/out.h5.shards", False), ("place", True), ("place", False)) * 2:
        yield "folder that vanishes", vanished_folder, (draw.uniform(0.2, 0.9) * seconds, which, back)
    for _ in range(1 if quick else 12):
        yield "limit of the memory", limited, (resource.RLIMIT_AS, draw.randint(20, 600) * MEBIBYTE, "long", (0, 5, 127))
    for handles in (8,) if quick else range(4, 26, 2):
        yield "limit of the file handles", limited, (resource.RLIMIT_NOFILE, handles, "short", (0, 5, 127))
