"""The JSON Schema: valid itself, accepts all good manifests, rejects bad ones; and the program judges likewise."""

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


def program_refuses(manifest):
    """What the program says of it; empty where it understands. JSON is YAML."""
    answer = subprocess.run(
        [sys.argv[1], "refusal"], input=json.dumps(manifest), stdout=subprocess.PIPE, text=True, check=True
    )
    return answer.stdout.strip()


def numbers_of(schema, path):
    """All schemas of numbers, words and truths below `schema`, by their paths."""
    for part in schema.get("anyOf", []):
        yield from numbers_of(part | {key: schema[key] for key in ("default",) if key in schema}, path)
    if "properties" in schema:
        for key, part in schema["properties"].items():
            yield from numbers_of(part, [*path, key])
    elif schema.get("type") in ("number", "integer", "boolean") or "enum" in schema:
        yield path, schema


def judge_limits(validator, schema):
    """A key that is not a parameter may have its default, and nothing beyond its limits: schema and program agree."""
    parts = {
        "goal": {"within": 0.05, "moves": 0.9},
        "stop": {"success_rate_halfwidth": 0.1, "max_trials": 100},
        "tune": {"free": {"controller.ki": [1, 2]}, "margins": {"gain": 6}},
        **{key: schema["properties"][key]["default"] for key in ("design", "independent_points", "keep")},
    }
    refused = 0
    for key, value in parts.items():
        manifest = {"zerocount": 1, "name": "x", "seed": 1, "trials": 10, "command": {"targets": [5]}, key: value}
        if key == "tune":
            manifest["goal"] = parts["goal"]
        good = [manifest]
        bad = []
        for path, number in numbers_of(schema["properties"][key], [key]):
            if "default" in number:
                good.append(changed(manifest, path, number["default"]))
            for limit, step in (("minimum", -1), ("exclusiveMinimum", 0), ("maximum", 1), ("exclusiveMaximum", 0)):
                if limit in number:
                    bad.append(changed(manifest, path, number[limit] + step))
        for one in good:
            if not validator.is_valid(one) or program_refuses(one):
                sys.exit(f"{one[key]} is refused: {program_refuses(one)}")
        for one in bad:
            if validator.is_valid(one) or not program_refuses(one):
                sys.exit(f"{one[key]} is accepted")
        refused += len(bad)
    return refused


def judge_extended(validator, extended):
    """The sections inside sections, and the three ways to command."""
    sequence = {"targets": [-5, 5], "overrun": 2}
    targets = {"targets": [5]}
    bad = [
        (["encoder", "fine_errors"], 1),
        (["encoder", "fine_errors", "noise"], -1),
        (["encoder", "fine_errors", "niose"], 1),
        (["encoder", "coarse_errors", "missed"], 1.1),
        (["encoder", "coarse_errors", "interpolation_period"], 0),
        (["dac", "gain_error"], -1),
        (["amplifier", "bandwidth"], -1),
        (["controller", "coarse", "encoder"], "middle"),
        (["controller", "coarse", "coarse_beyond"], 1e13),
        (["controller", "coarse", "delay"], 1),
        (["controller", "coarse.kp"], 1),
        (["controller", "deadband"], -1),
        (["controller", "deadband"], "off"),
        (["controller", "deadband"], {"entr": 1}),
        (["controller", "integrator_leak"], 0),
        (["controller", "structure"], "pi"),
        (["controller", "observer"], {"bandwidth": "none"}),
        (["sweep", "grid", "controller.deadband"], [[1]]),
        (["friction", "model"], "stribeck"),
        (["friction", "model"], {"choice": [0, 1]}),
        (["initial", "history"], 3),
        (["initial", "history", "reversals"], 1001),
        (["initial", "history", "reversals"], 2.5),
        (["initial", "history", "torque"], -0.1),
        (["initial", "mode"], "slip"),
        (["command"], {}),
        (["command"], {"hold": 1}),
        (["command"], targets | {"torque": {"levels": [0.1]}}),
        (["command"], targets | {"sequence": sequence}),
        (["command"], {"sequence": sequence, "torque": {"levels": [0.1]}}),
        (["command"], {"torque": {"rate": 1}}),
        (["command"], {"reference": {"column": "r"}}),
        (["command"], targets | {"reference": {"file": "r.csv"}}),
        (["command"], {"torque": {"levels": []}}),
        (["command"], {"torque": {"levels": 0.1}}),
        (["command"], {"torque": {"levels": [0.1], "rate": 0}}),
        (["command"], {"torque": {"levels": [0.1], "through": "wire"}}),
        (["command"], {"sequence": {"targets": [1, 2]}}),
        (["command"], {"sequence": {"overrun": 2}}),
        (["command"], {"sequence": sequence | {"overrun": 0}}),
        (["command"], {"sequence": sequence | {"targets": [1.5]}}),
        (["command"], {"sequence": sequence | {"cycles": 0}}),
        (["command"], {"sequence": sequence | {"cycles": {"integers": [1, 2]}}}),
        (["command"], {"sequence": sequence | {"approach": "both"}}),
        (["command"], {"sequence": sequence | {"direction": 1}}),
        (["command"], targets | {"profile": {"shape": "round"}}),
        (["command"], targets | {"profile": {"shape": "s_curve", "jerk_limit": 0}}),
        (["sweep", "grid", "controller.coarse"], [{"kp": 1}]),
        (["sweep", "grid", "command.sequence.cycles"], [1, 2]),
        (["sweep", "grid", "controller.coarse.encoder"], {"linspace": [0, 1, 2]}),
        (["sweep", "cases", "a"], {"initial": {"mode": "slide"}}),
        (["friction", "gms"], {"stiffness": [1]}),
        (["friction", "gms"], {"stiffness": [0], "weight": [1]}),
        (["friction", "gms"], {"stiffness": [], "weight": []}),
        (["controller", "filters"], {"lowpass": {"frequency": 100, "damping": 1}}),
        (["controller", "filters"], [{"lowpass": {"frequency": 100}}]),
        (["controller", "filters"], [{"lowpass": {"frequency": 100, "damping": 0}}]),
        (["controller", "filters"], [{"lowpass": {"frequency": 100, "damping": 1, "depth": 1}}]),
        (["controller", "filters"], [{"bandpass": {"frequency": 100}}]),
        (["controller", "filters"], [{"lead": {"frequency": 100, "ratio": 4}, "lowpass": {"frequency": 100, "damping": 1}}]),
        (["controller", "filters"], [{"biquad": {"b": [1, 0], "a": [0, 0]}}]),
        (["controller", "filters"], 9 * [{"lead": {"frequency": 100, "ratio": 4}}]),
        (["sweep", "grid", "controller.filters.0.fequency"], [1, 2]),
        (["sweep", "grid", "controller.filters.#.frequency"], [1, 2]),
    ]
    for path, value in bad:
        manifest = changed(extended, path, value)
        if validator.is_valid(manifest):
            sys.exit(f"{'.'.join(path)}: {value} is accepted by the schema")
        if not program_refuses(manifest):
            sys.exit(f"{'.'.join(path)}: {value} is accepted by the program")
    good = [
        (["command"], {"sequence": sequence}),
        (["command"], {"sequence": sequence | {"cycles": 3, "approach": "negative", "overrun": {"integers": [1, 9]}}}),
        (["command"], targets),
        (["command"], {"units": "si", "sequence": {"targets": [-1.0e-3, {"uniform": [0, 1.0e-4]}], "overrun": 1.0e-4}}),
        (["command"], {"units": "si", "targets": [1.0e-3, {"triangular": [0, 1.0e-4, 2.0e-4]}]}),
        (["sweep", "grid", "encoder.fine_errors.noise"], {"linspace": [0, 1, 3]}),
        (["sweep", "grid", "command.sequence.targets.0"], [-4000, {"integers": [-3900, -3800]}]),
        (["sweep", "cases", "b"], {"controller.coarse.encoder": "fine", "initial.history.torque": 0.1}),
        (["initial", "history", "reversals"], {"integers": [1, 1000]}),
        (["controller", "coarse", "coarse_beyond"], {"integers": [100, 200]}),
        (["friction", "gms"], {"stiffness": [100, {"uniform": [1, 2], "per": "study"}], "weight": [0.25, 0.75]}),
        (["controller", "filters"], [{"notch": {"frequency": {"uniform": [1, 2]}, "damping": 0.5, "depth": 0}}]),
        (["controller", "coarse", "filters"], [{"biquad": {"b": [1, 0, 0], "a": [0, {"normal": {"mean": 0, "sd": 1}}]}}]),
        (["controller", "deadband"], 1),
        (["controller", "deadband"], "none"),
        (["controller", "deadband"], {"uniform": [0, 2]}),
        (["controller", "deadband"], {"enter": 1, "leave": "none"}),
        (["controller", "integrator_leak"], "none"),
        (["controller", "observer"], {"bandwidth": 20, "inertia": 1e-3}),
        (["sweep", "grid", "controller.deadband"], ["none", 0, 1]),
        (["sweep", "grid", "controller.deadband.enter"], {"linspace": [0, 2, 3]}),
    ]
    for path, value in good:
        manifest = changed(extended, path, value)
        errors = [e.message for e in validator.iter_errors(manifest)]
        if errors:
            sys.exit(f"{'.'.join(path)}: {value} is refused by the schema: {errors}")
        if program_refuses(manifest):
            sys.exit(f"{'.'.join(path)}: {value} is refused by the program: {program_refuses(manifest)}")
    torque = {k: v for k, v in extended.items() if k in ("zerocount", "name", "seed", "trials", "friction", "amplifier")}
    torque["command"] = {"torque": {"levels": [0.1, {"uniform": [-0.2, -0.1]}], "rate": 0.2, "through": "exact"}, "hold": 0.5}
    torque["sweep"] = {"grid": {"command.torque.levels.0": {"linspace": [0.1, 0.2, 3]}, "command.torque.through": ["exact", "dac"]}}
    filters = copy.deepcopy(extended)
    filters["controller"]["filters"] = [{"lead": {"frequency": 100, "ratio": 4}}, {"biquad": {"b": [1, 0, 0], "a": [0, 0]}}]
    filters["sweep"]["grid"] |= {"controller.filters.0.frequency": {"linspace": [100, 200, 3]}, "controller.filters.1.b": [[1, 0, 0]]}
    filters["sweep"]["cases"] = {"a": {"controller.filters.1.a.1": 0.5}}
    schema_only = copy.deepcopy(extended)  # the program has no library to load here
    schema_only["controller"] |= {"plugin": "own.so", "parameters": {"gain": {"uniform": [1, 5], "per": "study"}, "a_2": -3}}
    schema_only["sweep"] = {"grid": {"controller.parameters.gain": {"linspace": [1, 2, 3]}}, "cases": {"a": {"controller.parameters.a_2": 1}}}
    if not validator.is_valid(schema_only):
        sys.exit("the schema refuses a plugin")
    schema_only["controller"]["parameters"] = {"Gain": 1}
    if validator.is_valid(schema_only):
        sys.exit("the schema accepts a name that no parameter of a plugin has")
    for manifest in (extended, torque, filters):
        errors = [e.message for e in validator.iter_errors(manifest)]
        if errors or program_refuses(manifest):
            sys.exit(f"a good manifest is refused: {errors} {program_refuses(manifest)}")
    return len(bad)


def main():
    schema = json.loads(subprocess.check_output([sys.argv[1], "schema"]))
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)

    texts = {str(p): p.read_text() for p in sorted(pathlib.Path(sys.argv[2]).parent.rglob("*.yaml"))}
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
        (["friction", "k1"], {"profile": {"mean": 1, "cv": 0.1, "correlation_length": 0}}),
        (["friction", "k1"], {"uniform": [1, 2], "per": "move"}),
        (["friction", "k1"], {"per": "trial"}),
        (["friction", "k1"], {"profile": {"mean": {"uniform": [1, 2], "per": "study"}, "cv": 0.1, "correlation_length": 1}}),
        (["machines"], 1),
        (["machines"], 2.5),
        (["dac", "bits"], 33),
        (["dac", "bits"], 12.5),
        (["dac", "bits"], {"uniform": [1, 2]}),
        (["controller", "anti_windup"], "klamp"),
        (["verdict"], {"stop": 1}),
        (["verdict"], {"stop": "true"}),
        (["verdict"], {"stop": {"choice": [True, False]}}),
        (["verdict"], {"stop": True, "limit": 1}),
        (["verdict"], {"stop": True, "limit": True}),
        (["sweep", "grid", "verdict.stop"], ["true"]),
        (["sweep", "grid", "verdict.stop"], {"linspace": [0, 1, 2]}),
        (["command", "targets"], []),
        (["command", "targets"], 5),
        (["command", "targets"], [1.5]),
        (["command", "units"], "rad"),
        (["command"], {"units": "counts", "targets": [1.5]}),
        (["command"], {"units": "si", "targets": ["1"]}),
        (["command"], {"units": "si", "sequence": {"targets": [0, 1.0e-3], "overrun": 0}}),
        (["command"], {"sequence": {"targets": [0, 4], "overrun": 0.5}}),
        (["dac", "range"], 0),
        (["zerocount"], 2),
        (["name"], 7),
        (["name"], ""),
        (["seed"], -1),
        (["trials"], 0),
        (["design"], "random"),
        (["independent_points"], "yes"),
        (["retain"], {"trials": [-1]}),
        (["observed"], {"a": 1}),
        (["observed"], {"a": {"successes": 1}}),
        (["observed"], {"a": {"successes": -1, "of": 2}}),
        (["observed"], {"a": {"successes": 1, "of": 2, "on": 3}}),
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
        if not program_refuses(changed(good, path, value)):
            sys.exit(f"{'.'.join(path)}: {value} is accepted by the program")
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
        (["verdict"], {"stop": True, "limit": {"uniform": [500, 2000]}}),
        (["sweep", "grid", "verdict.stop"], [True, False]),
        (["seed"], 2**64 - 1),
        (["machines"], 10),
        (["dac"], {"bits": 14, "range": {"uniform": [0.4, 0.5]}}),
        (["dac", "range"], "none"),
        (["friction", "k1"], {"per": "contact", "uniform": [1, 2]}),
        (["friction", "k1"], {"profile": {"mean": {"uniform": [1, 2]}, "cv": 0.1, "correlation_length": 1}, "per": "study"}),
    ]
    for path, value in also_good:
        manifest = changed(good, path, value)
        del manifest["observed"]  # the labels of other points
        errors = [e.message for e in validator.iter_errors(manifest)]
        if errors or program_refuses(manifest):
            sys.exit(f"{'.'.join(path)}: {value} is refused: {errors} {program_refuses(manifest)}")
    extended = yaml.load(subprocess.check_output([sys.argv[1], "extended_manifest"], text=True), Loader)
    refused = len(bad) + 5 + judge_extended(validator, extended) + judge_limits(validator, schema)
    print(f"{len(texts) + 2} manifests accepted, {refused} refused")


main()
