"""The list of shipped studies in docs/studies.md, from the manifests and the pages.

usage: studies.py ROOT            fails where the page has another list, or no page answers a study
       studies.py ROOT --write    writes the list into the page

A study with a result has a row: a link, the question of the manifest's first comment (its description where that asks none), and the
result, which is written in the page. It states a number that is a claim of the study (tests/claims/marks.py), so that it is simulated again.
Others are links. Each leads to the first heading of docs that names the study, or to the one above a table with it. To give a study a row,
add `| [`NAME`]() | | RESULT |`.
"""

import pathlib
import re
import sys
import textwrap

import yaml

from links import FENCED, HEADING, anchor_of

sys.path += [str(pathlib.Path(__file__).resolve().parents[1] / folder) for folder in ("support", "claims")]
from marks import MARK  # noqa: E402
from page_table import replace_table, table_in  # noqa: E402

PAGE = "docs/studies.md"
ROW = re.compile(r"^\| \[`([\w-]+)`\]\([^)]*\) \|.*\| (.*?) *\|\s*$", re.MULTILINE)


def question_of(text, manifest):
    """The question in the first paragraph of the manifest's comment, or its description."""
    comment = re.match(r"(?:# .*\n)*", text)[0].replace("# ", "").replace("\n", " ")
    asked = re.match(r"[^.?]*(?:\.\d[^.?]*)*\?", comment)
    return asked[0] if asked else manifest["description"]


def answering_place(pages, name):
    """The heading that names the study, or the one above its row of a table: page and anchor."""
    named = f"`{name}`"
    for page, text in pages.items():
        for heading in HEADING.findall(text):
            if named in heading:
                return f"{page}#{anchor_of(heading)}"
    for page, text in pages.items():
        before, row, _ = text.partition(f"\n| {named} |")
        if row:
            return f"{page}#{anchor_of(HEADING.findall(before)[-1])}"
    return None


def claimed_studies(root):
    """The study of which each mark states a number."""
    claims = yaml.safe_load((root / "tests/claims/claims.yaml").read_text(encoding="utf-8"))["claims"]
    return {value[kind]: claim["manifest"] for claim in claims.values() for check in claim["checks"] for value in check["values"]
            for kind in ("mark", "row") if kind in value}


def results_of(root):
    """The result of each study that has one in the page."""
    studies = claimed_studies(root)
    table = table_in(root / PAGE, "studies")
    results = dict(ROW.findall(table))
    rows = [line for line in table.splitlines() if line.startswith("| [")]
    if len(rows) != len(results):  # a row that is not read would be replaced by a link
        sys.exit(f"{PAGE}: {len(rows)} rows, of which {len(results)} are like | [`NAME`](LINK) | QUESTION | RESULT |")
    for name, result in results.items():
        marks = [mark if mark in studies else mark.rpartition(".")[0] for mark in MARK.findall(result)]
        if name not in [studies.get(mark) for mark in marks]:
            sys.exit(f"{PAGE}: {name}: its result has no number with the mark of a claim about this study (tests/claims)")
    return results


def lists(root):
    """The rows of the studies with a result, and the links of the others."""
    docs = root / "docs"
    pages = {page.relative_to(docs).as_posix(): FENCED.sub("", page.read_text(encoding="utf-8"))
             for page in sorted(docs.rglob("*.md")) if page != root / PAGE}
    results = results_of(root)
    rows, links = [], []
    for path in sorted((root / "experiments/manifests").glob("*.yaml")):
        text = path.read_text(encoding="utf-8")
        place = answering_place(pages, path.stem)
        if place is None:
            sys.exit(f"{path.relative_to(root)}: no heading and no table of docs names it")
        link = f"[`{path.stem}`]({place})"
        if path.stem in results:
            rows.append(f"| {link} | {question_of(text, yaml.safe_load(text))} | {results[path.stem]} |")
        else:
            links.append(link)
    return rows, links


def table(root):
    """The list as Markdown."""
    rows, links = lists(root)
    others = textwrap.fill(f"Others: {', '.join(links)}.", 150, break_long_words=False, break_on_hyphens=False)
    return "\n".join(["| study | question | result |\n| --- | --- | --- |", *rows, "", others, ""])


def main(root, write):
    page = root / PAGE
    if write:
        replace_table(page, "studies", table(root))
    elif table_in(page, "studies") != table(root):
        sys.exit(f"{PAGE}: the list of studies is out of date; run tests/project/studies.py . --write")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), "--write" in sys.argv[2:])
