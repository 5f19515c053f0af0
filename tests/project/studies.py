"""The table of shipped studies, docs/studies.md: generated from the manifests, the pages and the claims.

    studies.py ROOT            fails where the table is not up to date, or where no page answers a study
    studies.py ROOT --write    writes it

A row has the question of the manifest's first comment (its description where that asks none), the size, and the results that
tests/claims/claims.yaml runs again. It leads to the first heading of docs that names the study, or to the one above a table with it.
"""

import math
import pathlib
import re
import sys

import yaml

from links import FENCED, HEADING, anchor_of

PAGE = "docs/studies.md"
TABLE = re.compile(r"(?<=<!-- studies: written by tests/project/studies.py -->\n).*(?=<!-- end of studies -->)", re.DOTALL)


def question_of(text, manifest):
    """The question in the first paragraph of the manifest's comment, or its description."""
    comment = re.match(r"(?:# .*\n)*", text)[0].replace("# ", "").replace("\n", " ")
    asked = re.match(r"[^.?]*(?:\.\d[^.?]*)*\?", comment)
    return asked[0] if asked else manifest["description"]


def count_of(values):
    """How many values a key of the grid has: those of a list, or the n of {linspace: [a, b, n]}."""
    return len(values) if isinstance(values, list) else next(iter(values.values()))[2]


def points_of(manifest):
    sweep = manifest.get("sweep", {})
    return max(1, len(sweep.get("cases", {}))) * math.prod(map(count_of, sweep.get("grid", {}).values()))


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


def rows(root):
    docs = root / "docs"
    pages = {page.relative_to(docs).as_posix(): FENCED.sub("", page.read_text(encoding="utf-8"))
             for page in sorted(docs.rglob("*.md")) if page != root / PAGE}
    claims = yaml.safe_load((root / "tests/claims/claims.yaml").read_text(encoding="utf-8"))["claims"]
    results = {claim["manifest"]: claim["result"] for claim in claims.values() if "result" in claim}
    for path in sorted((root / "experiments/manifests").glob("*.yaml")):
        text = path.read_text(encoding="utf-8")
        manifest = yaml.safe_load(text)
        place = answering_place(pages, path.stem)
        if place is None:
            sys.exit(f"{path.relative_to(root)}: no heading and no table of docs names it")
        yield (f"| [`{path.stem}`]({place}) | {question_of(text, manifest)} | {points_of(manifest)} × {manifest['trials']} | "
               f"{results.get(path.stem, '')} |")


def main(root, options):
    head = ["| study | question | points × trials | result |", "| --- | --- | --: | --- |"]
    page = root / PAGE
    text = page.read_text(encoding="utf-8")
    table = "\n".join([*head, *rows(root), ""])
    if "--write" in options:
        page.write_text(TABLE.sub(lambda _: table, text), encoding="utf-8")
    elif table not in text:
        print(f"{PAGE} is not up to date: run tests/project/studies.py . --write")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]))
