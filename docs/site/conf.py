"""The site: what stage.py lays together, as pages. `./quickstart docs` calls it."""

import os
import pathlib
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

autodoc_mock_imports = ["_zerocount"]  # so that the site needs no build of the extension
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # numpydoc has them
numpydoc_show_class_members = False

breathe_projects = {"zerocount": os.environ["ZEROCOUNT_DOXYGEN"]}
breathe_default_project = "zerocount"
breathe_default_members = ("members", "undoc-members")
breathe_domain_by_extension = {"h": "c", "hpp": "cpp"}

html_theme = "furo"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_search_scorer = str(pathlib.Path(__file__).with_name("static") / "scorer.js")
html_show_sphinx = False
html_copy_source = False
lexers["csv"] = TextLexer()  # GitHub knows it, Pygments does not
pygments_style = "friendly"
pygments_dark_style = "monokai"
