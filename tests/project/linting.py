"""clang-tidy, with the checks of .clang-tidy, has nothing to say of the sources.

Lints what the compiler compiles: a unit (see cmake/ZerocountTarget.cmake) has the headers of up to twelve sources parsed once.
A unit without findings is remembered in the build folder by a hash of all that it includes of this repository, and is linted
again only when that, the checks or clang-tidy change. A fresh build folder, such as that of continuous integration, lints
everything.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

FOLDERS = ("core", "experiments", "results", "analysis", "runners")
INCLUDE = re.compile(rb'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
# A unit includes sources; GCC's warnings are not all known to clang.
OPTIONS = ["--quiet", "--checks=-bugprone-suspicious-include", "--extra-arg=-Wno-unknown-warning-option"]


def included(root, path, seen):
    """`path` and what it includes, directly or not, of the repository."""
    if path in seen:
        return seen
    seen.add(path)
    for name in INCLUDE.findall(path.read_bytes()):
        target = root / name.decode()
        if target.exists():
            included(root, target, seen)
    return seen


def fingerprint(root, path, settings):
    digest = hashlib.sha256(settings)
    for file in sorted(included(root, path, set())):
        digest.update(str(file).encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()


def lint(build, path):
    done = subprocess.run(["clang-tidy", "-p", str(build), *OPTIONS, str(path)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


if __name__ == "__main__":
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    version = subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout
    settings = version + (root / ".clang-tidy").read_bytes() + " ".join(OPTIONS).encode()
    commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    units = sorted({pathlib.Path(command["file"]) for command in commands})
    units = [unit for unit in units if unit.is_relative_to(build) or unit.is_relative_to(root)]
    units = [unit for unit in units if unit.relative_to(build if unit.is_relative_to(build) else root).parts[0] in FOLDERS]

    memory = build / "linted.json"
    clean = set(json.loads(memory.read_text(encoding="utf-8"))) if memory.exists() else set()
    marks = {unit: fingerprint(root, unit, settings) for unit in units}
    todo = [unit for unit in units if marks[unit] not in clean]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda unit: lint(build, unit), todo))
    failed = {unit for unit, (code, _) in zip(todo, results) if code}
    memory.write_text(json.dumps(sorted(marks[unit] for unit in units if unit not in failed)), encoding="utf-8")
    for code, output in results:
        if code:
            print(output)
    print(f"{len(units)} units, {len(todo)} linted now, {len(failed)} with findings")
    sys.exit(1 if failed or not units else 0)
