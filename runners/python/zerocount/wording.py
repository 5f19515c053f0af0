"""Words for people."""

from __future__ import annotations


def counted(number: int, noun: str) -> str:
    """Such as "1 trial" and "2 trials"."""
    return f"{number} {noun}" + ("" if number == 1 else "s")
