"""Each top-level folder includes only itself and the folders below it."""

import pathlib
import re
import sys

LAYERS = ["core", "experiments", "results", "analysis", "runners"]  # lowest first
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"/]+)/', re.MULTILINE)
# core computes: no files, no streams, no threads.
FORBIDDEN_IN_CORE = re.compile(
    r"^\s*#\s*include\s+<(fstream|iostream|cstdio|stdio\.h|filesystem|thread|mutex|future|atomic|hdf5\.h|(oneapi/)?tbb/.*)>",
    re.MULTILINE,
)


def problems(root):
    for level, layer in enumerate(LAYERS):
        for path in sorted((root / layer).rglob("*.[ch]pp")):
            text = path.read_text(encoding="utf-8")
            for included in INCLUDE.findall(text):
                if included not in LAYERS[: level + 1]:
                    yield f"{path.relative_to(root)}: includes \"{included}/…\", which is not below {layer}/"
            if layer == "core":
                for header in FORBIDDEN_IN_CORE.findall(text):
                    yield f"{path.relative_to(root)}: core has no I/O and no threads, but includes <{header[0]}>"


if __name__ == "__main__":
    found = list(problems(pathlib.Path(sys.argv[1])))
    print("\n".join(found) or "the layers hold")
    sys.exit(1 if found else 0)
