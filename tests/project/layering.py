"""Each folder includes only itself and those below it and is a namespace; no type is defined in two headers; every test is built.

Tests in C++ stand where their subject does. The table of analysis/README.md lists the folders in their order.

The order of the folders of a layer is that of zerocount_layer() in its CMakeLists.txt. The folders inside one of these are part of it. A
listed folder has the namespace of its last name: analysis/trials/goal is zerocount::goal.
"""

import collections
import pathlib
import re
import sys

LAYERS = ["core", "experiments", "results", "analysis", "runners"]  # lowest first
WITHOUT_SUBJECT = {"core/bits"}  # whole trials
FOLDER_ROWS = re.compile(r"^\| (\[?`.*?) \|", re.MULTILINE)
SOURCE = re.compile(r"[\w./-]+\.cpp")
LISTED = re.compile(r"^zerocount_layer\(([^)]*)\)", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)/[^"/]+"', re.MULTILINE)
# core computes: no files, no streams, no threads.
FORBIDDEN_IN_CORE = re.compile(
    r"^\s*#\s*include\s+<(fstream|iostream|cstdio|stdio\.h|filesystem|thread|mutex|future|atomic|hdf5\.h|(oneapi/)?tbb/.*)>",
    re.MULTILINE,
)

# Used unqualified in every folder: exit codes, and functions that overload resolution chooses by number type. The handles of parameters
# have a namespace of their own, parameter, because each of them reads as the name of one parameter.
WITHOUT_NAMESPACE = {
    "analysis/basis/statistics/elementary_functions.cpp",
    "core/failure/failure.hpp",
    "core/numerics/number.hpp",
    "experiments/parameters/handles.hpp",
}
NAMESPACE = re.compile(r"^(?:inline )?namespace (\S+) \{")
# A definition stands at the margin: what is indented is a member of something else.
TYPE = re.compile(r"^(?:struct|class|enum(?: class| struct)?) (?:alignas\(.*?\) )?(\w+)[^;(]*(?:\{|$)|^using (\w+) =")


def types_of(path):
    """The names, with their namespace, of the types that a header defines."""
    namespace = ""
    for line in path.read_text(encoding="utf-8").splitlines():
        opened = NAMESPACE.match(line)
        if opened:
            namespace = opened.group(1)
        defined = TYPE.match(line)
        if defined:
            yield f"{namespace}::{defined.group(1) or defined.group(2)}"


def types_defined_twice(root):
    """Two types of one name break the one-definition rule, which no compiler or linker need notice."""
    headers = collections.defaultdict(set)
    for folder in [*LAYERS, "tests"]:
        for path in sorted((root / folder).rglob("*.hpp")):
            for name in types_of(path):
                headers[name].add(path.relative_to(root))
    for name, paths in headers.items():
        if len(paths) > 1:
            yield f"{name} is defined in {' and in '.join(map(str, sorted(paths)))}"


def folders_in_order(root):
    """All folders with sources, lowest first; what stands in the folder of a layer itself is above its folders."""
    for layer in LAYERS:
        listed = LISTED.search((root / layer / "CMakeLists.txt").read_text(encoding="utf-8"))
        yield from (f"{layer}/{folder}" for folder in listed.group(1).split())
        yield layer


def listed_folder(folder, folders):
    """The folder of the order that `folder` is or is inside of; None where there is none, or only that of a layer."""
    inside = [folder, *map(str, pathlib.PurePath(folder).parents)]
    return next((one for one in inside if one in folders and (one == folder or "/" in one)), None)


def tests_not_built(root):
    """A test that is in no CMakeLists.txt never fails."""
    lists = (root / "tests").rglob("CMakeLists.txt")
    built = {(file.parent / name).resolve() for file in lists for name in SOURCE.findall(file.read_text(encoding="utf-8"))}
    for path in sorted((root / "tests").rglob("*_test.cpp")):
        if path.resolve() not in built:
            yield f"{path.relative_to(root)}: is in no CMakeLists.txt"


def tests_elsewhere(root):
    for folder in sorted({path.parent.relative_to(root / "tests") for layer in LAYERS for path in (root / "tests" / layer).rglob("*.cpp")}):
        if not (root / folder).is_dir() and str(folder) not in WITHOUT_SUBJECT:
            yield f"tests/{folder}: there is no {folder}"


def wrong_order_in_readme(root, folders):
    table = (root / "analysis/README.md").read_text(encoding="utf-8").split("## To add")[0]
    told = [name for row in FOLDER_ROWS.findall(table) for name in re.findall(r"`([\w/]+)`", row)]
    built = [folder.removeprefix("analysis/") for folder in folders if folder.startswith("analysis/")]
    if told != built:
        yield f"analysis/README.md: lists {' '.join(told)}; the build has {' '.join(built)}"


def problems(root):
    folders = list(folders_in_order(root))
    yield from types_defined_twice(root)
    yield from tests_not_built(root)
    yield from tests_elsewhere(root)
    yield from wrong_order_in_readme(root, folders)
    for path in sorted(path for layer in LAYERS for path in (root / layer).rglob("*.[ch]pp")):
        name = path.relative_to(root)
        folder = listed_folder(str(name.parent), folders)
        if folder is None:
            yield f"{name}: {name.parent} is in no zerocount_layer()"
            continue
        text = path.read_text(encoding="utf-8")
        for included in INCLUDE.findall(text):
            if listed_folder(included, folders) not in folders[: folders.index(folder) + 1]:
                yield f"{name}: includes \"{included}/…\", which is not below {folder}"
        in_folder = len(name.parts) > 2 and str(name) not in WITHOUT_NAMESPACE
        namespace = folder.split("/")[-1] if name.parts[0] == "analysis" else name.parts[1]
        if in_folder and f"\nnamespace zerocount::{namespace} {{" not in text:
            yield f"{name}: defines nothing in namespace zerocount::{namespace}"
        if name.parts[0] == "core":
            for header in FORBIDDEN_IN_CORE.findall(text):
                yield f"{name}: core has no I/O and no threads, but includes <{header[0]}>"


if __name__ == "__main__":
    found = list(problems(pathlib.Path(sys.argv[1])))
    print("\n".join(found) or "the layers hold")
    sys.exit(1 if found else 0)
