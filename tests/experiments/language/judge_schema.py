"""The JSON Schema: valid itself, accepts all good manifests, rejects bad ones."""

import copy
import json
import pathlib
import re
import subprocess
import sys

import yaml
from jsonschema import Draft202012Validator


class Loader(yaml.SafeLoader):
    """YAML with the numbers of YAML 1.2, as editors read it: 2.0e5 is a number."""


Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$"), list("-+.0123456789")
)


def changed(manifest, path, value):
    result = copy.deepcopy(manifest)
    node = result
    for key in path[:-1]:
        node = node.setdefault(key, {}) if isinstance(node, dict) else node[key]
    node[path[-1]] = value
    return result


def main():
    schema = json.loads(subprocess.check_output([sys.argv[1], "schema"]))
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)

    texts = {str(p): p.read_text() for p in sorted(pathlib.Path(sys.argv[2]).glob("*.yaml"))}
    if len(texts) < 6:
        sys.exit("the shipped manifests are not there")
    texts["full manifest"] = subprocess.check_output([sys.argv[1], "full_manifest"], text=True)
    for name, text in texts.items():
        errors = [e.message for e in validator.iter_errors(yaml.load(text, Loader))]
        if errors:
            sys.exit(f"{name} is refused: {errors}")

    good = yaml.load(texts["full manifest"], Loader)
    bad = [
        (["unknown"], 1),
        (["plant", "inertai"], 1),
        (["plant", "inertia"], 0),
        (["plant", "inertia"], "1"),
        (["plant", "inertia"], True),
        (["plant", "inertia"], {"profile": {"mean": 1, "cv": 0.1, "correlation_length": 1}}),
        (["friction", "k1"], {"unifrom": [1, 2]}),
        (["friction", "k1"], {"uniform": [1]}),
        (["friction", "k1"], {"uniform": [1, 2], "choice": [1]}),
        (["friction", "k1"], {"lognormal": {"median": 1}}),
        (["friction", "k1"], {"profile": {"mean": 1, "cv": 0.1, "correlation_length": 7}}),
        (["dac", "bits"], 33),
        (["dac", "bits"], 12.5),
        (["dac", "bits"], {"uniform": [1, 2]}),
        (["controller", "anti_windup"], "klamp"),
        (["command", "targets"], []),
        (["command", "targets"], 5),
        (["command", "targets"], [1.5]),
        (["zerocount"], 2),
        (["name"], 7),
        (["name"], ""),
        (["seed"], -1),
        (["trials"], 0),
        (["design"], "random"),
        (["independent_points"], "yes"),
        (["retain"], {"trials": [-1]}),
        (["observed"], {"a": 1}),
        (["sweep"], {"gird": {}}),
        (["sweep", "grid", "controller.kpp"], [1]),
        (["sweep", "grid", "controller.kp"], 1),
        (["sweep", "grid", "controller.kp"], []),
        (["sweep", "grid", "controller.kp"], [-1]),
        (["sweep", "grid", "controller.kp"], {"linspace": [0, 1, 1]}),
        (["sweep", "grid", "controller.kp"], {"logspace": [0, 1, 3]}),
        (["sweep", "grid", "command.targets.01"], [1]),
        (["sweep", "cases", "a"], {"controller.kpp": 1}),
        (["sweep", "cases", "a"], {"command.targets": 3}),
    ]
    for path, value in bad:
        if validator.is_valid(changed(good, path, value)):
            sys.exit(f"{'.'.join(path)}: {value} is accepted")
    for key in ("zerocount", "name", "seed", "trials", "command"):
        short = copy.deepcopy(good)
        del short[key]
        if validator.is_valid(short):
            sys.exit(f"a manifest without {key} is accepted")
    also_good = [
        (["sweep", "grid", "command.targets.0"], {"linspace": [1, 10, 10]}),
        (["sweep", "grid", "command.targets"], [[1, 2], [{"integers": [1, 2]}, 0]]),
        (["sweep", "grid", "controller.anti_windup"], ["clamp", "none"]),
        (["sweep", "cases", "c"], {"friction.k1": {"choice": [1, 2]}}),
        (["seed"], 2**64 - 1),
    ]
    for path, value in also_good:
        errors = [e.message for e in validator.iter_errors(changed(good, path, value))]
        if errors:
            sys.exit(f"{'.'.join(path)}: {value} is refused: {errors}")
    print(f"{len(texts)} manifests accepted, {len(bad) + 5} refused")


main()
