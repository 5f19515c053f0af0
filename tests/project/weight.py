"""Prints the code lines of each folder of the product and of the tests, and the words of all pages.

usage: weight.py ROOT

A code line is neither blank nor only comment. The figures are for people who look for a room that has grown; nothing fails because of them.
"""

import pathlib
import re
import sys

LAYERS = ("core", "experiments", "results", "analysis", "runners", "tests")
CODE = {".cpp", ".hpp", ".h", ".js", ".py"}
GENERATED = {"runners/python/zerocount/answer_types.py"}
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


def code_lines(path):
    """Number of code lines of a file."""
    mark = "#" if path.suffix == ".py" else "//"
    text = COMMENT.sub(lambda found: "\n" * found.group().count("\n"), path.read_text(encoding="utf-8"))
    return sum(bool(line.strip()) and not line.strip().startswith(mark) for line in text.splitlines())


def sources(root, folder):
    """The sources of a folder and of the folders below it."""
    found = [path for path in sorted(folder.rglob("*")) if path.suffix in CODE and path.is_file()]
    return [path for path in found if "node_modules" not in path.parts and str(path.relative_to(root)) not in GENERATED]


def pages(root):
    """All pages of the tree."""
    for path in sorted(root.rglob("*.md")):
        if path.relative_to(root).parts[0] not in ("build", ".git") and "node_modules" not in path.parts:
            yield path


def main(root):
    for layer in LAYERS:
        total = 0
        for folder in sorted(path for path in (root / layer).iterdir() if path.is_dir()):
            lines = sum(map(code_lines, sources(root, folder)))
            total += lines
            if lines > 0:
                print(f"{lines:7d}  {folder.relative_to(root)}")
        print(f"{total:7d}  {layer}, code lines in all its folders\n")
    print(f"{sum(len(path.read_text(encoding='utf-8').split()) for path in pages(root)):7d}  words of all pages")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve())
