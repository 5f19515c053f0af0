"""Checks the documented numbers: each claim of claims.yaml is simulated again with other seeds and with its premises.

    claims.py pages ROOT                    the marked numbers of the pages are those of the claims (marks.py); nothing is simulated
    claims.py run PROGRAM ROOT [PATTERN] [--seeds FIRST LAST]
                                            runs the claims whose name contains PATTERN; prints what it finds

A value with `is` fails where it differs with one of the seeds, after rounding to the digits that the page has. One with `counts`, the
successes and trials behind the page, fails where the successes of all seeds together differ from them by more than chance (Fisher's exact
test). What is allowed follows from the numbers of trials, and not from the lowest and the highest seed that made the page. Pages have the
counts of seeds 11 to 20 (--seeds 11 20), and claims run others. Trials must be independent: set as many `machines` as `trials`.
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

import marks

LEVEL = 1e-4   # of Fisher's test: with a hundred values that are right, one fails with a probability of 1 %
CODE = 2.4e-4  # N m, a code of the converter of the paper's axis
UNITS = {"%": lambda value: 100 * value,
         "ms": lambda value: 1000 * value,
         "codes": lambda value: math.sqrt(value) / CODE}  # rms of a torque from its mean square
KEYS = {"at", "of", "mark", "row", "page", "in_words", "is", "within", "unit", "times", "counts"}  # of a value in claims.yaml
NUMBER = re.compile(r"\d[\d ]*(?:\.\d+)?")


def load(root):
    """The contents of claims.yaml."""
    return yaml.safe_load((root / "tests/claims/claims.yaml").read_text(encoding="utf-8"))


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


def values_of(claim):
    """All values of the claim's checks."""
    return [value for check in claim["checks"] for value in check["values"]]


def notations(value):
    """How a page may write the value. If it has counts: with bounds, as its own page must, or without."""
    if "counts" not in value:
        return [str(value["is"])]
    with_bounds = cell(*value["counts"])
    return [with_bounds, with_bounds.partition(" [")[0]]


def is_word(value):
    """Whether the value is a word, such as the status of a goal."""
    return "counts" not in value and not re.search(r"\d", str(value["is"]))


def limits_of(value):
    """The range of numbers, in the unit of the page, that agree with the value: those that are rounded to it, or `within`."""
    if "within" in value:
        return tuple(map(float, value["within"]))
    stated = NUMBER.findall(str(value["is"]))
    half = 0.5 * 10.0 ** -max(len(number.partition(".")[2]) for number in stated)
    numbers = [float(number.replace(" ", "")) for number in stated]
    return min(numbers) - half, max(numbers) + half


def unclear_values(name, claim):
    """Messages about values without a mark or words, with unknown keys, without their unit, or outside their own limits."""
    for value in values_of(claim):
        if unknown := set(value) - KEYS:
            yield f"{name}: {value['of']} has unknown keys: {', '.join(sorted(unknown))}"
        if ("is" in value) == ("counts" in value):
            yield f"{name}: {value['of']} needs either `is` or `counts`"
            continue
        if not is_word(value) and "counts" not in value and value["of"].endswith("rate") and value.get("unit") != "%":
            yield f"{name}: {value['of']} is a proportion; state it with unit: \"%\""
        if not is_word(value) and not {"mark", "row", "in_words"} & set(value):
            yield f"{name}: {value['of']} has no `mark`, `row` or `in_words`"
        if "within" in value:
            low, high = value["within"]
            outside = [number for number in NUMBER.findall(str(value["is"])) if not low <= float(number.replace(" ", "")) <= high]
            if outside:
                yield f"{name}: {', '.join(outside)} is not within {low} to {high}"


def claimed_numbers(documented):
    """What claims.yaml says must stand beside each mark: (name, marks.Numbers)."""
    for name, figure in documented["figures"].items():
        yield name, marks.Numbers([[str(figure["is"])]], pages=figure["pages"])
    for command in documented["read_by_commands"].values():
        yield from ((name, marks.Numbers([])) for name in command)
    for claim in documented["claims"].values():
        rows = {}
        for value in values_of(claim):
            if "mark" in value:
                yield value["mark"], marks.Numbers([notations(value)], pages=[value.get("page", claim["page"])])
            if "row" in value:
                rows.setdefault(value["row"], []).append(notations(value))
        yield from ((name, marks.Numbers(numbers, is_row=True, pages=[claim["page"]])) for name, numbers in rows.items())


def check_pages(root):
    """What differs between the pages and claims.yaml; one message each."""
    documented, claims, messages = load(root), {}, []
    for name, numbers in claimed_numbers(documented):
        if claims.setdefault(name, numbers) != numbers:
            messages.append(f"{name}: claims.yaml has two numbers with this name")
    for name, claim in documented["claims"].items():
        messages += unclear_values(name, claim)
    for page, text in marks.pages_of(root).items():
        messages += [f"{page}: {comment}: write <!-- claim: NAME -->" for comment in marks.misspelled_marks(text)]
    return messages + list(marks.problems(marks.marks_of(root), claims))


def manifest_of(claim, root):
    """The text of the claim's manifest: a shipped one, or the example of a page."""
    source = claim["manifest"]
    if not source.endswith(".md"):
        return (root / f"experiments/manifests/{source}.yaml").read_text(encoding="utf-8")
    blocks = re.findall(r"```yaml\n(zerocount: 1\b.*?)```", (root / source).read_text(encoding="utf-8"), re.S)
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


def in_unit_of_page(found, value):
    """The value that was found, in the unit in which the page states it. None, which is later than any time, is infinite."""
    convert = UNITS[value["unit"]] if "unit" in value else float
    return float("inf") if found is None else value.get("times", 1) * convert(found)


def judged_counts(points, value):
    """Whether the successes of all seeds together agree with the page's, and both as text."""
    is_rate = value["of"].endswith("rate")
    found = sum(round(x * trials) if is_rate else x for x, trials in points), sum(trials for _, trials in points)
    table = [[successes, trials - successes] for successes, trials in (found, value["counts"])]
    return stats.fisher_exact(table).pvalue >= LEVEL, f"{found[0]} of {found[1]}, {cell(*found)}; stated {cell(*value['counts'])}"


def judged_range(points, value):
    """Whether the value of each seed is what is stated, and all as text."""
    if is_word(value):
        values = [found for found, _ in points]
        return all(found == value["is"] for found in values), f"{', '.join(map(str, values))}; stated {value['is']}"
    low, high = limits_of(value)
    values = [in_unit_of_page(found, value) for found, _ in points]
    shown = ", ".join(f"{number:.4g}" for number in values)
    return all(low <= number <= high for number in values), f"{shown}; stated {value['is']} ({low:.6g} to {high:.6g})"


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
