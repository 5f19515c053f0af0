"""The list of shipped studies in docs/studies.md, from the manifests, the pages and the claims.

usage: studies.py ROOT            fails where the page has another list, or no page answers a study
       studies.py ROOT --write    writes the list into the page

A study of which tests/claims/claims.yaml runs a result again has a row: the question of the manifest's first comment (its description where
that asks none), and the result. Others are links. Each leads to the first heading of docs that names the study, or to the one above a
table with it.
"""

import pathlib
import re
import sys
import textwrap

import yaml

from links import FENCED, HEADING, anchor_of

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from page_table import replace_table, table_in  # noqa: E402

PAGE = "docs/studies.md"


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


def lists(root):
    """The rows of the studies with a result, and the links of the others."""
    docs = root / "docs"
    pages = {page.relative_to(docs).as_posix(): FENCED.sub("", page.read_text(encoding="utf-8"))
             for page in sorted(docs.rglob("*.md")) if page != root / PAGE}
    claims = yaml.safe_load((root / "tests/claims/claims.yaml").read_text(encoding="utf-8"))["claims"]
    results = {claim["manifest"]: claim["result"] for claim in claims.values() if "result" in claim}
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
