"""What the program answers, as objects of Python."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from .answer_schema import columns_of, row_schema
from .optional import required

if TYPE_CHECKING:
    import pandas  # type: ignore[import]

A = TypeVar("A", bound="Answer")
_STYLE = """<style>
.zerocount .headline{font-weight:600}
.zerocount .headline::first-letter{text-transform:uppercase}
.zerocount .lines{white-space:pre-line}
.zerocount .unit{display:block;font-weight:400;font-size:.75rem}
.zerocount .text{text-align:left}
</style>"""  # of a fragment, which a notebook shows without the style of pages
_PARTS = frozenset({"properties", "items", "additionalProperties"})


class Record(Mapping[str, Any]):
    """An object of an answer.

    Its items are those of the JSON. Its attributes are the same, but an object is a Record, and a table is a
    DataFrame of pandas, with ``attrs["units"]`` and ``attrs["meanings"]`` of its columns. A member that the JSON
    leaves out is None as an attribute. Where a key is a word of Python or of this class, the attribute ends in ``_``.

    Parameters
    ----------
    values : mapping
        The object of the JSON.
    schema : mapping
        Its JSON Schema.
    """

    _records: ClassVar[Mapping[str, type[Record]]] = {}  # classes of the objects, by key

    def __init__(self, values: Mapping[str, Any], schema: Mapping[str, Any]) -> None:
        self._values = values
        self._schema = schema

    def __getitem__(self, key: str) -> Any:
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{key}={value!r}' for key, value in self.items())})"

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._schema["properties"]})

    if not TYPE_CHECKING:  # the generated classes have the attributes

        def __getattr__(self, name: str) -> Any:
            members = {} if name.startswith("_") else self._schema["properties"]
            for key in (name, name[:-1]):
                if key in members:
                    return self._attribute(key, members[key])
            if any(name in vars(each).get("__annotations__", ()) for each in type(self).__mro__):
                return None  # that only other answers of the kind have
            raise AttributeError(f"{type(self).__name__!r} has no attribute {name!r}")

    def _attribute(self, key: str, schema: Mapping[str, Any]) -> Any:
        value = self._values.get(key)
        if value is not None and "properties" in schema:
            return self._records.get(key, Record)(value, schema)
        if value is not None and row_schema(schema) is not None:
            return table(value, row_schema(schema) or {})
        return value

    def rows_of(self, path: str) -> pandas.DataFrame:
        """A table that the rows of another have, as one.

        Parameters
        ----------
        path : str
            The keys of the tables, such as ``"points.outputs.factors"``.

        Returns
        -------
        pandas.DataFrame
            Before the columns of the inner rows those of the outer ones with other names, without lists and objects.
        """
        rows: list[Mapping[str, Any]] = [self._values]
        columns: Mapping[str, Any] = {}
        schema = self._schema
        for key in path.split("."):
            outer = {name: found for name, found in columns.items() if not _PARTS & found.keys()}
            inner_schema = row_schema(schema["properties"].get(key, {}))
            if inner_schema is None:
                raise KeyError(f"{path}: {key} is not a table of the answer")
            schema = inner_schema
            rows = [{**{name: row.get(name) for name in outer}, **inner} for row in rows for inner in row[key] or ()]
            columns = {**outer, **schema["properties"]}
        return table(rows, {"properties": columns})

    def to_dict(self) -> dict[str, Any]:
        """The JSON, to be changed.

        Returns
        -------
        dict
        """
        return copy.deepcopy(dict(self._values))


class Answer(Record):
    """What a command of the program answers. ``print`` shows its text, and a notebook its page.

    Parameters
    ----------
    rendered : mapping
        The JSON that the program gives with ``--format notebook``.

    Attributes
    ----------
    answer : str
        Name of the kind of answer: the command, with a hyphen and more where it answers in several ways.
    version : int
        Counts changes of what is in answers of this kind.
    headline : str
        The answer in one sentence.
    """

    answer: str
    version: int
    headline: str

    def __init__(self, rendered: Mapping[str, Any]) -> None:
        super().__init__(rendered["answer"], rendered["schema"])
        self._rendered = rendered

    @classmethod
    def of(cls: type[A], answer: Answer) -> A:
        """The same answer as one of this class.

        Parameters
        ----------
        answer : Answer
            Of a class that this one extends.

        Returns
        -------
        Answer
        """
        return cls(answer._rendered)

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.headline}>"

    def __str__(self) -> str:
        return str(self._rendered["text"]).rstrip("\n")

    def _repr_html_(self) -> str:
        return f'<div class="zerocount">{_STYLE}{self._rendered["html"]}</div>'


def table(rows: Any, schema: Mapping[str, Any]) -> pandas.DataFrame:
    """A table of an answer.

    Parameters
    ----------
    rows : list of dict, or dict of dict
        The rows, or the rows by name.
    schema : mapping
        The JSON Schema of a row.

    Returns
    -------
    pandas.DataFrame
        A member of an object in a row is a column such as ``needed.trials``, and so is one of values by name.
    """
    pandas = required("pandas", "a table of an answer")
    known = dict(columns_of(schema))
    frame = pandas.json_normalize(list(rows.values()) if isinstance(rows, Mapping) else rows)
    columns = {name: found for name in frame if (found := _column_of(known, name)) is not None} if len(rows) else known
    frame = frame.reindex(columns=list(columns))
    if isinstance(rows, Mapping):
        frame.index = pandas.Index(list(rows), name="name")
    frame = frame.astype({name: float for name, found in columns.items() if "number" in found.get("type", ())})
    frame.attrs["units"] = {name: found["unit"] for name, found in columns.items() if "unit" in found}
    frame.attrs["meanings"] = {name: found.get("description", "") for name, found in columns.items()}
    return frame


def _column_of(known: Mapping[str, Mapping[str, Any]], name: str) -> Mapping[str, Any] | None:
    """The schema of a column: one of those that are known, or a value of a known column that has values by name."""
    for other, found in known.items():
        if other == name:
            return found
        if name.startswith(f"{other}.") and found.get("additionalProperties"):
            values: Mapping[str, Any] = found["additionalProperties"]
            return {**values, "description": found.get("description", "")}
    return None
