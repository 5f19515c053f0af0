"""Pages that the program itself tells: its commands, parameters, and the schemas of manifests and answers."""

import json
import re
import subprocess

NESTED = ("items", "additionalProperties")
DEPTH = 4


class Program:
    def __init__(self, path):
        self.path = path

    def says(self, *words):
        return subprocess.run([self.path, *words], capture_output=True, text=True, check=True, env={"COLUMNS": "96"}).stdout


def toctree(names):
    return "\n".join(["```{toctree}", ":hidden:", "", *names, "```", ""])


def code(text, language="text"):
    return f"```{language}\n{text.strip()}\n```\n"


def plain(text):
    """Text without meaning for Markdown, except names in backticks."""
    return re.sub(r"([\\*_<>\[\]|{}#])", r"\\\1", text)


def commands_of(program):
    """(name, what it does) of each command, in the order of --help."""
    return re.findall(r"^  (\w+) +(\S.*)$", program.says("--help").split("Exit codes")[0], re.MULTILINE)


def options(text):
    """A definition list of lines such as `  -o, --output FILE   the file`, with continued lines."""
    for line in text.splitlines():
        if match := re.match(r"  (\S.*?)(?:  +(\S.*))?$", line):
            yield f"\n`{match[1]}`\n: {plain(match[2] or '')}"
        elif line.strip():
            yield f"  {plain(line.strip())}"


def command_page(name, summary, program):
    usage, *rest = program.says(name, "--help").split("\n\n", 1)
    body = rest[0].removeprefix(summary).strip()
    body, _, tail = body.partition("\nOptions:\n")
    described = "\n".join(options(tail.partition("\nExit codes:")[0]))
    return f"# {name}\n\nzerocount {name}: {plain(summary)}.\n\n{code(usage)}\n{code(body)}\n## Options of {name}\n{described}\n"


def command_pages(program):
    commands = commands_of(program)
    rows = "".join(f"| [{name}]({name}.md) | {plain(summary)} |\n" for name, summary in commands)
    codes = program.says("--help").partition("Exit codes:")[2]
    index = f"# Commands\n\n| `zerocount …` | |\n| --- | --- |\n{rows}\n## Exit codes\n\n{code(codes)}\n"
    yield "index", index + toctree([name for name, _ in commands])
    for name, summary in commands:
        yield name, command_page(name, summary, program)


def parameter_page(program):
    def table(*words):
        return program.says("parameters", "--format", "markdown", *words).split("\n\n", 2)[2]
    return ("# Parameters\n\nWhich parameters are there, with which unit, default and range? As `zerocount parameters` prints them.\n\n"
            f"## Of a rotary axis\n\n{table()}\n## Of a linear axis\n\n{table('--axis', 'linear')}\n")


def limits(schema):
    """What a value must be, in words."""
    if "const" in schema:
        return f"always `{json.dumps(schema['const'])}`"
    if "enum" in schema:
        return " or ".join(f"`{json.dumps(value)}`" for value in schema["enum"])
    if "$ref" in schema:
        return f"`{schema['$ref'].rsplit('/', 1)[1]}`"
    for several in ("anyOf", "oneOf"):
        if several in schema and "properties" not in schema:
            return " or ".join(dict.fromkeys(filter(None, map(limits, schema[several]))))
    kinds = schema.get("type", [])
    words = [" or ".join([kinds] if isinstance(kinds, str) else kinds)]
    signs = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}
    words += [f"{sign} {schema[key]:g}" for key, sign in signs.items() if key in schema]
    if "items" in schema and isinstance(schema["items"], dict):
        words.append(f"of {limits(schema['items'])}")
    return " ".join(filter(None, words))


def entries(schema, depth=0):
    """A nested list of the members of an object."""
    required = schema.get("required", [])
    for key, member in schema.get("properties", {}).items():
        words = [f"`{key}`", f"({limits(member)})" if limits(member) else "", "required" if key in required and depth == 0 else "",
                 f"default `{json.dumps(member['default'])}`" if "default" in member else ""]
        text = ", ".join(filter(None, [" ".join(words[:2]).strip(), *words[2:]]))
        yield f"{'  ' * depth}- {text}{': ' + plain(member['description']) if 'description' in member else ''}"
        inner = [member, *(member[nested] for nested in NESTED if isinstance(member.get(nested), dict))]
        if depth + 1 < DEPTH:
            for deeper in inner:
                yield from entries(deeper, depth + 1)


def schema_page(program):
    schema = json.loads(program.says("schema"))
    head = ("# Schema of manifests\n\nWhich keys may a manifest have, with which values? Where a number may be uncertain, a distribution "
            "may stand in its place. The whole [JSON Schema](manifest-schema.json), as `zerocount schema` prints it, is for editors.\n")
    sections = []
    for key, member in schema["properties"].items():
        # `sweep` has the keys of all others again, and `conditions` those of the machine
        whole = list(entries(member)) if key not in ("sweep", "conditions") else []
        what = f"{limits(member)}. {plain(member.get('description', ''))}".strip()
        sections.append(f"## {key}\n\n{what}\n\n" + "\n".join(whole) + "\n")
    forms = [f"### {key}\n\n{limits(member)} {plain(member.get('description', ''))}\n\n" + "\n".join(entries(member)) + "\n"
             for key, member in schema["$defs"].items()]
    return head + "\n".join(sections) + "\n## Forms of values\n\n" + "\n".join(forms)


def answer_pages(program):
    schema = json.loads(program.says("schema", "--answers"))
    names = [form["$ref"].rsplit("/", 1)[1] for form in schema["oneOf"]]
    rows = "".join(f"- [{name}]({name}.md)\n" for name in names)
    yield "index", ("# Answers\n\nWhat is in the JSON that a command answers with `--format json`? The whole [JSON Schema](answers.json) is "
                    f"what `zerocount schema --answers` prints.\n\n{rows}\n" + toctree(names))
    for name in names:
        answer = schema["$defs"][name]
        yield name, f"# Answer of {name}\n\n{plain(answer.get('description', ''))}\n\n" + "\n".join(entries(answer)) + "\n"


def write(folder, program):
    for room, pages in (("commands", command_pages(program)), ("answers", answer_pages(program))):
        (folder / room).mkdir(parents=True)
        for name, text in pages:
            (folder / room / f"{name}.md").write_text(text, encoding="utf-8")
    (folder / "parameters.md").write_text(parameter_page(program), encoding="utf-8")
    (folder / "manifest-schema.md").write_text(schema_page(program), encoding="utf-8")
    (folder / "manifest-schema.json").write_text(program.says("schema"), encoding="utf-8")
    (folder / "answers/answers.json").write_text(program.says("schema", "--answers"), encoding="utf-8")
