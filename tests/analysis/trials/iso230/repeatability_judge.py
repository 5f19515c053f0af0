"""ISO 230-2 by intervals, apart from the C++ code.

repeatability_judge.py runs FILE            values of the runs in a JSON file, as JSON
repeatability_judge.py file FOLDER README   checks /repeatability of FOLDER/study.h5, summary.json and summary.csv;
                                            facts.json has the sequence and the targets, phase and resolution of
                                            every trial; README documents the group
"""

import csv
import functools
import json
import pathlib
import re
import sys
import warnings

import h5py
import netCDF4
import numpy
import scipy.stats


def band(deviations):
    """What the standard expects of one direction: the interval of two standard uncertainties about the mean."""
    deviations = numpy.asarray(deviations, dtype=float)
    spread = deviations.std(ddof=1) if len(deviations) > 1 else numpy.nan
    return deviations.mean() - 2 * spread, deviations.mean() + 2 * spread


def target_values(positive, negative):
    low_up, high_up = band(positive)
    low_down, high_down = band(negative)
    middle_up, middle_down = numpy.mean(positive), numpy.mean(negative)
    return {
        "mean_positive": middle_up,
        "mean_negative": middle_down,
        "mean": numpy.mean([middle_up, middle_down]),
        "reversal": middle_up - middle_down,
        "uncertainty_positive": (high_up - low_up) / 4,
        "uncertainty_negative": (high_down - low_down) / 4,
        "repeatability_positive": high_up - low_up,
        "repeatability_negative": high_down - low_down,
        "repeatability": numpy.maximum(high_up, high_down) - numpy.minimum(low_up, low_down),  # of both bands
    }


def axis_values(run):
    targets = [target_values(*target) for target in run]
    column = lambda name: numpy.array([target[name] for target in targets])
    bands_up = numpy.array([band(positive) for positive, _ in run])
    bands_down = numpy.array([band(negative) for _, negative in run])
    means = numpy.stack([column("mean_positive"), column("mean_negative")])
    axis = {
        "reversal": numpy.abs(column("reversal")).max(),
        "mean_reversal": column("reversal").mean(),
        "repeatability_positive": column("repeatability_positive").max(),
        "repeatability_negative": column("repeatability_negative").max(),
        "repeatability": column("repeatability").max(),
        "systematic_positive": numpy.ptp(means[0]),
        "systematic_negative": numpy.ptp(means[1]),
        "systematic": numpy.ptp(means),
        "mean_bidirectional": numpy.ptp(means.mean(axis=0)),
        "accuracy_positive": numpy.ptp(bands_up),
        "accuracy_negative": numpy.ptp(bands_down),
        "accuracy": numpy.ptp(numpy.stack([bands_up, bands_down])),
    }
    return {"axis": axis, "targets": targets}


STATISTICS = ["mean", "median", "median_low", "median_high", "p95", "p95_low", "p95_high", "max"]
STATISTICS_OF_TARGETS = ["median", "p95"]
UNITS = {"true": "rad", "encoder": "count"}


def runs_of(facts, outcome):
    """The deviations of every trial by source, [target][direction][cycle]; None where a move was lost."""
    targets = 1 + max(target for target, _ in facts["sequence"])
    for row, trial in enumerate(facts["rows"]):
        runs = {source: [([], []) for _ in range(targets)] for source in UNITS}
        lost = (outcome["outcome"][row] == 3).any()
        for move, (target, direction) in enumerate(facts["sequence"]):
            if target < 0 or lost:
                continue
            in_counts = outcome["final_position"][row, move] / trial["resolution"] + trial["phase"]
            side = 0 if direction > 0 else 1
            beside = in_counts - trial["targets"][move]
            runs["true"][target][side].append((beside - 0.5) * trial["resolution"])
            runs["encoder"][target][side].append(-float(outcome["final_error"][row, move]))
        yield None if lost else runs


def expect(actual, expected, what, scale=1.0):
    close = numpy.isclose(actual, expected, rtol=1e-9, atol=1e-9 * scale, equal_nan=True)
    assert numpy.all(close), f"{what}: {actual}; expected {expected}"


@functools.cache
def rank_bounds(n, probability):
    """Ranks of the order statistics that bound a quantile; none is 0, or n + 1."""
    ranks = numpy.arange(1, n + 1)
    below = scipy.stats.binom(n, probability)
    low = ranks[below.cdf(ranks - 1) <= 0.025]
    high = ranks[below.sf(ranks - 1) <= 0.025]
    return low.max(initial=0), high.min(initial=n + 1)


def statistics(values):
    values = numpy.sort(values[~numpy.isnan(values)])
    result = dict.fromkeys(STATISTICS, numpy.nan)
    if not len(values):
        return result
    result["mean"], result["max"] = values.mean(), values.max()
    for name, probability in (("median", 0.5), ("p95", 0.95)):
        result[name] = numpy.quantile(values, probability, method="inverted_cdf")
        low, high = rank_bounds(len(values), probability)
        result[name + "_low"] = values[low - 1] if low >= 1 else numpy.nan
        result[name + "_high"] = values[high - 1] if high <= len(values) else numpy.nan
    return result


def check_trials(group, facts, outcome):
    """Compares the values of the trials; returns the names of those of the axis and of a target."""
    names = None
    for row, runs in enumerate(runs_of(facts, outcome)):
        assert group["trial/evaluated"][row] == (runs is not None)
        listed = {target: position for (target, _), position in zip(facts["sequence"], facts["rows"][row]["targets"])}
        listed.pop(-1)
        expect(group["trial_target/position"][row], [listed[i] for i in sorted(listed)], f"position of {row}")
        for source in UNITS:
            judged = axis_values(runs[source]) if runs else None
            names = names or judged
            scale = facts["rows"][row]["resolution"] if source == "true" else 1.0
            for name in names["axis"]:
                value = judged["axis"][name] if runs else numpy.nan
                expect(group[f"trial/{source}/{name}"][row], value, f"{source} {name} of {row}", scale)
            for name in names["targets"][0]:
                value = [target[name] for target in judged["targets"]] if runs else numpy.nan
                expect(group[f"trial_target/{source}/{name}"][row], value, f"{source} {name} of {row}", scale)
    return list(names["axis"]), list(names["targets"][0])


def below(group, name):
    """What stands in a group of the datasets."""
    return {path.removeprefix(name + "/"): values for path, values in group.items() if path.startswith(name + "/")}


def check_point(group, facts, point, axis_names, target_names):
    rows = slice(point * facts["trials"], (point + 1) * facts["trials"])
    of_axis, of_targets = below(group, "point"), below(group, "point_target")
    expect(of_axis["trials"][point], facts["trials"], "trials")
    expect(of_axis["evaluated"][point], group["trial/evaluated"][rows].sum(), "evaluated")
    sides = {direction for target, direction in facts["sequence"] if target >= 0}
    overall = {1: "repeatability_positive", -1: "repeatability_negative"}
    name = "repeatability" if len(sides) == 2 else overall[sides.pop()]
    repeatability = group[f"trial/encoder/{name}"][rows]
    zero = (repeatability == 0).sum()
    if numpy.isnan(repeatability).all():
        assert numpy.isnan(of_axis["zero_repeatability"][point])
        assert numpy.isnan(of_axis["zero_repeatability_rate"][point])
    else:
        expect(of_axis["zero_repeatability"][point], zero, "zero")
        bounds = scipy.stats.binomtest(int(zero), facts["trials"]).proportion_ci(0.95, "exact")
        expect(of_axis["zero_repeatability_rate"][point], zero / facts["trials"], "rate")
        expect(of_axis["zero_repeatability_rate_low"][point], bounds.low, "lower bound")
        expect(of_axis["zero_repeatability_rate_high"][point], bounds.high, "upper bound")
    positions = group["trial_target/position"][rows]
    expect(of_targets["position_min"][point], positions.min(axis=0), "smallest position")
    expect(of_targets["position_max"][point], positions.max(axis=0), "largest position")
    for source in UNITS:
        for name in axis_names:
            judged = statistics(group[f"trial/{source}/{name}"][rows])
            for statistic in STATISTICS:
                what = f"{source}/{name}_{statistic}"
                expect(of_axis[what][point], judged[statistic], what, 1e-6)
        for name in target_names:
            values = group[f"trial_target/{source}/{name}"][rows]
            for target in range(values.shape[1]):
                judged = statistics(values[:, target])
                for statistic in STATISTICS_OF_TARGETS:
                    what = f"{source}/{name}_{statistic}"
                    expect(of_targets[what][point, target], judged[statistic], what, 1e-6)


def number(value):
    return numpy.nan if value is None else float(value)


def check_summary(group, folder, points, axis_names, target_names):
    summary = json.loads((folder / "summary.json").read_text())["points"]
    with open(folder / "summary.csv", newline="") as file:
        lines = list(csv.DictReader(file))

    def same(stored, told):
        assert stored == told or (numpy.isnan(stored) and numpy.isnan(told)), f"{stored} is told as {told}"

    for point in range(points):
        told, line = summary[point]["repeatability"], lines[point]
        rate = "zero_repeatability_rate"
        for name in ("trials", "evaluated", "zero_repeatability", rate, rate + "_low", rate + "_high"):
            same(group[f"point/{name}"][point], number(told[name]))
            same(group[f"point/{name}"][point], float(line[f"repeatability_{name}"]))
        for source, unit in UNITS.items():
            assert told[source]["unit"] == unit
            assert list(told[source]["axis"]) == axis_names
            for name in axis_names:
                assert list(told[source]["axis"][name]) == STATISTICS
                for statistic in STATISTICS:
                    stored = group[f"point/{source}/{name}_{statistic}"][point]
                    same(stored, number(told[source]["axis"][name][statistic]))
                    same(stored, float(line[f"repeatability_{source}_{name}_{statistic}"]))
            for index, target in enumerate(told[source]["targets"]):
                assert target["target"] == index
                same(group["point_target/position_max"][point, index], target["position_max"])
                for name in target_names:
                    assert list(target[name]) == STATISTICS_OF_TARGETS
                    for statistic in STATISTICS_OF_TARGETS:
                        stored = group[f"point_target/{source}/{name}_{statistic}"][point, index]
                        same(stored, number(target[name][statistic]))
                        same(stored, float(line[f"repeatability_{source}_target_{index}_{name}_{statistic}"]))
        of_targets = len(told["true"]["targets"]) * len(target_names) * len(STATISTICS_OF_TARGETS)
        columns = 6 + len(UNITS) * (len(axis_names) * len(STATISTICS) + of_targets)
        assert sum(name.startswith("repeatability_") for name in line) == columns


def documented(readme, head):
    """The rows of the table in README whose first head it is, without the ticks."""
    text = readme.read_text()
    lines = text[text.index(f"| {head} |") :].splitlines()
    rows = []
    for line in lines[2:]:
        if not line.startswith("|"):
            return rows
        rows.append([cell.strip().replace("`", "") for cell in line.strip("|").split("|")])
    return rows


def check_documentation(group, readme, axis_names, target_names):
    words = {
        "source": [row[0] for row in documented(readme, "source")],
        "axis value": [row[0] for row in documented(readme, "value of the axis")],
        "target value": [row[0] for row in documented(readme, "value of a target")],
        "statistic": STATISTICS,
    }
    assert words["source"] == list(UNITS)
    assert words["axis value"] == axis_names and words["target value"] == target_names
    rows = documented(readme, "path in `/repeatability`")
    used = set()

    def check(name, item):
        if not isinstance(item, h5py.Dataset):
            return
        fitting = []
        for index, (path, *_) in enumerate(rows):
            pattern = re.escape(path)
            for word, values in words.items():
                pattern = pattern.replace(re.escape(f"<{word}>"), "(" + "|".join(values) + ")")
            if re.fullmatch(pattern, name):
                fitting.append(index)
        assert len(fitting) == 1, f"{name} is described {len(fitting)} times"
        used.add(fitting[0])
        _, kind, dimensions, unit = rows[fitting[0]]
        assert item.dtype.name == kind, name
        scales = [name.rsplit("/", 1)[-1]] if h5py.h5ds.is_scale(item.id) else []
        scales = scales or [dimension[0].name.rsplit("/", 1)[-1] for dimension in item.dims]
        assert ", ".join(scales) == dimensions, (name, scales)
        expected = UNITS.get(name.split("/")[1], "1") if unit == "own" else unit
        assert item.attrs["units"] == expected, name
        assert item.attrs["long_name"], name

    group.visititems(check)
    assert len(used) == len(rows), [row for index, row in enumerate(rows) if index not in used]


def check_dimensions(path):
    """The netCDF library finds the dimensions by name, also those that stand a group above."""
    with netCDF4.Dataset(path) as file:
        for table, dimensions in {
            "trial": ("trial",),
            "trial_target": ("trial", "target"),
            "point": ("point",),
            "point_target": ("point", "target"),
        }.items():
            for source in UNITS:
                for variable in file[f"repeatability/{table}/{source}"].variables.values():
                    assert variable.dimensions == dimensions, (table, variable.name, variable.dimensions)


def check_folder(folder, readme):
    check_dimensions(folder / "study.h5")
    facts = json.loads((folder / "facts.json").read_text())
    with h5py.File(folder / "study.h5") as file:
        group = file["repeatability"]
        outcome = {name: file["outcome"][name][:] for name in ("outcome", "final_position", "final_error")}
        values = {}
        group.visititems(lambda name, item: values.update({name: item[:]} if isinstance(item, h5py.Dataset) else {}))
        names = check_trials(values, facts, outcome)
        for point in range(facts["points"]):
            check_point(values, facts, point, *names)
        check_summary(values, folder, facts["points"], *names)
        check_documentation(group, readme, *names)


if __name__ == "__main__":
    warnings.simplefilter("ignore", RuntimeWarning)  # empty sides and single cycles have NaN, as they should
    if sys.argv[1] == "runs":
        with open(sys.argv[2]) as file:
            print(json.dumps([axis_values(run) for run in json.load(file)]))
    else:
        check_folder(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
