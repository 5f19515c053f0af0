#!/usr/bin/env python3
"""Checks the documented numbers: each claim of claims.yaml is simulated again with other seeds and with its premises.

    claims.py pages ROOT                    each sentence of a claim, and each shared figure, stands in its pages
    claims.py run PROGRAM ROOT [PATTERN]    runs the claims whose name contains PATTERN; prints what it finds

A claim fails where a value lies outside the stated range with one of the seeds.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import yaml


def plain(text):
    """The text of a page without the line breaks and emphasis that a quotation does not repeat."""
    return re.sub(r"\s+", " ", text.replace("**", ""))


def load(root):
    """The claims and the shared figures of claims.yaml."""
    return yaml.safe_load((root / "tests/claims/claims.yaml").read_text(encoding="utf-8"))


def stated_sentences(documented):
    """Each (name, page, sentence) that must stand in a page."""
    for name, claim in documented["claims"].items():
        for page, sentences in claim["says"].items():
            yield from ((name, page, sentence) for sentence in sentences)
    for name, figure in documented["figures"].items():
        for page, sentence in figure["pages"].items():
            yield name, page, sentence.replace("{}", figure["value"])


def unsupported_numbers(claim):
    """The numbers of the claim's result that are in none of its sentences and settings."""
    number = re.compile(r"\d+(?:\.\d+)?")
    known = number.findall(json.dumps([claim["says"], claim.get("set"), claim["checks"]]))
    return sorted(set(number.findall(claim.get("result", ""))) - set(known))


def check_pages(root):
    """The sentences that a page no longer has, and the results with other numbers than the sentences; one message each."""
    documented = load(root)
    missing = [f"{page} does not say what claims.yaml has as {name}: {sentence}"
               for name, page, sentence in stated_sentences(documented)
               if plain(sentence) not in plain((root / page).read_text(encoding="utf-8"))]
    return missing + [f"{name}: its result has {', '.join(numbers)}, which no sentence or setting of it has"
                      for name, claim in documented["claims"].items() if (numbers := unsupported_numbers(claim))]


def manifest_of(claim, root):
    """The text of the claim's manifest: a shipped one, or the example of a page."""
    source = claim["manifest"]
    if not source.endswith(".md"):
        return (root / f"experiments/manifests/{source}.yaml").read_text(encoding="utf-8")
    blocks = re.findall(r"```yaml\n(zerocount: 1\n.*?)```", (root / source).read_text(encoding="utf-8"), re.S)
    return blocks[0]


def summary_of(program, manifest, settings):
    """The summary of the study, as `summary --format json` writes it."""
    with tempfile.TemporaryDirectory() as folder:
        path, file = pathlib.Path(folder) / "claim.yaml", pathlib.Path(folder) / "claim.h5"
        path.write_text(manifest, encoding="utf-8")
        options = [word for setting in settings for word in ("--set", setting)]
        subprocess.run([program, "run", path, "-o", file, *options], check=True, capture_output=True)
        answer = subprocess.run([program, "summary", file, "--format", "json"], check=True, capture_output=True)
    return json.loads(answer.stdout)


def is_at(point, wanted):
    """Whether the point has the label, or the values of the sweep."""
    if isinstance(wanted, str):
        return point["label"] == wanted
    return all(point["axes"].get(axis) == value for axis, value in wanted.items())


def value_at(summary, wanted, path):
    """The value of a dotted path at a point; `bands.1` is the band of one count. `moves` in front counts moves."""
    points = [point for point in summary["points"] if wanted is None or is_at(point, wanted)]
    if len(points) != 1:
        sys.exit(f"{summary['name']}: {len(points)} points are {wanted}")
    value = points[0]
    for key in path.split("."):
        if isinstance(value, list):
            value = next(entry for entry in value if str(entry["band"]) == key)
        else:
            value = value[key]
    return value


def is_within(value, expected):
    """A word must be equal; a number must lie in the range [low, high]. null is later than any time."""
    if isinstance(expected, str):
        return value == expected
    low, high = expected
    return low <= (float("inf") if value is None else value) <= high


def run_claim(program, root, name, claim):
    """Runs the claim's studies, prints each value beside its range, and returns how many values lie outside."""
    manifest = manifest_of(claim, root)
    failures = 0
    for check in claim["checks"]:
        settings = claim.get("set", []) + check.get("set", [])
        found = {}
        for seed in claim.get("seeds", [1, 2, 3, 4, 5]):
            summary = summary_of(program, manifest, settings + [f"seed={seed}"])
            for value in check["values"]:
                found.setdefault(json.dumps(value), []).append(value_at(summary, value.get("at"), value["of"]))
        for key, values in found.items():
            value = json.loads(key)
            outside = [v for v in values if not is_within(v, value["is"])]
            failures += len(outside)
            shown = ", ".join("–" if v is None else v if isinstance(v, str) else f"{v:.4g}" for v in values)
            print(f"{'FAIL' if outside else 'ok  '} {name} {check.get('set', [])} {value.get('at', '')} {value['of']}: "
                  f"{shown}; stated {value['is']}", flush=True)
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    modes = parser.add_subparsers(dest="mode", required=True)
    pages = modes.add_parser("pages")
    pages.add_argument("root", type=pathlib.Path)
    run = modes.add_parser("run")
    run.add_argument("program", type=pathlib.Path)
    run.add_argument("root", type=pathlib.Path)
    run.add_argument("pattern", nargs="?", default="")
    options = parser.parse_args()
    if options.mode == "pages":
        problems = check_pages(options.root)
        print("\n".join(problems))
        return 1 if problems else 0
    chosen = {name: claim for name, claim in load(options.root)["claims"].items() if options.pattern in name}
    if not chosen:
        sys.exit(f"no claim has {options.pattern} in its name")
    failures = sum(run_claim(options.program.resolve(), options.root, name, claim) for name, claim in chosen.items())
    print(f"{failures} values outside their ranges")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
