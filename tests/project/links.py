"""Every relative link of the documentation leads to a file that is there, and to a heading of it; the shipped studies that
a page names are there.

usage: links.py ROOT
"""

import pathlib
import re
import sys

FENCED = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)
SKIPPED = {"node_modules", "build", "out", ".git"}
COMMAND = re.compile(r"experiments/manifests/([\w-]+)\.yaml")


def anchor_of(heading):
    """The anchor that a reader of Markdown makes of a heading."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def anchors_of(page):
    return set(map(anchor_of, HEADING.findall(FENCED.sub("", page.read_text(encoding="utf-8")))))


def problems_of(root, page):
    text = page.read_text(encoding="utf-8")
    for link in LINK.findall(FENCED.sub("", text)):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        if not target.exists():
            yield f"{page.relative_to(root)}: {link}: there is no such file"
        elif anchor and anchor not in anchors_of(target):
            yield f"{page.relative_to(root)}: {link}: there is no such heading"
    for name in COMMAND.findall(text):
        if not (root / "experiments" / "manifests" / f"{name}.yaml").exists():
            yield f"{page.relative_to(root)}: {name}: there is no such shipped study"


def main(root):
    pages = [p for p in sorted(root.rglob("*.md")) if not SKIPPED & set(p.relative_to(root).parts)]
    problems = [problem for page in pages for problem in problems_of(root, page)]
    print("\n".join(problems) or f"{len(pages)} pages")
    return 1 if problems or not pages else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
