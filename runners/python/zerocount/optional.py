"""Packages that only some functions need."""

from __future__ import annotations

import importlib
from typing import Any

_DEBIAN = {
    "IPython": "python3-ipython",
    "distributed": "python3-distributed",
    "h5py": "python3-h5py",
    "matplotlib": "python3-matplotlib",
    "openturns": "python3-openturns",
    "pandas": "python3-pandas",
    "xarray": "python3-xarray",
}


def required(name: str, purpose: str) -> Any:
    """Import a package that `purpose` needs.

    Raises
    ------
    ImportError
        If it is not installed; the message says how to install it.
    """
    top = name.partition(".")[0]
    try:
        return importlib.import_module(name)
    except ImportError:
        raise ImportError(
            f"{purpose} needs {top}, which is not installed; install it (apt-get install {_DEBIAN[top]}, or pip "
            f"install {top})"
        ) from None
