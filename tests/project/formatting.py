"""Every C++ file is as clang-format would leave it."""

import pathlib
import subprocess
import sys

FOLDERS = ["core", "experiments", "results", "analysis", "runners", "tests"]

if __name__ == "__main__":
    root = pathlib.Path(sys.argv[1])
    files = [str(path) for folder in FOLDERS for path in sorted((root / folder).rglob("*.[ch]pp"))]
    sys.exit(subprocess.run(["clang-format", "--dry-run", "--Werror", *files], check=False).returncode)
