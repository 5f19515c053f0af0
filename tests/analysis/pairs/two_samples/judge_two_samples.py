"""The tests and bounds of a comparison, against SciPy and against the definitions taken literally.

usage: judge_two_samples.py CASES    (a JSON object a line: kind, arguments, value)
"""

import itertools
import json
import sys

import numpy
from scipy import optimize, stats


def mcnemar(pairs, worse, better):
    return stats.binomtest(worse, worse + better, 0.5, alternative="greater").pvalue if worse + better else 1.0


def fisher(old_failures, old_trials, new_failures, new_trials):
    table = [[new_failures, new_trials - new_failures], [old_failures, old_trials - old_failures]]
    return stats.fisher_exact(table, alternative="greater")[1]


def tango(pairs, worse, better, confidence):
    """By the likelihood itself, maximised over the share of the pairs that only the baseline failed."""

    def score(difference):
        def minus_log_likelihood(share):
            cells = [(worse, share + difference), (better, share), (pairs - worse - better, 1 - 2 * share - difference)]
            return -sum(count * numpy.log(max(p, 1e-300)) for count, p in cells if count)

        low, high = max(0.0, -difference), (1 - difference) / 2
        found = optimize.minimize_scalar(minus_log_likelihood, bounds=(low, high), method="bounded", options={"xatol": 1e-12})
        candidates = [found.x, low, high]
        share = min(candidates, key=minus_log_likelihood)
        variance = pairs * (2 * share + difference - difference**2)
        return (worse - better - pairs * difference) / numpy.sqrt(max(variance, 1e-300))

    z = stats.norm.ppf(confidence)
    seen = (worse - better) / pairs
    bounds = []
    for level, edge in ((z, -1 + 1e-9), (-z, 1 - 1e-9)):
        if (score(edge) - level) * (score(seen) - level) > 0:
            bounds.append(round(edge))
        else:
            bounds.append(optimize.brentq(lambda d: score(d) - level, *sorted((edge, seen)), xtol=1e-12))
    return bounds


def newcombe(old_failures, old_trials, new_failures, new_trials, confidence):
    def wilson(k, n):
        return stats.binomtest(k, n).proportion_ci(2 * confidence - 1, method="wilson")

    one, two = wilson(old_failures, old_trials), wilson(new_failures, new_trials)
    p1, p2 = old_failures / old_trials, new_failures / new_trials
    low = p2 - p1 - numpy.sqrt((p2 - two.low) ** 2 + (one.high - p1) ** 2)
    high = p2 - p1 + numpy.sqrt((two.high - p2) ** 2 + (p1 - one.low) ** 2)
    return [low, high]


def signed_rank(*differences):
    differences = numpy.array([d for d in differences if d != 0])
    if len(differences) == 0:
        return 1.0
    sizes = numpy.abs(differences)
    if len(set(sizes)) == len(sizes) and len(sizes) <= 200:
        return stats.wilcoxon(differences, alternative="greater", method="exact").pvalue
    if len(sizes) <= 12:  # every choice of signs
        ranks = stats.rankdata(sizes)
        seen = ranks[differences > 0].sum()
        sums = [numpy.dot(signs, ranks) for signs in itertools.product((0, 1), repeat=len(ranks))]
        return numpy.mean(numpy.array(sums) >= seen - 1e-9)
    return stats.wilcoxon(differences, alternative="greater", method="approx", correction=True).pvalue


def largest_excess(old, new):
    places = numpy.unique(numpy.concatenate((old, new)))
    return max((numpy.searchsorted(numpy.sort(old), places, "right") / len(old)
                - numpy.searchsorted(numpy.sort(new), places, "right") / len(new)).max(), 0.0)


def smirnov(old, new):
    old, new = numpy.array(old), numpy.array(new)
    pooled = numpy.concatenate((old, new))
    if len(set(pooled)) == len(pooled):
        return stats.ks_2samp(old, new, alternative="greater", method="exact").pvalue
    seen = largest_excess(old, new)  # with ties: every division of the pooled values
    count = hits = 0
    for chosen in itertools.combinations(range(len(pooled)), len(old)):
        mask = numpy.zeros(len(pooled), bool)
        mask[list(chosen)] = True
        hits += largest_excess(pooled[mask], pooled[~mask]) >= seen - 1e-9
        count += 1
    return hits / count


def paired_t(*differences):
    return stats.ttest_1samp(differences, 0.0, alternative="greater").pvalue


def welch(old, new):
    return stats.ttest_ind(new, old, equal_var=False, alternative="greater").pvalue


def paired_bounds(differences, unit, confidence):
    mean, bounds = numpy.mean(differences), []
    for side, quantile in ((-1, 1 - confidence), (1, confidence)):
        more = numpy.append(differences, mean + side * unit)
        bounds.append(stats.t.ppf(quantile, len(more) - 1, loc=more.mean(), scale=stats.sem(more)))
    return bounds


def two_sample_bounds(old, new, unit, confidence):
    bounds = []
    for side, quantile in ((-1, 1 - confidence), (1, confidence)):
        more = numpy.append(new, numpy.mean(new) + side * unit)
        a, b = stats.sem(old) ** 2, stats.sem(more) ** 2
        df = (a + b) ** 2 / (a**2 / (len(old) - 1) + b**2 / (len(more) - 1))
        bounds.append(more.mean() - numpy.mean(old) + stats.t.ppf(quantile, df) * numpy.sqrt(a + b))
    return bounds


TOLERANCES = {"tango": (0.0, 2e-7), "signed_rank": (1e-10, 1e-14), "paired_bounds": (1e-8, 1e-9), "two_sample_bounds": (1e-8, 1e-9)}

if __name__ == "__main__":
    counts = {}
    for line in open(sys.argv[1]):
        case = json.loads(line)
        kind = case["kind"]
        expected = globals()[kind](*case["arguments"])
        relative, absolute = TOLERANCES.get(kind, (1e-9, 1e-13))
        assert numpy.allclose(case["value"], expected, relative, absolute), f"{line.strip()}: expected {expected}"
        counts[kind] = counts.get(kind, 0) + 1
    print(" ".join(f"{kind}:{count}" for kind, count in sorted(counts.items())))
