"""The blocks of Python in the page of the package run, one after the other.

usage: documentation.py ROOT
"""

import os
import pathlib
import re
import sys
import tempfile
import traceback

from support import short_first_study

PAGE = "runners/python/README.md"


def main(root: pathlib.Path) -> int:
    failed = 0
    blocks = re.findall(r"```python\n(.*?)```", (root / PAGE).read_text(encoding="utf-8"), re.DOTALL)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        short_first_study(root, pathlib.Path("my-axis.yaml"))
        names: dict[str, object] = {}
        for block in blocks:
            try:
                exec(block, names)
            except Exception:
                failed += 1
                print(f"{PAGE}:\n{block}\n{traceback.format_exc()}")
        os.chdir("/")
    print(f"{len(blocks)} blocks, {failed} failed")
    return failed > 0 or len(blocks) < 6


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
