"""Writes zerocount/answer_types.py: a class for each answer of the program, from its schema.

usage: generate_answers.py PROGRAM [--check]

--check only says whether the file is up to date.
"""

from __future__ import annotations

import argparse
import collections
import json
import keyword
import pathlib
import subprocess
import sys
import textwrap
from collections.abc import Iterator, Mapping
from typing import Any

HERE = pathlib.Path(__file__).parent / "zerocount"
sys.path.insert(0, str(HERE))
from answer_schema import row_schema  # noqa: E402  (the package itself needs the file)

Schema = Mapping[str, Any]
TARGET = HERE / "answer_types.py"
WIDTH = 120
PYTHON = {"boolean": "bool", "integer": "int", "number": "float", "string": "str"}
OF_ALL = ("answer", "version", "headline")
RESERVED = frozenset({"Answer", "Record", "Any", "Ask", "Literal", "Protocol", "Union"})
HEAD = '''"""The answers of the program, written by generate_answers.py from ``zerocount schema --answers``: do not edit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Protocol, Union, overload

from .answers import Answer, Record

if TYPE_CHECKING:
    import pandas  # type: ignore[import]
'''


def camel(key: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in key.replace("-", "_").split("_"))


def attribute(key: str) -> str:
    """The name of an attribute: the key, if that is not a word of Python or of the class."""
    return key + "_" if keyword.iskeyword(key) or key in {*dir(Mapping), "to_dict"} else key


def shape(schema: Schema) -> str:
    """Equal for objects with the same members."""
    return json.dumps([schema["properties"], schema.get("required")])


def objects(schema: Schema, path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Schema]]:
    """The objects in an object that are no rows, innermost first, with their paths."""
    for key, found in schema["properties"].items():
        if "properties" in found:
            yield from objects(found, (*path, key))
            yield (*path, key), found


class Names:
    """Names of the classes of objects: that of the key, if all objects of this key have the same members."""

    def __init__(self, answers: Mapping[str, Schema]) -> None:
        self._shapes = collections.defaultdict(set)
        for name, answer in answers.items():
            for path, found in objects(answer, (name,)):
                self._shapes[camel(path[-1])].add(shape(found))

    def of(self, path: tuple[str, ...]) -> str:
        short = camel(path[-1])
        return short if len(self._shapes[short]) == 1 and short not in RESERVED else "".join(map(camel, path))


def annotation(schema: Schema, path: tuple[str, ...], names: Names) -> str:
    """The type of a value."""
    types = schema.get("type", [])
    types = [types] if isinstance(types, str) else types
    if "enum" in schema:
        words = [word for word in schema["enum"] if word is not None]
        text, types = f"Literal[{', '.join(map(json.dumps, words))}]", ["null"] * (None in schema["enum"])
    elif "properties" in schema:
        text = names.of(path)
    elif row_schema(schema) is not None:
        text = "pandas.DataFrame"
    elif "items" in schema:
        text = f"list[{annotation(schema['items'], path, names)}]"
    elif schema.get("additionalProperties"):
        text = f"dict[str, {annotation(schema['additionalProperties'], path, names)}]"
    else:
        text = next((PYTHON[name] for name in types if name in PYTHON), "Any")
    return text + " | None" * ("null" in types)


def described(schema: Schema) -> str:
    """Meaning and unit."""
    meaning, unit = schema.get("description", ""), schema.get("unit", "1")
    return meaning if unit == "1" else f"{meaning}, {unit}" if meaning else unit


def sentence(phrase: str) -> str:
    """The phrase with a capital, unless it begins with a key, and a full stop."""
    return (phrase[:1].upper() + phrase[1:] if phrase.split(" ")[0].strip(";,:").isalpha() else phrase) + "."


def wrapped(text: str, indent: int, further: int = 0) -> str:
    return textwrap.fill(
        text, WIDTH, initial_indent=" " * indent, subsequent_indent=" " * (indent + further), break_long_words=False,
        break_on_hyphens=False,
    )  # fmt: skip


def column_lines(rows: Schema, indent: int) -> Iterator[str]:
    """What is said of each member of a row: of an object also the parts, each of which is a column or several."""
    for key, found in rows["properties"].items():
        parts = f".* ({', '.join(found['properties'])})" if "properties" in found else ""
        meaning = described(found)
        yield wrapped(f"- ``{key}``{parts}" + (f": {meaning}" if meaning else ""), indent, 2)
        inner = row_schema(found)
        if inner is not None:
            yield from column_lines(inner, indent + 2)


def documentation(schema: Schema, members: Mapping[str, str]) -> Iterator[str]:
    yield wrapped('"""' + sentence(schema.get("description") or "what the program answers"), 4)
    yield ""
    if members:
        yield "    Attributes\n    ----------"
    for key, type_name in members.items():
        found = schema["properties"][key]
        yield f"    {attribute(key)} : {type_name.replace(' | None', ' or None')}"
        yield wrapped(sentence(described(found) or key.replace("_", " ")), 8)
        rows = row_schema(found)
        if rows is not None:
            yield ""
            yield from column_lines(rows, 8)
            yield ""
    yield '    """\n'


def class_text(name: str, base: str, schema: Schema, path: tuple[str, ...], names: Names) -> str:
    members = {}
    for key, found in schema["properties"].items():
        if base == "Record" or key not in OF_ALL:
            type_name = annotation(found, (*path, key), names)
            absent = key not in schema.get("required", ()) and not type_name.endswith("| None")
            members[key] = type_name + " | None" * absent
    parts = {key: names.of((*path, key)) for key, found in schema["properties"].items() if "properties" in found}
    lines = [f"class {name}({base}):", *documentation(schema, members)]
    if parts:
        lines.append(f"    _records = {{{', '.join(f'{json.dumps(key)}: {part}' for key, part in parts.items())}}}\n")
    lines += [f"    {attribute(key)}: {type_name}" for key, type_name in members.items()]
    return "\n".join(lines).rstrip() + "\n"


def by_command(answers: Mapping[str, Schema]) -> dict[str, list[str]]:
    """Names of the answers of each command."""
    result: dict[str, list[str]] = {}
    for name in answers:
        result.setdefault(name.partition("-")[0], []).append(name)
    return result


def class_name(answer: str) -> str:
    return f"{camel(answer)}Answer"


def ask_text(commands: Mapping[str, list[str]]) -> str:
    """The types of `ask`."""
    lines = ["class Ask(Protocol):", '    """Asks the program, and gives the answer of the command."""', ""]
    kinds = {f'Literal["{command}"]': " | ".join(map(class_name, answers)) for command, answers in commands.items()}
    for kind, answer in {**kinds, "str": "Answer"}.items():
        lines.append("    @overload")
        lines.append(f"    def __call__(self, command: {kind}, /, *operands: Any, **options: Any) -> {answer}: ...")
    return "\n".join(lines) + "\n"


def module_text(answers: Mapping[str, Schema]) -> str:
    names, commands, classes = Names(answers), by_command(answers), {}
    for answer, schema in answers.items():
        for path, found in objects(schema, (answer,)):
            classes.setdefault(names.of(path), class_text(names.of(path), "Record", found, path, names))
        classes[class_name(answer)] = class_text(class_name(answer), "Answer", schema, (answer,), names)
    unions = [
        f"{class_name(command)} = Union[{', '.join(map(class_name, kinds))}]\n"
        for command, kinds in commands.items()
        if command not in kinds
    ]
    types = "".join(f'    "{name}": {class_name(name)},\n' for name in answers)
    parts = [HEAD, *classes.values(), *unions, f"TYPES: dict[str, type[Answer]] = {{\n{types}}}\n"]
    return "\n\n".join([*parts, ask_text(commands)])


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("--check", action="store_true")
    given = arguments.parse_args()
    schema = subprocess.run([given.program, "schema", "--answers"], capture_output=True, text=True, check=True).stdout
    text = module_text(json.loads(schema)["$defs"])
    if given.check:
        current = TARGET.exists() and TARGET.read_text(encoding="utf-8") == text
        print(f"{TARGET} is up to date" if current else f"{TARGET} is not up to date: run {__file__} PROGRAM")
        return int(not current)
    TARGET.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
