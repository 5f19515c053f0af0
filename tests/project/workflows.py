"""The workflows of continuous integration parse, and call only what ./quickstart knows.

usage: workflows.py ROOT
"""

import itertools
import pathlib
import re
import subprocess
import sys

import yaml


def lines_of(job):
    """The shell lines of a job, for each combination of its matrix."""
    matrix = job.get("strategy", {}).get("matrix", {})
    for values in itertools.product(*matrix.values()):
        for step in job["steps"]:
            text = step.get("run", "")
            for name, value in zip(matrix, values):
                text = text.replace("${{ matrix.%s }}" % name, str(value))
            yield from text.splitlines()


def problems(workflow, known):
    called = 0
    for name, job in yaml.safe_load(workflow.read_text(encoding="utf-8"))["jobs"].items():
        if "timeout-minutes" not in job:
            yield f"{workflow.name}: {name}: has no time limit"
        for words in (line.split() for line in lines_of(job)):
            if not words or words[0] != "./quickstart":
                continue
            called += 1
            if " ".join(words) not in known:
                yield f"{workflow.name}: {name}: {' '.join(words)}: quickstart does not know it"
    if not called:
        yield f"{workflow.name}: does not call quickstart"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    usage = subprocess.run([root / "quickstart", "--help"], capture_output=True, text=True, check=True).stdout
    known = set(re.findall(r"\./quickstart(?: \w+)?", usage))
    workflows = sorted((root / ".github/workflows").glob("*.yml"))
    found = [problem for workflow in workflows for problem in problems(workflow, known)]
    print("\n".join(found) or f"{len(workflows)} workflows call what there is")
    return 1 if found or not workflows else 0


if __name__ == "__main__":
    sys.exit(main())
