"""Manifests as text: what a dict of Python looks like as YAML."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

from .errors import ManifestError

_PLAIN = re.compile(r"[A-Za-z_/]([\w./ +-]*[\w./+-])?", re.ASCII)
_RESERVED = frozenset({"true", "false", "null", "yes", "no", "on", "off", "y", "n", "nan", "inf", "infinity"})


def yaml_text(manifest: Mapping[str, Any]) -> str:
    """A manifest in block style: a line for each key down to the second level, and flow style below.

    Parameters
    ----------
    manifest : mapping
        Keys are texts; values are mappings, sequences, arrays, numbers, booleans, texts or None.

    Returns
    -------
    str
        YAML that the program reads.

    Raises
    ------
    ManifestError
        For a value that YAML cannot express.

    Examples
    --------
    >>> print(yaml_text({"zerocount": 1, "friction": {"k1": {"uniform": [80.0, 100.0]}}}), end="")
    zerocount: 1
    friction:
      k1: {uniform: [80.0, 100.0]}
    """
    lines = []
    for key, value in manifest.items():
        if isinstance(value, Mapping) and value:
            lines.append(f"{flow_text(key)}:")
            lines += [f"  {flow_text(name)}: {flow_text(inner)}" for name, inner in value.items()]
        else:
            lines.append(f"{flow_text(key)}: {flow_text(value)}")
    return "".join(line + "\n" for line in lines)


def flow_text(value: Any) -> str:
    """A value as YAML in flow style, on one line.

    Parameters
    ----------
    value : mapping, sequence, array, number, bool, str or None
        Arrays and numbers of NumPy are written as Python's.

    Returns
    -------
    str

    Raises
    ------
    ManifestError
        For a value that YAML cannot express.

    Examples
    --------
    >>> flow_text({"lognormal": {"median": 90, "cv": 0.2}})
    '{lognormal: {median: 90, cv: 0.2}}'
    """
    if hasattr(value, "tolist"):  # of NumPy
        value = value.tolist()
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ManifestError(f"a manifest has no value {value}; expected a finite number", 2)
        return repr(value)
    if isinstance(value, str):
        plain = _PLAIN.fullmatch(value) and value.lower() not in _RESERVED and not _is_number(value)
        return value if plain else _quoted(value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{flow_text(key)}: {flow_text(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        return "[" + ", ".join(map(flow_text, value)) + "]"
    raise ManifestError(
        f"a manifest has no value of the type {type(value).__name__}; expected a mapping, a sequence, a number, a "
        "boolean or a text",
        2,
    )


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _quoted(text: str) -> str:
    """A text in double quotes, with all that cannot be printed escaped."""
    quoted = json.dumps(text, ensure_ascii=False)
    return "".join(letter if letter.isprintable() else json.dumps(letter)[1:-1] for letter in quoted)
