"""Lays the pages of the repository and those made from the program and its sources together, as Sphinx reads them.

usage: stage.py ROOT FOLDER PROGRAM

A page keeps its path, so that links between pages hold. What else it links to, such as a program, lies beside it.
"""

import os
import pathlib
import re
import shutil
import sys

import code_pages
import notebook_page
import program_pages

SKIPPED = {"node_modules", "build", "out", ".git", ".github", "site"}
HERE = pathlib.Path(__file__).parent
LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\])\(([^)\s]+)\)")
FENCED = re.compile(r"(^```.*?^```$)", re.MULTILINE | re.DOTALL)


def pages_of(root):
    for pattern in ("*.md", "*.ipynb"):
        yield from (path for path in sorted(root.rglob(pattern)) if not SKIPPED & set(path.relative_to(root).parts))


class Links:
    """Changes the links of a page for those that lead to no page."""

    def __init__(self, root, folder, page):
        self.root, self.folder, self.page = root, folder, page

    def __call__(self, match):
        text, link = match[1], match[2]
        path, hash_, anchor = link.partition("#")
        if re.match(r"[a-z]+:", link) or not path or path.endswith(".md"):
            return match[0]
        target = (self.page.parent / path).resolve()
        if not target.exists():  # such as a picture of a notebook, which lies there already
            return match[0]
        if target.suffix == ".ipynb":
            return f"{text}({path.removesuffix('.ipynb')}.md{hash_}{anchor})"
        if target.is_dir():
            readme = target / "README.md"
            return f"{text}({os.path.relpath(readme, self.page.parent)})" if readme.exists() else text[1:-1]
        place = self.folder / target.relative_to(self.root)
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(target, place)
        return match[0] if place.suffix else f"{text}({path})"


def staged(text, links):
    parts = FENCED.split(text)
    return "".join(part if part.startswith("```") else LINK.sub(links, part) for part in parts)


def main(root, folder, program):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for page in pages_of(root):
        place = folder / page.relative_to(root).with_suffix(".md")
        place.parent.mkdir(parents=True, exist_ok=True)
        notebook = page.suffix == ".ipynb"
        text = notebook_page.page(page, place.parent) if notebook else page.read_text(encoding="utf-8")
        place.write_text(staged(text, Links(root, folder, page)), encoding="utf-8")
    for page in HERE.glob("*.md"):
        shutil.copyfile(page, folder / page.name)
    program_pages.write(folder / "reference", program_pages.Program(program))
    code_pages.write(folder / "reference", root)
    (folder / "Doxyfile").write_text(code_pages.doxygen_settings(root, folder.parent / "doxygen"), encoding="utf-8")


if __name__ == "__main__":
    main(*(pathlib.Path(word).resolve() for word in sys.argv[1:4]))
