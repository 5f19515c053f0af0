"""The code and its pages stay light: no room has more code lines than its row of weight.json.

usage: weight.py ROOT [--write]

A code line is neither blank nor only comment. A row fails where more is counted than its `most`, and where 5 % less is, until the row
is lowered: --write lowers what it can, and raises nothing. A feature that needs more room raises its row by hand, and its commit says
what the added lines are worth. Counted are the rooms of the product (folders, in the order of docs and data flow) and of the tests, the
command of each verb with its answer, the rows of CONTRIBUTING's "To add", the words of all pages, files with few code lines, and the
folders of analysis and runners that name a dimension of a study, which claims and samples should do for all.
"""

import json
import pathlib
import re
import sys

LAYERS = ("core", "experiments", "results", "analysis", "runners")
CODE = {".cpp", ".hpp", ".h", ".js"}
GENERATED = {"runners/python/zerocount/answer_types.py"}
SLACK = 0.05  # a row that is this much above what is counted is to be lowered
FEW_LINES = 30
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
DIMENSIONS = ("condition", "world", "age")


def code_of(path):
    """The code lines of a file, without comments that have a line of their own."""
    mark = "#" if path.suffix == ".py" else "//"
    text = COMMENT.sub(lambda found: "\n" * found.group().count("\n"), path.read_text(encoding="utf-8"))
    return [line for line in text.splitlines() if line.strip() and not line.strip().startswith(mark)]


def sources(root, folder, suffixes=CODE):
    """The sources of a folder and of those below it."""
    found = [path for path in sorted((root / folder).rglob("*")) if path.suffix in suffixes and path.is_file()]
    return [path for path in found if "node_modules" not in path.parts and str(path.relative_to(root)) not in GENERATED]


def lines_of(paths):
    return sum(len(code_of(path)) for path in paths)


def counted_rooms(root, rows):
    """[room] the code lines of its folders; every folder of the product is in one room."""
    counted = {name: lines_of(path for folder in row["folders"] for path in sources(root, folder)) for name, row in rows.items()}
    in_rooms = {folder for row in rows.values() for folder in row["folders"]}
    homeless = [f"{layer}/{folder.name}" for layer in LAYERS for folder in sorted((root / layer).iterdir())
                if folder.is_dir() and sources(root, f"{layer}/{folder.name}") and f"{layer}/{folder.name}" not in in_rooms]
    return counted, [f"{folder} is in no room of weight.json" for folder in homeless]


def counted_verbs(root, rows):
    """[verb] the code lines of its command and its answer."""
    problems = []
    for verb, row in rows.items():
        problems += [f"{verb}: there is no {file}" for file in row["files"] if not list(root.glob(file))]
    return {verb: lines_of(path for file in row["files"] for path in sorted(root.glob(file)) if path.suffix in CODE)
            for verb, row in rows.items()}, problems


def rows_to_add(root):
    """The rows of the table "To add" of CONTRIBUTING."""
    section = (root / "CONTRIBUTING.md").read_text(encoding="utf-8").split("## To add", 1)[1].split("\n## ", 1)[0]
    return len([line for line in section.splitlines() if line.startswith("|")]) - 2


def pages(root):
    for path in sorted(root.rglob("*.md")):
        parts = path.relative_to(root).parts
        if parts[0] not in ("build", ".git") and "node_modules" not in parts:
            yield path


def folders_that_name(root, dimension):
    """The folders of analysis and runners whose code names a dimension, as a word or a part of a name."""
    word = re.compile(rf"(?<![a-z]){dimension}s?(?![a-z])", re.IGNORECASE)
    return {str(path.parent.relative_to(root)) for layer in ("analysis", "runners") for path in sources(root, layer)
            if any(word.search(line) for line in code_of(path))}


def totals(root):
    product = [path for layer in LAYERS for path in sources(root, layer)]
    counted = {
        "code lines of the product": lines_of(product),
        "code lines of the tests": lines_of(sources(root, "tests")),
        "code lines of the judges written in Python": lines_of(sources(root, "tests", {".py"})),
        "files with fewer than 30 code lines": sum(len(code_of(path)) < FEW_LINES for path in product),
        "rows of To add": rows_to_add(root),
        "words of all pages": sum(len(path.read_text(encoding="utf-8").split()) for path in pages(root)),
    }
    for dimension in DIMENSIONS:
        counted[f"folders of analysis and runners that name {dimension}"] = len(folders_that_name(root, dimension))
    return counted


def judged(rows, counted, write):
    """A line for each row that fails. @param write lowers the rows."""
    for name, number in counted.items():
        row = rows[name]
        if number > row["most"]:
            yield f"{name}: {number}, and {row['most']} is the most"
        elif number < (1.0 - SLACK) * row["most"]:
            if write:
                row["most"] = number
            else:
                yield f"{name}: {number} is more than 5 % below {row['most']}: lower the row (weight.py . --write)"


def main(root, write):
    file = root / "tests/project/weight.json"
    table = json.loads(file.read_text(encoding="utf-8"))
    rooms, problems = counted_rooms(root, table["rooms"])
    verbs, missing = counted_verbs(root, table["verbs"])
    problems += missing
    for name, counted in (("rooms", rooms), ("verbs", verbs), ("totals", totals(root))):
        problems += judged(table[name], counted, write)
        for row, number in counted.items():
            print(f"{number:7d} of {table[name][row]['most']:7d}  {row}")
    if write:
        file.write_text(json.dumps(table, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), "--write" in sys.argv[2:]))
