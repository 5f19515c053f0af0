"""Pages of the interfaces in C++, C and Python, which breathe and autodoc fill from the comments of the sources."""

import ast

INTERNAL = (  # of the fast engine and of bounds: whoever runs trials includes core/batch/batch.hpp
    "core/batch/lanes", "core/batch/kernels", "core/numerics/real.hpp")
# The headers in C: page, file, title and first sentences.
C_HEADERS = {
    "plugin": ("core/plugin/zerocount/controller.h", "# The header of controllers of one's own\n\nWhat does a controller in C or C++ have to provide? "
               "How to write one: [your own controller](../docs/your-own-controller.md)."),
    "library": ("runners/library/zerocount/zerocount.h", "# The library for other languages\n\nWhich functions of C run trials of a study? "
                "How a program links it: [installation](../docs/installation.md#the-simulation-as-a-library)."),
}
# They are C for any compiler, with plain comments: Doxygen reads those that describe what follows or stands before them.
C_FILTER = r"sed -e '4s|^/\* |/** \\file\n * |' -e '5,$s|^\( *\)/\* |\1/** |' -e 's|\([;,]\) *\(/\*\) |\1 /**< |'"

# Formulas and pseudo-code in comments are indented by less than Markdown asks.
HEADER_FILTER = r"sed -e 's|^\( *///\)   \( *[^ ]\)|\1      \2|'"


def headers(root):
    """The headers of each folder of core that other programs include."""
    folders = {}
    for header in sorted((root / "core").rglob("*.hpp")):
        path = header.relative_to(root).as_posix()
        if not path.startswith(INTERNAL):
            folders.setdefault(path.rsplit("/", 1)[0], []).append(path)
    return folders


def doxygen_settings(root, output):
    """Only XML, of the public headers; comments that start with /// or /**."""
    inputs = [str(root / header) for folder in headers(root).values() for header in folder]
    inputs += [str(root / header) for header, _ in C_HEADERS.values()]
    settings = {
        "INPUT": " ".join(inputs), "OUTPUT_DIRECTORY": output, "GENERATE_XML": "YES", "GENERATE_HTML": "NO", "GENERATE_LATEX": "NO",
        "STRIP_FROM_PATH": root, "FULL_PATH_NAMES": "YES", "EXTRACT_ALL": "YES", "JAVADOC_AUTOBRIEF": "YES", "QUIET": "YES",
        "WARN_IF_INCOMPLETE_DOC": "NO", "WARN_IF_DOC_ERROR": "NO", "XML_PROGRAMLISTING": "NO",
        "MACRO_EXPANSION": "YES", "EXPAND_ONLY_PREDEF": "YES", "PREDEFINED": "ZEROCOUNT_EXPORT= ZEROCOUNT_ALWAYS_INLINE=",
        "FILTER_PATTERNS": f'*.h="{C_FILTER}" *.hpp="{HEADER_FILTER}"',
    }
    return "".join(f"{key} = {value}\n" for key, value in settings.items())


def cpp_pages(root):
    """A page for each namespace, which is a folder of core."""
    rooms = {}
    for folder, paths in headers(root).items():
        rooms.setdefault(folder.split("/")[1], []).extend(path.removeprefix("core/") for path in paths)
    rows = "".join(f"| [{room}]({room}.md) | {', '.join(f'`{path}`' for path in paths)} |\n" for room, paths in rooms.items())
    yield "index", ("# The simulation as a C++ library\n\nWhat do the headers of `zerocount::core` declare? How a program links it: "
                    "[installation](../../docs/installation.md#the-simulation-as-a-library). A header is included by its path, such as "
                    "`core/trial/trial.hpp`.\n\n| namespace | headers in `core` |\n| --- | --- |\n"
                    f"{rows}\n```{{toctree}}\n:hidden:\n\n" + "\n".join(rooms) + "\n```\n")
    for room in rooms:
        if room == "failure":  # the only header of the outer namespace
            yield room, "# failure\n\n```{doxygenfile} core/failure/failure.hpp\n```\n"
        else:
            yield room, f"# {room}\n\n```{{doxygennamespace}} zerocount::{room}\n:content-only:\n:members:\n:undoc-members:\n```\n"


def c_page(header, opening):
    return f"{opening}\n\n```{{doxygenfile}} {header}\n:sections: briefdescription detaileddescription innerclass func define public-attrib\n```\n"


def python_page(root):
    tree = ast.parse((root / "runners/python/zerocount/__init__.py").read_text(encoding="utf-8"))
    names = next(ast.literal_eval(node.value) for node in tree.body
                 if isinstance(node, ast.Assign) and node.targets[0].id == "__all__")
    functions = [name for name in names if name.islower() and not name.startswith("_")]
    classes = [name for name in names if not name.islower()]
    blocks = [f"### {name}\n\n```{{eval-rst}}\n.. autofunction:: zerocount.{name}\n```\n" for name in functions]
    blocks.append("## Classes\n")
    blocks += [f"### {name}\n\n```{{eval-rst}}\n.. autoclass:: zerocount.{name}\n   :members:\n```\n" for name in classes]
    return ("# The Python package\n\nWhat does each function and class take and return? How they work together: "
            "[zerocount for Python](../runners/python/README.md).\n\n## Functions\n\n" + "\n".join(blocks))


def write(folder, root):
    (folder / "cpp").mkdir(parents=True)
    for name, text in cpp_pages(root):
        (folder / "cpp" / f"{name}.md").write_text(text, encoding="utf-8")
    for name, described in C_HEADERS.items():
        (folder / f"{name}.md").write_text(c_page(*described), encoding="utf-8")
    (folder / "python.md").write_text(python_page(root), encoding="utf-8")
