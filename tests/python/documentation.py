"""The blocks of Python in the documentation run, those of a page one after the other.

usage: documentation.py ROOT
"""

import os
import pathlib
import re
import sys
import tempfile
import traceback

from support import first_study

PAGES = ("README.md", "runners/python/README.md")


def main(root: pathlib.Path) -> int:
    failed = blocks = 0
    for page in PAGES:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            first_study(root, pathlib.Path("my-axis.yaml"))
            names: dict[str, object] = {}
            for block in re.findall(r"```python\n(.*?)```", (root / page).read_text(encoding="utf-8"), re.DOTALL):
                blocks += 1
                try:
                    exec(block, names)
                except Exception:
                    failed += 1
                    print(f"{page}:\n{block}\n{traceback.format_exc()}")
            os.chdir("/")
    print(f"{blocks} blocks, {failed} failed")
    return failed > 0 or blocks < 7


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
