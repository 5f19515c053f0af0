"""The JSON Schema of answers: what is a table, and its columns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any


def row_schema(schema: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """The schema of the rows of a table, which is a list of objects or has objects by name; None of anything else."""
    for rows in (schema.get("items"), schema.get("additionalProperties")):
        if isinstance(rows, Mapping) and "properties" in rows:
            return rows
    return None


def columns_of(schema: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Names and schemas of the columns of a table whose rows have this schema."""
    for key, found in schema["properties"].items():
        if "properties" in found:
            yield from columns_of(found, f"{prefix}{key}.")
        else:
            yield prefix + key, found
