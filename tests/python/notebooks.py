"""The notebooks of the documentation run, and what they print is what they show.

usage: notebooks.py FOLDER [--only NAME...] [--write]

--write stores what the cells print, and their pictures, in the notebooks.
"""

import argparse
import pathlib
import sys
import tempfile

import nbclient
import nbformat

PATIENCE = 300  # s for a cell


def texts(notebook):
    """What each cell prints or returns as text."""
    for cell in notebook.cells:
        if cell.cell_type != "code":
            continue
        outputs = [output for output in cell.outputs if not is_message(output)]
        parts = [output.get("text") or output.get("data", {}).get("text/plain", "") for output in outputs]
        yield cell.source, "".join(part for part in parts if not part.startswith(("<Figure", "<IPython")))


def is_message(output):
    """Whether it is a warning or the like, which names files of this machine."""
    return output.get("name") == "stderr"


def executed(path):
    notebook = nbformat.read(path, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        nbclient.NotebookClient(notebook, timeout=PATIENCE, resources={"metadata": {"path": folder}}).execute()
    return notebook


def differences(path):
    """The cells that print something else than the notebook shows."""
    stored = list(texts(nbformat.read(path, as_version=4)))
    for (source, shown), (_, printed) in zip(stored, texts(executed(path))):
        if shown != printed:
            yield f"{path.name}: the cell\n{source}\nshows\n{shown}\nbut prints\n{printed}"


def write(path):
    notebook = executed(path)
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)
        if cell.cell_type == "code":
            cell.outputs = [output for output in cell.outputs if not is_message(output)]
    nbformat.write(notebook, path)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("folder", type=pathlib.Path)
    arguments.add_argument("--only", nargs="+", metavar="NAME", help="these notebooks of the folder")
    arguments.add_argument("--write", action="store_true")
    options = arguments.parse_args()
    notebooks = [options.folder / f"{name}.ipynb" for name in options.only or []] or sorted(options.folder.glob("*.ipynb"))
    if options.write:
        for path in notebooks:
            write(path)
        return 0
    found = [difference for path in notebooks for difference in differences(path)]
    print("\n".join(found) or f"{len(notebooks)} notebooks print what they show")
    return bool(found) or not notebooks


if __name__ == "__main__":
    sys.exit(main())
