"""clang-tidy, with the checks of .clang-tidy, has nothing to say of the sources.

usage: linting.py ROOT BUILD NAME [CHECKS]
NAME is that of the test, CHECKS what it leaves out of .clang-tidy or adds to it, as in the option --checks.

Lints several of the compiler's units (see cmake/ZerocountTarget.cmake) as one source: most of the time goes into the headers,
which a group of units has parsed and checked once. Units of a group belong to one layer; each folder has a namespace of its own,
so that names in anonymous namespaces do not collide. A group without findings is remembered in the user's cache, as objects are by
ccache, by a hash of all that it includes of this repository: any checkout lints it again only when that, the checks or clang-tidy
change. An empty cache, such as that of a fresh machine, lints everything.
"""

import concurrent.futures
import hashlib
import itertools
import json
import math
import os
import pathlib
import re
import shlex
import subprocess
import sys

FOLDERS = ("core", "experiments", "results", "analysis", "runners")
INCLUDE = re.compile(rb'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
OPTIONS = ["--quiet"]
MAX_UNITS_OF_A_GROUP = 32  # more take more memory (1.5 GB), and are all linted again after a change of one


class Unit:
    """A source that the compiler is given, and those of its options that decide what is in it: its macros, the folders of its
    headers, the language and the instruction set."""

    def __init__(self, root, build, command):
        self.path = pathlib.Path(command["file"])
        home = build if self.path.is_relative_to(build) else root
        self.layer = self.path.relative_to(home).parts[0] if self.path.is_relative_to(home) else ""
        words = iter(shlex.split(command["command"]))
        self.folders, self.options = [], []
        for word in words:
            if word in ("-o", "-c", "-include"):
                next(words)
            elif word.startswith(("-I", "-D")):
                self.folders.append(word)
            elif word == "-isystem":
                self.folders += [word + next(words)]
            elif word.startswith(("-m", "-std")):
                self.options.append(word)


def groups_of(units):
    for _, alike in itertools.groupby(sorted(units, key=lambda unit: (unit.layer, unit.path)), key=lambda unit: unit.layer):
        alike = list(alike)
        size = math.ceil(len(alike) / math.ceil(len(alike) / MAX_UNITS_OF_A_GROUP))
        for first in range(0, len(alike), size):
            yield alike[first : first + size]


def write_groups(folder, groups):
    """A source and the compile command of each group; returns the sources."""
    folder.mkdir(exist_ok=True)
    commands, sources = [], []
    for number, group in enumerate(groups):
        source = folder / f"{group[0].layer}_{number}.cpp"
        source.write_text("".join(f'#include "{unit.path}"\n' for unit in group), encoding="utf-8")
        options = list(dict.fromkeys(word for unit in group for word in unit.folders + unit.options))
        commands.append({"directory": str(folder.parent), "file": str(source),
                         "arguments": ["c++", *options, "-c", str(source)]})
        sources.append(source)
    (folder / "compile_commands.json").write_text(json.dumps(commands, indent=1), encoding="utf-8")
    return sources


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


def fingerprint(root, group, settings):
    """It does not depend on where the checkout is: a generated source names what it includes from the root on."""
    digest = hashlib.sha256(settings)
    files = set()
    for unit in group:
        digest.update(" ".join(word for word in unit.options).encode())
        included(root, unit.path, files)
    for file in sorted(files):
        name = str(file.relative_to(root)) if file.is_relative_to(root) else file.name
        digest.update(name.encode() + b"\0" + file.read_bytes().replace(str(root).encode(), b""))
    return digest.hexdigest()


def cache_folder():
    folder = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "zerocount-lint"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def lint(source, options):
    done = subprocess.run(["clang-tidy", "-p", str(source.parent), *options, str(source)], capture_output=True, text=True,
                          check=False)
    return done.returncode, done.stdout


if __name__ == "__main__":
    root, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    name, checks = sys.argv[3], ",".join(["-bugprone-suspicious-include", *sys.argv[4:]])
    options = [f"--checks={checks}", *OPTIONS]
    version = subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout
    settings = version + (root / ".clang-tidy").read_bytes() + " ".join(options).encode()
    commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    units = [unit for unit in (Unit(root, build, command) for command in commands) if unit.layer in FOLDERS]
    groups = list(groups_of(units))
    sources = write_groups(build / name, groups)

    cache = cache_folder()
    marks = {source: cache / fingerprint(root, group, settings) for source, group in zip(sources, groups)}
    todo = [source for source in sources if not marks[source].exists()]
    todo.sort(key=lambda source: source.stat().st_size, reverse=True)  # the group that takes longest must not begin last
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lint, todo, itertools.repeat(options)))
    failed = {source for source, (code, _) in zip(todo, results) if code}
    for source in set(todo) - failed:
        marks[source].touch()
    for code, output in results:
        if code:
            print(output)
    print(f"{len(units)} units in {len(sources)} groups, {len(todo)} linted now, {len(failed)} with findings")
    sys.exit(1 if failed or not units else 0)
