"""The site builds without a warning; its links lead somewhere, nothing is fetched from elsewhere, and three clicks reach every page.

usage: whole_site.py ROOT BUILD PROGRAM
"""

import html.parser
import pathlib
import re
import subprocess
import sys
import urllib.parse

CLICKS = 3
FETCHED = {"img": "src", "script": "src", "link": "href", "iframe": "src", "source": "src"}
OWN_PAGES = {"genindex.html", "search.html", "py-modindex.html"}  # of Sphinx: the sidebar and the search lead there


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.path, self.links, self.fetched, self.anchors = path, [], [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        self.anchors.update(filter(None, (named.get("id"), named.get("name"))))
        if tag == "a" and named.get("href"):
            self.links.append(named["href"])
        if named.get(FETCHED.get(tag)) and named.get("rel") not in ("canonical",):
            self.fetched.append(named[FETCHED[tag]])


def is_outside(link):
    return bool(re.match(r"[a-z]+:|//", link))


def target_of(page, link):
    """The file and the anchor that a link leads to."""
    path, _, anchor = link.partition("#")
    path = urllib.parse.unquote(path.partition("?")[0])
    return (page.path.parent / path).resolve() if path else page.path, urllib.parse.unquote(anchor)


def problems(root, pages):
    for page in pages.values():
        name = page.path.relative_to(root)
        for link in page.links + page.fetched:
            if is_outside(link):
                if link in page.fetched and not link.startswith("data:"):
                    yield f"{name}: fetches {link}"
                continue
            target, anchor = target_of(page, link)
            if not target.is_file():
                yield f"{name}: {link}: there is no such file"
            elif anchor and target in pages and anchor not in pages[target].anchors:
                yield f"{name}: {link}: there is no such place"


def reached(root, pages):
    """The pages within some clicks of the first one."""
    found = newest = {root / "index.html"}
    for _ in range(CLICKS):
        newest = {target_of(pages[path], link)[0] for path in newest for link in pages[path].links if not is_outside(link)}
        newest = (newest & pages.keys()) - found
        found = found | newest
    return found


def main():
    source, build, program = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    built = subprocess.run([source / "docs/site/make", program, build, build / "html"], capture_output=True, text=True, check=False)
    if built.returncode != 0:
        raise SystemExit(f"docs/site/make: exit code {built.returncode}\n{built.stdout[-3000:]}{built.stderr[-3000:]}")
    root = build / "html"
    pages = {path: Page(path) for path in root.rglob("*.html")}
    found = list(problems(root, pages))
    far = [path.relative_to(root).as_posix() for path in sorted(pages.keys() - reached(root, pages))]
    found += [f"{name}: more than {CLICKS} clicks from the first page" for name in far if name not in OWN_PAGES]
    print("\n".join(found) or f"{len(pages)} pages")
    return 1 if found or len(pages) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
