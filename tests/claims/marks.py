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
# What looks like a mark and is not one, so that it would be ignored.
MISSPELLED = re.compile(r"<!--(?! claim: [\w.+-]+ -->)\W*(?i:claim)\b.*?-->", re.DOTALL)
# The number goes on to the left of what stands before the mark, or to the right of the mark.
PART_BEFORE = re.compile(r"[\w.,−–±×·/-]$|\d $|\d to $|[±–] $")
PART_BEHIND = re.compile(r"[.,]?\d|[\[–]|to \d")
SKIPPED = {"node_modules", "build", "out", ".git"}


@dataclasses.dataclass
class Mark:
    """A mark, with the text before it and the rows that it may cover."""
    name: str
    page: str
    line: int
    before: str       # the paragraph, or the row of a table, up to the mark
    after: str        # a few characters of the text behind the mark
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
        yield Mark(match[1], page, text.count("\n", 0, match.start()) + 1, plain(text[start:match.start()]),
                   plain(text[match.end():match.end() + 12]), rows, begins_line)


def misspelled_marks(text):
    """Comments outside code that look like a mark and are not one."""
    return MISSPELLED.findall(CODE.sub("", text))


def pages_of(root):
    """The text of each page below `root`, by its path."""
    return {page.relative_to(root).as_posix(): page.read_text(encoding="utf-8") for page in sorted(root.rglob("*.md"))
            if not SKIPPED & set(page.relative_to(root).parts)}


def marks_of(root):
    """The marks of all pages."""
    return [mark for page, text in pages_of(root).items() for mark in marks_in(text, page)]


def rows_below(root, name, count):
    """The `count` rows of the table with the mark `name`, without its head."""
    rows = next((mark.rows[2:] for mark in marks_of(root) if mark.name == name), [])
    if len(rows) != count:
        raise SystemExit(f"the table with the mark {name} has {len(rows)} rows and not {count}")
    return rows


def follows(mark, number):
    """Whether the mark stands behind this whole number: nothing beside it makes it a longer number, a range or bounds."""
    rest = mark.before.removesuffix(number)
    return rest != mark.before and not PART_BEFORE.search(rest) and not PART_BEHIND.match(mark.after)


@dataclasses.dataclass
class Numbers:
    """Required numbers beside a mark; for each its notations, the complete one first. Empty: a command reads the page itself."""
    numbers: list
    is_row: bool = False
    pages: list = dataclasses.field(default_factory=list)  # pages that must have the mark, with the complete notation; others may have it


def difference(mark, claimed):
    """What is wrong beside the mark, or None."""
    if not claimed.numbers:
        return None
    if claimed.is_row:
        found = mark.rows[0][-len(claimed.numbers):] if mark.rows else []
        if len(found) == len(claimed.numbers) and all(cell == number[0] for cell, number in zip(found, claimed.numbers)):
            wrong_cell = not follows(mark, claimed.numbers[-1][0])
            return "it is not behind the last number of its row" if wrong_cell else None
        return f"the row ends in {' | '.join(found)}; claims.yaml has {' | '.join(number[0] for number in claimed.numbers)}"
    allowed = claimed.numbers[0][:1] if mark.page in claimed.pages else claimed.numbers[0]
    if any(follows(mark, number) for number in allowed):
        return None
    return f'it follows "…{mark.before[-30:]}" and stands before "{mark.after}…"; claims.yaml has {" or ".join(allowed)}'


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
