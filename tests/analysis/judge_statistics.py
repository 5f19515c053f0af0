"""Statistics against NumPy and SciPy, from the raw outcomes.

usage: judge_statistics.py means CASES      (lines of: mean sd low high confidence  x1 x2 …)
       judge_statistics.py proportions CASES  (lines of: confidence low high wilson_low wilson_high at_least  k1 n1 …)
       judge_statistics.py quantiles CASES    (lines of: probability size value low high  x11 … x1size x21 …)
       judge_statistics.py observed CASES   (lines of: p k n successes simulated  p trials of a machine, successes of each)
       judge_statistics.py loop FILE.h5     (/point against /outcome)
       judge_statistics.py levels FILE.h5   (/level against /outcome)
"""

import sys

import h5py
import numpy
from scipy import stats


def close(found, expected, tolerance, place):
    if numpy.isnan(expected):
        assert numpy.isnan(found), f"{place}: {found}; expected none"
    else:
        assert abs(found - expected) <= tolerance, f"{place}: {found}; expected {expected}"


t_accuracy = 2e-9  # of SciPy 1.10's quantile of Student's t, found with mpmath


def mean_bounds(values, confidence=0.95):
    if len(values) < 2:
        return numpy.nan, numpy.nan
    if stats.sem(values) == 0:
        return values[0], values[0]
    return stats.t.interval(confidence, len(values) - 1, loc=numpy.mean(values), scale=stats.sem(values))


def judge_means(path):
    with open(path) as cases:
        lines = cases.readlines()
    for line in lines:
        mean, sd, low, high, confidence, *values = map(float, line.split())
        rounding = 1e-13 * numpy.abs(values).max()
        close(mean, numpy.mean(values), rounding, "mean")
        close(sd, numpy.std(values, ddof=1), rounding, "sd")
        expected_low, expected_high = mean_bounds(values, confidence)
        tolerance = rounding + t_accuracy * (expected_high - expected_low)
        close(low, expected_low, tolerance, "low")
        close(high, expected_high, tolerance, "high")
    print(len(lines), "samples")


def adjusted_events(hits, events, tail):
    """Independent events that clustered ones are worth (Korn and Graubard 1998); arrays by cluster."""
    n, m = events.sum(), len(events)
    p = hits.sum() / n
    if m == n:
        return n
    if p in (0.0, 1.0) or m == 1:
        return n**2 / (events**2).sum()
    variance = m / (m - 1) * ((hits - p * events) ** 2).sum() / n**2
    design_effect = max(1.0, variance / (p * (1 - p) / n))
    return max(1.0, n / design_effect) * (stats.t.isf(tail, n - 1) / stats.t.isf(tail, m - 1)) ** 2


def shown_without_miss(events, tail):
    """The lower bound that clusters of several events have without a miss, and no bound exceeds."""
    whole_clusters = events.sum() ** 2 / (events**2).sum()
    return tail ** (1 / whole_clusters) if len(events) < events.sum() else 1.0


def judge_proportions(path):
    with open(path) as cases:
        lines = cases.readlines()
    for line in lines:
        confidence, low, high, wilson_low, wilson_high, at_least, *clusters = map(float, line.split())
        hits, events = numpy.array(clusters[::2]), numpy.array(clusters[1::2])
        p = hits.sum() / events.sum()
        tail = 0.5 * (1 - confidence)
        n = adjusted_events(hits, events, tail)
        shown = shown_without_miss(events, tail)
        most, least = shown * p, 1 - shown * (1 - p)
        close(low, min(most, stats.beta.ppf(tail, p * n, n - p * n + 1)) if p > 0 else 0.0, 1e-8, "low")
        close(high, max(least, stats.beta.isf(tail, p * n + 1, n - p * n)) if p < 1 else 1.0, 1e-8, "high")
        z = stats.norm.isf(tail)
        for found, sign in ((wilson_low, -1), (wilson_high, 1)):
            expected = (p + z**2 / (2 * n) + sign * z * numpy.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))) / (1 + z**2 / n)
            close(found, min(expected, most) if sign < 0 else max(expected, least), 1e-8, "wilson")
        n = adjusted_events(hits, events, 2 * tail)
        most = shown_without_miss(events, 2 * tail) * p
        close(at_least, min(most, stats.beta.ppf(2 * tail, p * n, n - p * n + 1)) if p > 0 else 0.0, 1e-8, "at least")
    print(len(lines), "samples")


def quantile_with_bounds(values, probability):
    """Of values[cluster, number], infinite where there is none; NaN where it is not finite."""
    ordered = numpy.sort(values.ravel())
    finite = ordered[numpy.isfinite(ordered)]
    n = len(ordered)
    value = ordered[int(numpy.ceil(n * probability * (1 - 1e-15))) - 1]
    at = value if numpy.isfinite(value) else finite[-1]
    hits = (values <= at).sum(axis=1).astype(float)
    whole = int(adjusted_events(hits, numpy.full(len(values), float(values.shape[1])), 0.025) * (1 + 1e-12))
    low = int(stats.binom.ppf(0.025, whole, probability))
    high = int(stats.binom.ppf(0.975, whole, probability)) + 1
    low_rank, high_rank = int(numpy.floor(low * (n / whole))), int(numpy.ceil(high * (n / whole)))
    found = (value, ordered[low_rank - 1] if low_rank >= 1 else numpy.inf, ordered[high_rank - 1] if high <= whole else numpy.inf)
    return [x if numpy.isfinite(x) else numpy.nan for x in found]


def judge_quantiles(path):
    with open(path) as cases:
        lines = cases.readlines()
    for line in lines:
        probability, size, value, low, high, *values = map(float, line.split())
        values = numpy.nan_to_num(numpy.array(values), nan=numpy.inf).reshape(-1, int(size))
        for name, found, expected in zip(("value", "low", "high"), (value, low, high), quantile_with_bounds(values, probability)):
            close(found, expected, 0.0, f"{name} of {line[:60]}")
    print(len(lines), "samples")


def judge_observed(path):
    with open(path) as cases:
        lines = cases.readlines()
    for line in lines:
        p, *numbers = line.split()
        k, n, successes, simulated = map(int, numbers[:4])
        expected = stats.fisher_exact([[k, n - k], [successes, simulated - successes]])[1]
        close(float(p), expected, 1e-6 * expected, f"Fisher: {line[:60]}")
        p, trials, of_machines = float(numbers[4]), int(numbers[5]), numpy.array(numbers[6:], dtype=int)
        tails = (stats.hypergeom.cdf(k, trials, of_machines, n).sum(), stats.hypergeom.sf(k - 1, trials, of_machines, n).sum())
        close(p, min(1.0, 2 * (1 + min(tails)) / (1 + len(of_machines))), 1e-9, f"machines: {line[:60]}")
    print(len(lines), "samples")


def rows_of_point(file, point):
    return numpy.flatnonzero(file["trial/point"][:] == point)


def judge_loop(path):
    with h5py.File(path) as file:
        outcome = {name: column[:] for name, column in file["outcome"].items() if column.ndim == 2}
        found = {name: column[:] for name, column in file["point"].items() if name != "label"}
        for point in file["point/point"]:
            rows = rows_of_point(file, point)
            followed = outcome["outcome"][rows] != 3
            error = numpy.abs(outcome["final_error"][rows][followed])
            expected = {"final_error_n": len(error), "final_error_mean": error.mean(), "final_error_max": error.max()}
            for name, probability in (("median", 0.5), ("p95", 0.95)):
                expected["final_error_" + name] = numpy.quantile(error, probability, method="inverted_cdf")
                if followed.all():  # otherwise the clusters have different sizes
                    of_trials = numpy.abs(outcome["final_error"][rows]).astype(float)
                    value, low, high = quantile_with_bounds(of_trials, probability)
                    expected[f"final_error_{name}_low"], expected[f"final_error_{name}_high"] = low, high
                settling = outcome["arrival_time"][rows]
                value, low, high = quantile_with_bounds(numpy.nan_to_num(settling, nan=numpy.inf), probability)
                expected["arrival_time_" + name] = value
                expected[f"arrival_time_{name}_low"], expected[f"arrival_time_{name}_high"] = low, high
            expected["arrival_time_moves"] = settling.size
            distance = numpy.abs(outcome["true_error"][rows][followed])
            expected["true_error_n"] = len(distance)
            expected["true_error_mean"] = distance.mean()
            expected["true_error_rms"] = numpy.sqrt((distance**2).mean())
            expected["true_error_max"] = distance.max()
            for name in ("phase_changes", "encoder_disagreement"):
                times = outcome[name][rows].sum(axis=1)
                expected[name + "_trials"] = (times > 0).sum()
                expected[name + "_mean"] = times.mean()
                expected[name + "_max"] = times.max()
            expected["travel_time_mean"] = outcome["travel_time"][rows].mean()
            expected["travel_time_max"] = outcome["travel_time"][rows].max()
            for name, value in expected.items():
                close(found[name][point], value, 1e-13 * max(abs(value), 1), f"point {point}: {name}")
        print(len(file["point/point"]), "points")


def judge_levels(path):
    with h5py.File(path) as file:
        outcome = {name: column[:] for name, column in file["outcome"].items() if column.ndim == 2}
        level = file["level"]
        for point in level["point"]:
            for move in level["move"]:
                rows = rows_of_point(file, point)
                rows = rows[outcome["outcome"][rows, move] == 4]
                values = {name: column[rows, move] for name, column in outcome.items()}
                expected = {
                    "n": len(rows),
                    "nonfinite": (outcome["outcome"][rows_of_point(file, point), move] == 3).sum(),
                    "torque": values["holding_torque"].mean(),
                    "broke_away": values["broke_away"].sum(),
                    "reversal_depth_max": values["reversal_depth"].max(),
                }
                for name, values_of in (("position", values["final_position"]), ("creep", values["creep"])):
                    low, high = mean_bounds(values_of)
                    described = (values_of.mean(), low, high, numpy.std(values_of, ddof=1), values_of.min(), values_of.max())
                    for statistic, value in zip(("mean", "low", "high", "sd", "min", "max"), described):
                        expected[f"{name}_{statistic}"] = value
                assert set(expected) == set(level) - {"point", "move"}
                for name, value in expected.items():
                    spread = expected[name.split("_")[0] + "_sd"] if name.endswith(("low", "high")) else 0.0
                    tolerance = 1e-12 * abs(value) + t_accuracy * spread
                    close(level[name][point, move], value, tolerance, f"point {point}, level {move}: {name}")
        print(level["torque"].shape)
        # nothing of an open-loop study pretends to be success
        for name in ("success_rate", "success_rate_low", "success_rate_high", "stable_rate", "final_error_mean", "true_error_mean"):
            assert numpy.isnan(file["point"][name][:]).all(), name
        trials = file.attrs["trials"]
        assert (file["point/open_loop"][:] + file["point/nonfinite"][:] == trials).all()


{"means": judge_means, "proportions": judge_proportions, "quantiles": judge_quantiles, "observed": judge_observed, "loop": judge_loop, "levels": judge_levels}[sys.argv[1]](sys.argv[2])
