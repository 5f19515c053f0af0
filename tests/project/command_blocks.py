"""Every block of commands in the pages is run by a test, or says why not; commands and options of the program in it are there.

usage: command_blocks.py ROOT PROGRAM

The line before a block says it, in a comment that readers do not see: `run` (here, in a folder with the first study of the README as
study.yaml, with few trials, and its results study.h5), `run by FILE`, a test of the repository, or `not run: WHY`.
"""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

SKIPPED = {"node_modules", "build", "out", ".git"}
MARK = re.compile(r"<!-- (run|run by \S+|not run: [^\n]+) -->\n+\Z")
FENCED = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"(?:(?<=\n\n)|(?<=-->\n))(?:    \S.*\n)+")
COMMAND = re.compile(r"(\./quickstart|cmake|ctest|zerocount|python3|sqlite3|taskset|[\w/.-]+/(zerocount|[a-z]+_tests?|pip))\s|\w+=\S+ python3")
STUDY = re.compile(r"^zerocount: 1\b.*?(?=^```$)", re.MULTILINE | re.DOTALL)
PATIENCE = 60  # s


def blocks_of(text):
    """(text before it, its commands) of each block of commands."""
    for match in FENCED.finditer(text):
        if match[1] in ("sh", "bash", "console"):
            yield text[:match.start()], match[2]
    without = FENCED.sub(lambda match: re.sub(r"[^\n]", "x", match[0]), text)
    for match in INDENTED.finditer(without):
        if COMMAND.match(match[0].strip()):
            yield text[:match.start()], re.sub(r"^    ", "", text[match.start():match.end()], flags=re.MULTILINE)


class Program:
    def __init__(self, path):
        self.path, self.helps = path, {}

    def options(self, command):
        """The options of a command, or nothing where there is no such command."""
        if command not in self.helps:
            ended = subprocess.run([self.path, command, "--help"], capture_output=True, text=True, check=False)
            self.helps[command] = set(re.findall(r"--[\w-]+", ended.stdout)) if ended.returncode == 0 else None
        return self.helps[command]

    def unknown(self, block):
        """Commands and options in a block that the program does not have."""
        for line in block.replace("\\\n", " ").splitlines():
            words = shlex.split(line, comments=True)
            if len(words) < 2 or not re.fullmatch(r"(\S+/)?zerocount", words[0]):
                continue
            known = self.options(words[1])
            if known is None:
                yield f"zerocount {words[1]}"
            yield from (f"zerocount {words[1]} {word}" for word in words[2:]
                        if word.startswith("--") and known is not None and word.partition("=")[0] not in known)


def prepared(root, program, folder):
    (folder / "build/release").mkdir(parents=True)
    (folder / "build/release/zerocount").symlink_to(program)
    for name in ("examples", "experiments"):
        (folder / name).symlink_to(root / name)
    study = STUDY.search((root / "README.md").read_text(encoding="utf-8"))[0]
    (folder / "study.yaml").write_text(study.replace("machines: 1000", "machines: 4").replace("trials: 2000", "trials: 8"), encoding="utf-8")
    subprocess.run([program, "run", "study.yaml", "-q", "-o", "study.h5"], cwd=folder, check=True)


def failure_of(root, program, before, block):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepared(root, program, folder)
        path = f"{folder}/build/release:{os.environ['PATH']}"
        ended = subprocess.run(["bash", "-euc", block], cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True,
                               timeout=PATIENCE, check=False)
        return None if ended.returncode == 0 else f"{before}: exit code {ended.returncode}\n{block}\n{ended.stdout[-800:]}{ended.stderr[-800:]}"


def problems_of(root, program, page):
    name = page.relative_to(root)
    for before, block in blocks_of(page.read_text(encoding="utf-8")):
        place = f"{name}:{before.count(chr(10)) + 1}"
        yield from (f"{place}: {word}: the program does not have it" for word in program.unknown(block))
        mark = MARK.search(before)
        if not mark:
            yield f"{place}: neither run nor marked: {block.splitlines()[0]}"
        elif mark[1].startswith("run by ") and not (root / mark[1].removeprefix("run by ")).exists():
            yield f"{place}: {mark[1]}: there is no such test"
        elif mark[1] == "run" and (failed := failure_of(root, program.path, place, block)):
            yield failed


def main():
    root, path = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    program = Program(path)
    pages = [page for page in sorted(root.rglob("*.md")) if not SKIPPED & set(page.relative_to(root).parts)]
    found = [problem for page in pages for problem in problems_of(root, program, page)]
    count = sum(len(list(blocks_of(page.read_text(encoding="utf-8")))) for page in pages)
    print("\n".join(found) or f"{count} blocks")
    return 1 if found or count < 30 else 0


if __name__ == "__main__":
    sys.exit(main())
