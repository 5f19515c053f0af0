"""Options of the program."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from .manifests import flow_text

def options(**values: Any) -> list[str]:
    """Options of the program.

    Parameters
    ----------
    **values
        By the option's name with ``_`` in place of ``-``. None and False: not given; True: given; a list: given
        for each of its values; a dict: given as ``KEY=VALUE`` for each. A path is made absolute.

    Returns
    -------
    list of str

    Examples
    --------
    >>> options(dac_bits=16, fix={"friction.n": 2}, quiet=True)
    ['--dac-bits', '16', '--fix', 'friction.n=2', '--quiet']
    """
    words: list[str] = []
    for name, value in values.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(option)
        elif isinstance(value, Mapping):
            for key, inner in value.items():
                words += [option, f"{key}={inner if isinstance(inner, str) else flow_text(inner)}"]
        elif isinstance(value, Sequence) and not isinstance(value, str):
            for inner in value:
                words += [option, str(inner)]
        else:
            words += [option, os.path.abspath(value) if isinstance(value, os.PathLike) else str(value)]
    return words
