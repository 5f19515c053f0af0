"""The CI examples parse, and every script, option and path that they name exists.

usage: judge_ci_examples.py REPOSITORY
"""

import pathlib
import re
import shlex
import subprocess
import sys

import yaml

EXAMPLES = ["ci-workflow.yaml", "gitlab-ci.yaml"]


def commands_of(tree):
    """The shell lines of a workflow or pipeline: the values of `run`, and the items of `script`."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            if key == "run":
                yield from value.splitlines()
            elif key == "script":
                yield from value
            else:
                yield from commands_of(value)
    elif isinstance(tree, list):
        for value in tree:
            yield from commands_of(value)


def calls_of(line):
    """The words of each command of a line."""
    return [shlex.split(part) for part in re.split(r"&&|\|\||;|\|", line)]


def problems(root, example):
    tree = yaml.safe_load((root / "runners/nightly" / example).read_text(encoding="utf-8"))
    nightly = 0
    for line in commands_of(tree):
        for words in calls_of(line):
            if not words or "/" not in words[0]:
                continue
            program = root / words[0]
            if not program.is_file():
                yield f"{example}: {words[0]} does not exist"
                continue
            if program.name != "nightly":
                continue
            nightly += 1
            usage = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
            known = set(re.findall(r"--[a-z-]+", usage))
            yield from (f"{example}: nightly has no {word}" for word in words if word.startswith("--") and word not in known)
    if nightly != 1:
        yield f"{example}: calls runners/nightly/nightly {nightly} times; expected once"
    text = yaml.safe_dump(tree)
    for kept in ("history", "out/nightly"):
        if kept not in text:
            yield f"{example}: does not keep {kept}"


def main():
    root = pathlib.Path(sys.argv[1])
    found = [problem for example in EXAMPLES for problem in problems(root, example)]
    print("\n".join(found) or "the CI examples name what exists")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
