"""The site: what stage.py lays together, as pages. `./quickstart docs` calls it."""

import json
import os
import pathlib
import re
import sys

from pygments.lexers.special import TextLexer
from sphinx.highlighting import lexers

REPOSITORY = pathlib.Path(os.environ["ZEROCOUNT_REPOSITORY"])
sys.path.insert(0, str(REPOSITORY / "runners/python"))

project = "zerocount"
author = "the authors of zerocount"
copyright = author
html_title = "zerocount"
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx.ext.autosummary", "numpydoc"]

myst_heading_anchors = 4  # as links of the pages name them
smartquotes = False  # options have two dashes
myst_enable_extensions = ["deflist", "attrs_image"]
suppress_warnings = ["myst.header"]  # generated sections of schemas start below the heading of the page

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # numpydoc has them
numpydoc_show_class_members = False

breathe_projects = {"zerocount": os.environ["ZEROCOUNT_DOXYGEN"]}
breathe_default_project = "zerocount"
breathe_default_members = ("members", "undoc-members")
breathe_domain_by_extension = {"h": "c", "hpp": "cpp"}

html_theme = "furo"


def like_reports(mode):
    """The variables of furo for the colours and fonts of the reports that the program writes."""
    colours = json.loads((REPOSITORY / "analysis/report/colours.json").read_text())[mode]
    style = (REPOSITORY / "analysis/report/page.css").read_text()
    names = {
        "paper": ["background-primary"],
        "panel": ["background-secondary", "background-hover", "code-background", "admonition-background", "card-background"],
        "rule": ["background-border", "background-item", "foreground-border"],
        "ink": ["foreground-primary", "code-foreground", "api-keyword"],
        "muted": ["foreground-secondary", "foreground-muted"],
        "link": ["brand-primary", "brand-content"],
        "bad": ["problematic"],
    }
    variables = {f"color-{name}": colours[f"--{its}"] for its, all_names in names.items() for name in all_names}
    fonts = {"font-stack": r"^body\{.*?font:\S+ ([^;}]*)", "font-stack--monospace": r"^pre\{.*?font:\S+ ([^;}]*)"}
    return variables | {name: re.search(place, style, re.MULTILINE)[1] for name, place in fonts.items()}


html_theme_options = {"light_css_variables": like_reports("light"), "dark_css_variables": like_reports("dark")}
html_static_path = ["static"]
html_css_files = ["site.css"]
html_search_scorer = str(pathlib.Path(__file__).with_name("static") / "scorer.js")
html_show_sphinx = False
html_copy_source = False
lexers["csv"] = TextLexer()  # GitHub knows it, Pygments does not
pygments_style = "friendly"
pygments_dark_style = "monokai"
