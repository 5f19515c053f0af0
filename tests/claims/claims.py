#!/usr/bin/env python3
"""Checks the documented numbers: each claim of claims.yaml is simulated again with other seeds and with its premises.

    claims.py pages ROOT                    each sentence of a claim, and each shared figure, stands in its pages
    claims.py run PROGRAM ROOT [PATTERN] [--seeds FIRST LAST]
                                            runs the claims whose name contains PATTERN; prints what it finds

A value with a range fails where it lies outside with one of the seeds. One with `counts`, the successes and trials behind the page,
fails where the successes of all seeds together differ from them by more than chance (Fisher's exact test). What is allowed follows from
the numbers of trials, and not from the lowest and the highest seed that made the page. Pages have the counts of seeds 11 to 20
(--seeds 11 20), and claims run others. Trials must be independent: set as many `machines` as `trials`.
"""
import argparse
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import yaml
from scipy import stats

LEVEL = 1e-4   # of Fisher's test: with a hundred values that are right, one fails with a probability of 1 %


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


def cell(successes, trials):
    """The rate in % with its 95 % bounds after Clopper and Pearson, rounded outwards, as pages state it: 56.4 [55.0, 57.8]."""
    def text(tenths):
        return f"{tenths / 10:.1f}" if 0 < tenths < 1000 else f"{tenths / 10:.0f}"

    failures = trials - successes
    low = stats.beta.ppf(0.025, successes, failures + 1) if successes else 0
    high = stats.beta.ppf(0.975, successes + 1, failures) if failures else 1
    rate = 100 * successes / trials
    shown = f"{rate:.2f}" if 0 < rate < 0.05 or 99.95 <= rate < 100 else text(round(10 * rate))
    return f"{shown} [{text(math.floor(1000 * low))}, {text(math.ceil(1000 * high))}]"


def unstated_values(claim):
    """The cells of the claim's counts that none of its sentences has."""
    sentences = " ".join(sentence for page in claim["says"].values() for sentence in page)
    cells = [cell(*value["counts"]) for check in claim["checks"] for value in check["values"] if "counts" in value]
    return [text for text in cells if text not in sentences]


def check_pages(root):
    """The sentences that a page no longer has, and the results with other numbers than the sentences; one message each."""
    documented = load(root)
    missing = [f"{page} does not say what claims.yaml has as {name}: {sentence}"
               for name, page, sentence in stated_sentences(documented)
               if plain(sentence) not in plain((root / page).read_text(encoding="utf-8"))]
    missing += [f"{name}: no sentence of it says {text}"
                for name, claim in documented["claims"].items() for text in unstated_values(claim)]
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
    """The value of a dotted path at a point; `bands.1` is the band of one count, `tolerances.1e-05` the tolerance of 10 µrad or µm."""
    points = [point for point in summary["points"] if wanted is None or is_at(point, wanted)]
    if len(points) != 1:
        sys.exit(f"{summary['name']}: {len(points)} points are {wanted}")
    value = points[0]
    for key in path.split("."):
        if isinstance(value, list):
            value = next(entry for entry in value if str(entry.get("band", entry.get("tolerance"))) == key)
        else:
            value = value[key]
    return value


def is_within(value, expected):
    """A word must be equal; a number must lie in the range [low, high]. null is later than any time."""
    if isinstance(expected, str):
        return value == expected
    low, high = expected
    return low <= (float("inf") if value is None else value) <= high


def judged_counts(points, value):
    """Whether the successes of all seeds together agree with the page's, and both as text."""
    is_rate = value["of"].endswith("rate")
    found = sum(round(x * trials) if is_rate else x for x, trials in points), sum(trials for _, trials in points)
    table = [[successes, trials - successes] for successes, trials in (found, value["counts"])]
    return stats.fisher_exact(table).pvalue >= LEVEL, f"{found[0]} of {found[1]}, {cell(*found)}; stated {cell(*value['counts'])}"


def judged_range(points, value):
    """Whether the value of each seed lies within the stated range, and all as text."""
    values = [found for found, _ in points]
    shown = ", ".join("–" if v is None else v if isinstance(v, str) else f"{v:.4g}" for v in values)
    return all(is_within(v, value["is"]) for v in values), f"{shown}; stated {value['is']}"


def run_claim(program, root, name, claim, seeds):
    """Runs the claim's studies, prints each value beside what is stated, and returns how many values disagree."""
    manifest = manifest_of(claim, root)
    failures = 0
    for check in claim["checks"]:
        settings = claim.get("set", []) + check.get("set", [])
        summaries = [summary_of(program, manifest, settings + [f"seed={seed}"]) for seed in seeds or claim.get("seeds", [1, 2, 3, 4, 5])]
        for value in check["values"]:
            points = [tuple(value_at(summary, value.get("at"), path) for path in (value["of"], "trials")) for summary in summaries]
            agrees, text = (judged_counts if "counts" in value else judged_range)(points, value)
            failures += not agrees
            print(f"{'ok  ' if agrees else 'FAIL'} {name} {check.get('set', [])} {value.get('at', '')} {value['of']}: {text}", flush=True)
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
    run.add_argument("--seeds", nargs=2, type=int, metavar=("FIRST", "LAST"), help="in place of the claim's seeds")
    options = parser.parse_args()
    if options.mode == "pages":
        problems = check_pages(options.root)
        print("\n".join(problems))
        return 1 if problems else 0
    chosen = {name: claim for name, claim in load(options.root)["claims"].items() if options.pattern in name}
    if not chosen:
        sys.exit(f"no claim has {options.pattern} in its name")
    seeds = range(options.seeds[0], options.seeds[1] + 1) if options.seeds else None
    failures = sum(run_claim(options.program.resolve(), options.root, name, claim, seeds) for name, claim in chosen.items())
    print(f"{failures} values disagree with the pages")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
