#!/usr/bin/python3
"""Breaks single lines of the product and reports which tests see it: a mutant that lives shows what no test of its layer protects.

usage: mutants.py ROOT BUILD [--seed N] [--count N] [--time-limit SECONDS]

ROOT is a clean checkout and BUILD its build folder with tests. Each mutant changes one operator, number or returned value in one code
line, drawn at random by the seed: a folder of core, experiments or analysis, then a line of it. The test executables of that layer are
built and run, until one fails. Mutants that do not compile are drawn again. The line is restored in every case.
"""

import argparse
import pathlib
import random
import re
import subprocess
import sys
import time

LAYERS = ("core", "experiments", "analysis")
# What is exchanged, with the blanks that tell an operator from a template or an include.
EXCHANGES = [
    (r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > "), (r" == ", " != "), (r" != ", " == "),
    (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "), (r" && ", " || "), (r" \|\| ", " && "),
    (r" \+= ", " -= "), (r" -= ", " += "), (r"\bstd::min\b", "std::max"), (r"\bstd::max\b", "std::min"),
    (r"\btrue\b", "false"), (r"\bfalse\b", "true"), (r"\bif \(", "if (!("), (r"\b0\.5\b", "0.6"), (r"\b2\.0\b", "2.1"), (r"\b1\.0\b", "1.1"),
]
NOT_CODE = re.compile(r"^\s*(//|#|namespace|using|template|static_assert|/?\*)|^\s*[\w\":,.()%{}-]*\"[^\"]*\",?$")


def code_lines(path):
    return [number for number, line in enumerate(path.read_text(encoding="utf-8").splitlines())
            if line.strip() and not NOT_CODE.match(line)]


def mutations_of(line):
    """All lines that one exchange makes of this one; none within a text in quotation marks."""
    for pattern, other in EXCHANGES:
        for found in re.finditer(pattern, line):
            if line[: found.start()].count('"') % 2 or "//" in line[: found.start()]:
                continue
            if other == "if (!(":
                closed = closing(line, found.end() - 1)
                if closed is None:
                    continue
                yield line[: found.start()] + other + line[found.end():closed] + ")" + line[closed:]
            else:
                yield line[: found.start()] + other + line[found.end():]


def closing(line, opening):
    depth = 0
    for at in range(opening, len(line)):
        depth += {"(": 1, ")": -1}.get(line[at], 0)
        if depth == 0:
            return at
    return None


def draw(root, numbers):
    """A path, the number of one of its lines, and the changed line."""
    while True:
        layer = numbers.choice(LAYERS)
        folder = numbers.choice(sorted(path for path in (root / layer).iterdir() if path.is_dir() and list(path.rglob("*.cpp"))))
        path = numbers.choice(sorted([*folder.rglob("*.cpp"), *folder.rglob("*.hpp")]))
        numbers_of_lines = code_lines(path)
        if not numbers_of_lines:
            continue
        number = numbers.choice(numbers_of_lines)
        changed = list(mutations_of(path.read_text(encoding="utf-8").splitlines()[number]))
        if changed:
            return path, number, numbers.choice(changed)


def executables(build, layer, room):
    """The test executables of a layer: first those of the room, then the small ones, which are built soonest."""
    found = [path for path in (build / "tests" / layer).rglob("*_test*")
             if path.is_file() and not path.suffix and path.stat().st_mode & 0o100]
    return sorted(found, key=lambda path: (room not in path.parent.parts and room not in path.name, path.stat().st_size))


def seen_by(build, layer, room, time_limit):
    """The suites of the first executable that fails; None where the mutant does not compile; empty where it lives."""
    for path in executables(build, layer, room):
        if subprocess.run(["ninja", "-C", build, path.relative_to(build)], capture_output=True, check=False).returncode:
            return None
        try:
            run = subprocess.run([path, "--gtest_brief=1"], capture_output=True, text=True, check=False, timeout=time_limit, errors="replace")
        except subprocess.TimeoutExpired:
            return [f"{path.name} does not end"]
        failed = sorted(set(re.findall(r"^\[  FAILED  \] (\w+)\.", run.stdout, re.MULTILINE)))
        if run.returncode:
            return failed or [f"{path.name} ends with {run.returncode}"]
    return []


def main(arguments):
    root, build = arguments.root.resolve(), arguments.build.resolve()
    if subprocess.run(["git", "-C", root, "status", "--porcelain"], capture_output=True, text=True, check=True).stdout:
        return f"{root}: has changes; mutants need a clean checkout"
    numbers = random.Random(arguments.seed)
    living = tried = 0
    while tried < arguments.count:
        path, number, changed = draw(root, numbers)
        text = path.read_text(encoding="utf-8")
        lines = text.split("\n")
        before, lines[number] = lines[number], changed
        started = time.monotonic()
        try:
            path.write_text("\n".join(lines), encoding="utf-8")
            seen = seen_by(build, *path.relative_to(root).parts[:2], arguments.time_limit)
        finally:
            path.write_text(text, encoding="utf-8")
        if seen is None:
            continue
        tried += 1
        living += not seen
        print(f"{path.relative_to(root)}:{number + 1}: {', '.join(seen) or 'LIVES'} ({time.monotonic() - started:.0f} s)\n"
              f"  - {before.strip()}\n  + {changed.strip()}", flush=True)
    print(f"{tried} mutants of seed {arguments.seed}: {tried - living} were seen, {living} live")
    return 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(usage="mutants.py ROOT BUILD [--seed N] [--count N] [--time-limit SECONDS]")
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--time-limit", type=float, default=600)
    sys.exit(main(parser.parse_args()))
