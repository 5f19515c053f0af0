#!/usr/bin/python3
"""Makes the wheel that has package, program and libraries, so that pip installs all of it in a bare environment of any Python 3.

usage: make_wheel.py BUILD TARGET

BUILD is a build for any machine of the architecture, such as build/portable. TARGET is the folder for the wheel.
"""

import hashlib
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tempfile

import bundle

LIBRARIES = "zerocount.libs"
# The newest symbols of libstdc++ on systems with this version of glibc, by PEP 600's profiles as auditwheel has them.
COMPILER_OF = {(2, 34): (3, 4, 29), (2, 35): (3, 4, 30), (2, 38): (3, 4, 32)}


def own_name(name, path):
    """The name of a library in the wheel: a process that has loaded another of its name still loads this one."""
    stem, _, rest = name.partition(".so")
    return f"{stem}-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}.so{rest}"


def platform_tag(files):
    """manylinux_2_N for the oldest glibc whose symbols are enough, as PEP 600 defines it."""
    glibc = bundle.symbol_versions(files, "GLIBC")
    compiler = bundle.symbol_versions(files, "GLIBCXX")
    newest = [max(glibc, known) for known, its in COMPILER_OF.items() if its >= compiler]
    if not newest:
        raise SystemExit(f"no known system has libstdc++ with GLIBCXX_{'.'.join(map(str, compiler))}")
    return "manylinux_{}_{}_{}".format(*min(newest), platform.machine())


def main(build, target):
    with tempfile.TemporaryDirectory() as temporary:
        content = pathlib.Path(temporary)
        files = {build / "zerocount": "zerocount/bin/zerocount", build / "libzerocount.so.1": "zerocount/lib/libzerocount.so.1"}
        without = bundle.OF_C_LIBRARY | bundle.OF_COMPILER  # a system with Python has those of the compiler
        libraries, unused = bundle.libraries_of(list(files), without)
        names = {name: own_name(name, path) for name, path in libraries.items()}
        for file, target_file in files.items():
            bundle.place(file, content / target_file, f"$ORIGIN/../../{LIBRARIES}", names)
        bundle.place_libraries(libraries, unused, content / LIBRARIES, names)
        bundle.place_licences(libraries, content / LIBRARIES / "licences")
        tag = platform_tag([file for file in content.rglob("*") if file.is_file() and file.read_bytes()[:4] == b"\x7fELF"])
        environment = {**os.environ, "ZEROCOUNT_BUNDLE": str(content), "ZEROCOUNT_PLATFORM": tag}
        for stale in target.glob("zerocount-*.whl"):
            stale.unlink()
        with tempfile.TemporaryDirectory() as source:
            copy = pathlib.Path(source, "source")
            for name in ("pyproject.toml", "setup.py", "LICENSE", "runners/python"):
                (copy / name).parent.mkdir(parents=True, exist_ok=True)
                whole = bundle.ROOT / name
                (shutil.copytree if whole.is_dir() else shutil.copyfile)(whole, copy / name)
            subprocess.run([sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "-w", target, copy],
                           check=True, env=environment)
    made = next(target.glob("zerocount-*.whl"))
    print(f"{made}: {made.stat().st_size / 1e6:.1f} MB, {len(libraries)} libraries")


if __name__ == "__main__":
    main(*(pathlib.Path(word).resolve() for word in sys.argv[1:3]))
