"""The blocks of Python in the page of the package run, one after the other; the block with workers is also a script.

usage: documentation.py ROOT
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import traceback

from support import short_first_study

PAGE = "runners/python/README.md"


def failures_as_script(blocks: list[str], folder: pathlib.Path) -> int:
    """Runs the blocks that start processes as scripts, which these processes import. Returns the number that fail."""
    failed = 0
    study = "".join(line for line in blocks[0].splitlines(keepends=True) if line.startswith(("import", "study")))
    for number, block in enumerate(block for block in blocks if "__main__" in block):
        script = folder / f"script{number}.py"
        script.write_text(study + block)
        try:
            result = subprocess.run([sys.executable, script], cwd=folder, capture_output=True, text=True, timeout=300)
        except subprocess.TimeoutExpired:
            print(f"{PAGE}:\n{block}\ndoes not end as a script")
            failed += 1
            continue
        failed += result.returncode != 0
        if result.returncode != 0:
            print(f"{PAGE}:\n{block}\nas a script: {result.stderr}")
    return failed


def main(root: pathlib.Path) -> int:
    failed = 0
    blocks = re.findall(r"```python\n(.*?)```", (root / PAGE).read_text(encoding="utf-8"), re.DOTALL)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        short_first_study(root, pathlib.Path("my-axis.yaml"))
        names: dict[str, object] = {"__name__": "__main__"}
        for block in blocks:
            try:
                exec(block, names)
            except Exception:
                failed += 1
                print(f"{PAGE}:\n{block}\n{traceback.format_exc()}")
        pathlib.Path("on-workers.h5").unlink(missing_ok=True)
        failed += failures_as_script(blocks, pathlib.Path(folder))
        os.chdir("/")
    print(f"{len(blocks)} blocks, {failed} failed")
    return failed > 0 or len(blocks) < 6


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
