"""The marks of claimed numbers in pages: "<!-- claim: NAME -->", which a rendered page does not show.

- In text and in a cell of a table, a mark follows a number, which may have bounds or be a range: 56.4 [55.0, 57.8], 33 to 39.
- The mark of a row stands in the last cell of a row of a table, behind its number. It covers as many of the last cells as the claim has
  numbers. NAME.2 is the second of them, where text repeats it.
- The mark of a table stands in a line of its own above it, and covers all of it.

Marks in code are examples. The words around a number mean nothing here.
"""
import dataclasses
import itertools
import re

MARK = re.compile(r"<!-- claim: ([\w.+-]+) -->")
CODE = re.compile(r"^```.*?^```$|`[^`\n]*`", re.MULTILINE | re.DOTALL)
SKIPPED = {"node_modules", "build", "out", ".git"}


@dataclasses.dataclass
class Mark:
    """A mark, with the text before it and the rows that it may cover."""
    name: str
    page: str
    line: int
    before: str       # the paragraph, or the row of a table, up to the mark
    rows: list        # the cells of the row that has the mark, or of the rows below it; empty in text
    begins_line: bool  # whether nothing stands before it in its line


def plain(text):
    """The text without marks, emphasis and line breaks."""
    return re.sub(r"\s+", " ", MARK.sub("", text).replace("**", "")).strip()


def cells_of(line):
    """The cells of a row of a table, without marks."""
    return [plain(cell) for cell in line.strip().strip("|").split("|")]


def marks_in(text, page=""):
    """All marks of a page, in order."""
    text = CODE.sub(lambda code: code[0].replace("<!-- claim:", "<!-- in code:"), text)
    for match in MARK.finditer(text):
        start = text.rfind("\n", 0, match.start()) + 1
        line, *below = text[start:].split("\n")
        rows, begins_line = [], not text[start:match.start()].strip()
        if line.startswith("|"):
            rows = [cells_of(line)]
        elif line.strip() == match[0]:
            rows = [cells_of(row) for row in itertools.takewhile(lambda row: row.startswith("|"), below)]
        else:
            start = text.rfind("\n\n", 0, match.start()) + 1
        yield Mark(match[1], page, text.count("\n", 0, match.start()) + 1, plain(text[start:match.start()]), rows, begins_line)


def pages_of(root):
    """The text of each page below `root`, by its path."""
    return {page.relative_to(root).as_posix(): page.read_text(encoding="utf-8") for page in sorted(root.rglob("*.md"))
            if not SKIPPED & set(page.relative_to(root).parts)}


def marks_of(root):
    """The marks of all pages."""
    return [mark for page, text in pages_of(root).items() for mark in marks_in(text, page)]


def rows_below(root, name):
    """The rows of the table with the mark `name`, without its head."""
    for mark in marks_of(root):
        if mark.name == name and len(mark.rows) > 2:
            return mark.rows[2:]
    raise SystemExit(f"no table has the mark {name}")


def follows(mark, number):
    """Whether the mark follows this number, and not a longer one that ends like it."""
    rest = mark.before.removesuffix(number)
    return rest != mark.before and not re.search(r"[\d.,−-]$|\d $", rest)


@dataclasses.dataclass
class Numbers:
    """What must stand beside the marks of a claim: for each number its notations. Without numbers a command reads the page."""
    numbers: list
    is_row: bool = False
    pages: list = dataclasses.field(default_factory=list)  # where a mark must be; elsewhere it may be


def difference(mark, claimed):
    """What is wrong beside the mark, or None."""
    if not claimed.numbers:
        return None
    if claimed.is_row:
        found = mark.rows[0][-len(claimed.numbers):] if mark.rows else []
        if len(found) == len(claimed.numbers) and all(cell == number[0] for cell, number in zip(found, claimed.numbers)):
            return None
        return f"the row ends in {' | '.join(found)}; claims.yaml has {' | '.join(number[0] for number in claimed.numbers)}"
    if any(follows(mark, number) for number in claimed.numbers[0]):
        return None
    return f'it follows "…{mark.before[-30:]}"; claims.yaml has {" or ".join(claimed.numbers[0])}'


def problems(marks, claims):
    """Marks without a claim, claims without a mark, and other numbers beside a mark; `claims` has Numbers by name."""
    marks = list(marks)
    for mark in marks:
        place = f"{mark.page}:{mark.line}: {mark.name}"
        row, _, place_in_row = mark.name.rpartition(".")
        if mark.begins_line and not mark.rows:
            wrong = "it begins a line, which ends the paragraph in Markdown; put it behind its number"
        elif mark.name in claims:
            wrong = difference(mark, claims[mark.name])
        elif row in claims and claims[row].is_row and place_in_row.isdigit() and 1 <= int(place_in_row) <= len(claims[row].numbers):
            wrong = difference(mark, Numbers([claims[row].numbers[int(place_in_row) - 1]]))
        else:
            wrong = "claims.yaml has no such claim"
        if wrong:
            yield f"{place}: {wrong}"
    for name, claimed in claims.items():
        marked = {mark.page for mark in marks if mark.name == name}
        if not marked:
            yield f"{name}: no page has this mark"
        for page in claimed.pages:
            if marked and page not in marked:
                yield f"{name}: {page} lacks this mark"
