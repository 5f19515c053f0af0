"""The workflows of continuous integration parse, and call only what ./quickstart knows; the container for development has the
programs of its extensions, and hooks have stages of their present names.

usage: workflows.py ROOT
"""

import itertools
import json
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


# The Debian packages without which an extension of the editor does nothing.
PROGRAMS = {"ms-vscode.cmake-tools": {"cmake", "g++", "ninja-build"}, "llvm-vs-code-extensions.vscode-clangd": {"clangd"},
            "ms-python.python": {"python3"}}


def problems_of_container(root):
    container = json.loads((root / ".devcontainer/devcontainer.json").read_text(encoding="utf-8"))
    command = container["onCreateCommand"]
    installed = set(re.findall(r"[\w.+-]+", command))
    if "./quickstart install" in command:
        installed |= set(re.findall(r"[\w.+-]+", (root / "quickstart").read_text(encoding="utf-8").partition("\nusage()")[0]))
    for extension in container["customizations"]["vscode"]["extensions"]:
        missing = PROGRAMS.get(extension, {"a row of PROGRAMS"}) - installed
        if missing:
            yield f"devcontainer.json: {extension}: needs {', '.join(sorted(missing))}"


def problems_of_hooks(root):
    hooks = yaml.safe_load((root / ".pre-commit-config.yaml").read_text(encoding="utf-8"))
    known = {"pre-commit", "pre-push", "manual"}
    stages = [hooks.get("default_stages", []), *(hook.get("stages", []) for repo in hooks["repos"] for hook in repo["hooks"])]
    for stage in sorted({name for names in stages for name in names} - known):
        yield f".pre-commit-config.yaml: {stage}: no stage, or one of an earlier name"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    usage = subprocess.run([root / "quickstart", "--help"], capture_output=True, text=True, check=True).stdout
    known = set(re.findall(r"\./quickstart(?: \w+)?", usage))
    workflows = sorted((root / ".github/workflows").glob("*.yml"))
    found = [problem for workflow in workflows for problem in problems(workflow, known)]
    found += [*problems_of_container(root), *problems_of_hooks(root)]
    print("\n".join(found) or f"{len(workflows)} workflows call what there is")
    return 1 if found or not workflows else 0


if __name__ == "__main__":
    sys.exit(main())
