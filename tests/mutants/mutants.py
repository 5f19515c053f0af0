#!/usr/bin/python3
"""Breaks single lines of the product and reports which tests notice. A mutant that survives shows what no test of its layer protects.

usage: mutants.py ROOT [--seed N] [--count N] [--layer LAYER] [--time-limit SECONDS] [--survivors FILE]

Each mutant changes one operator, number or returned value in one code line. The seed draws a layer, then a folder of it, then a line. The
test programs of that layer are built and run until one fails; those of the same folder come first. A mutant that does not compile is drawn
again. The seed is today's date unless it is given, so that every night tries other lines and any night can be repeated.

The mutants are made in a worktree of their own, ROOT/build/mutants/tree, at the commit that is checked out in ROOT: whatever ends this
program, the files of ROOT stay as they are. Each survivor is appended to the list, ROOT/build/mutants/survivors.csv unless it is given.
"""

import argparse
import csv
import datetime
import pathlib
import random
import re
import shutil
import subprocess
import sys
import time

LAYERS = ("core", "experiments", "results", "analysis", "runners")
# What is exchanged, with the blanks that distinguish an operator from a template or an include.
EXCHANGES = [
    (r" < ", " <= "), (r" <= ", " < "), (r" > ", " >= "), (r" >= ", " > "), (r" == ", " != "), (r" != ", " == "),
    (r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "), (r" && ", " || "), (r" \|\| ", " && "),
    (r" \+= ", " -= "), (r" -= ", " += "), (r"\bstd::min\b", "std::max"), (r"\bstd::max\b", "std::min"),
    (r"\btrue\b", "false"), (r"\bfalse\b", "true"), (r"\bif \(", "if (!("), (r"\b0\.5\b", "0.6"), (r"\b2\.0\b", "2.1"), (r"\b1\.0\b", "1.1"),
]
NOT_CODE = re.compile(r"^\s*(//|#|namespace|using|template|static_assert|/?\*)|^\s*[\w\":,.()%{}-]*\"[^\"]*\",?$")
COLUMNS = ["date", "commit", "seed", "place", "before", "after"]


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


def folders_of(root, layer):
    """The folders of a layer that hold sources themselves."""
    return sorted({path.parent for path in (root / layer).rglob("*.cpp") if "node_modules" not in path.parts and path.parent != root / layer})


def draw(root, layers, numbers):
    """A path, the number of one of its lines, and the changed line."""
    while True:
        folder = numbers.choice(folders_of(root, numbers.choice(layers)))
        path = numbers.choice(sorted([*folder.glob("*.cpp"), *folder.glob("*.hpp")]))
        numbers_of_lines = code_lines(path)
        if not numbers_of_lines:
            continue
        number = numbers.choice(numbers_of_lines)
        changed = list(mutations_of(path.read_text(encoding="utf-8").splitlines()[number]))
        if changed:
            return path, number, numbers.choice(changed)


def test_programs(build, layer, folder):
    """The test programs of a layer: first those nearest to the folder of the mutant, then the small ones, which are built soonest."""
    targets = subprocess.run(["ninja", "-C", build, "-t", "targets", "all"], capture_output=True, text=True, check=True).stdout
    programs = sorted(set(re.findall(rf"^(tests/{layer}(?:/\w+)*/\w*_tests?): CXX_EXECUTABLE_LINKER", targets, re.MULTILINE)))

    def distance(program):
        shared = [one for one in folder.parts if one in pathlib.PurePath(program).parts or one in program.split("/")[-1]]
        path = build / program
        return -len(shared), path.stat().st_size if path.is_file() else 0

    return sorted(programs, key=distance)


def seen_by(build, layer, folder, time_limit):
    """The suites of the first program that fails; None where the mutant does not compile; empty where it survives."""
    for program in test_programs(build, layer, folder):
        if subprocess.run(["ninja", "-C", build, program], capture_output=True, check=False).returncode:
            return None
        try:
            run = subprocess.run([build / program, "--gtest_brief=1"], cwd=(build / program).parent, capture_output=True, text=True,
                                 check=False, timeout=time_limit, errors="replace")
        except subprocess.TimeoutExpired:
            return [f"{program} does not end"]
        failed = sorted(set(re.findall(r"^\[  FAILED  \] ([\w/]+)\.", run.stdout, re.MULTILINE)))
        if run.returncode:
            return failed or [f"{program} ends with {run.returncode}"]
    return []


def git(folder, *words):
    return subprocess.run(["git", "-C", folder, *words], capture_output=True, text=True, check=True).stdout.strip()


def worktree_of(root):
    """A fresh, configured worktree at the commit of ROOT. The objects of an earlier one stay, so that little is built again."""
    tree = root / "build/mutants/tree"
    if (tree / ".git").exists():
        git(tree, "checkout", "--quiet", "--force", "--detach", git(root, "rev-parse", "HEAD"))
    else:
        shutil.rmtree(tree, ignore_errors=True)
        git(root, "worktree", "prune")
        git(root, "worktree", "add", "--quiet", "--detach", tree, "HEAD")
    libraries = root / "analysis/report/node_modules"
    here = tree / "analysis/report/node_modules"
    if libraries.is_dir() and not here.exists():
        here.symlink_to(libraries)
    subprocess.run(["cmake", "--preset", "release"], cwd=tree, capture_output=True, check=True)
    return tree


def append(survivors, row):
    survivors.parent.mkdir(parents=True, exist_ok=True)
    is_new = not survivors.exists()
    with survivors.open("a", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        if is_new:
            writer.writeheader()
        writer.writerow(row)


def main(arguments):
    root = arguments.root.resolve()
    survivors = arguments.survivors or root / "build/mutants/survivors.csv"
    tree = worktree_of(root)
    build = tree / "build/release"
    numbers = random.Random(arguments.seed)
    surviving = tried = 0
    drawn = set()
    while tried < arguments.count:
        mutant = draw(tree, [arguments.layer] if arguments.layer else LAYERS, numbers)
        if mutant in drawn:
            continue
        drawn.add(mutant)
        path, number, changed = mutant
        place = path.relative_to(tree)
        text = path.read_text(encoding="utf-8")
        lines = text.split("\n")
        before, lines[number] = lines[number], changed
        started = time.monotonic()
        path.write_text("\n".join(lines), encoding="utf-8")
        try:
            seen = seen_by(build, place.parts[0], place.parent, arguments.time_limit)
        finally:
            path.write_text(text, encoding="utf-8")
        if seen is None:
            continue
        tried += 1
        surviving += not seen
        print(f"{place}:{number + 1}: {', '.join(seen) or 'SURVIVES'} ({time.monotonic() - started:.0f} s)\n"
              f"  - {before.strip()}\n  + {changed.strip()}", flush=True)
        if not seen:
            append(survivors, {"date": datetime.date.today().isoformat(), "commit": git(root, "rev-parse", "--short=12", "HEAD"),
                               "seed": arguments.seed, "place": f"{place}:{number + 1}", "before": before.strip(), "after": changed.strip()})
    print(f"{tried} mutants of seed {arguments.seed}: {tried - surviving} were noticed, {surviving} survive")
    return 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", type=pathlib.Path, help="a checkout of the project")
    parser.add_argument("--seed", type=int, default=int(datetime.date.today().strftime("%Y%m%d")), help="default: today's date, such as 20260131")
    parser.add_argument("--count", type=int, default=30, help="number of mutants that compile")
    parser.add_argument("--layer", choices=LAYERS, help="draw from this layer alone")
    parser.add_argument("--time-limit", type=float, default=600, help="seconds that a test program may run")
    parser.add_argument("--survivors", type=pathlib.Path, help="CSV file to which survivors are appended")
    sys.exit(main(parser.parse_args()))
