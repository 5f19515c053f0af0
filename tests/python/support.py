"""What several tests of the package use."""

import pathlib
import re

ROOT = pathlib.Path(__file__).parents[2]


def first_study(root: pathlib.Path, path: pathlib.Path) -> None:
    """Writes the manifest of the README's first study."""
    text = (root / "README.md").read_text(encoding="utf-8")
    path.write_text(re.search(r"```yaml\n(zerocount: 1\nname: my-axis\n.*?)```", text, re.DOTALL)[1], encoding="utf-8")
