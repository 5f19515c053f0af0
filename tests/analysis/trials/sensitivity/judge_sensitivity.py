"""Sensitivity measures against OpenTURNS, NumPy and SciPy, from the same samples.

usage: judge_sensitivity.py design CASES.json     (Sobol' indices of designs, against OpenTURNS)
       judge_sensitivity.py sample CASES.json     (measures of plain samples, against SciPy and OpenTURNS)
       judge_sensitivity.py logistic CASES.json   (logistic fits, against a general minimiser)
"""

import json
import sys

import numpy
import openturns
from scipy import optimize, stats


def within(value, interval, place):
    low, high = interval
    assert low <= value <= high, f"{place}: {value} is outside [{low}, {high}]"


def column(values):
    return openturns.Sample(numpy.asarray(values, dtype=float).reshape(-1, 1))


def bounds_of(interval):
    return list(zip(interval.getLowerBound(), interval.getUpperBound()))


def judge_design(case):
    """Our values are within OpenTURNS's intervals, and ours are wider by no more than unseen rows may do."""
    unseen = 2 * numpy.log(2 / (1 - 0.95)) / len(case["a"])
    rows = len(case["a"])
    inputs = numpy.concatenate([case["points_a"], case["points_b"]] + case["points_c"])
    outputs = numpy.concatenate([case["a"], case["b"]] + case["c"])
    openturns.RandomGenerator.SetSeed(1)
    for which, algorithm, name in (
        ("first_order", openturns.SaltelliSensitivityAlgorithm, "FirstOrder"),
        ("total", openturns.JansenSensitivityAlgorithm, "TotalOrder"),
    ):
        theirs = algorithm(openturns.Sample(inputs), column(outputs), rows)
        theirs.setBootstrapSize(200)
        theirs.setConfidenceLevel(0.95)
        values = getattr(theirs, f"get{name}Indices")()
        intervals = bounds_of(getattr(theirs, f"get{name}IndicesInterval")())
        for j, ours in enumerate(case[which]):
            place = f"{case['name']}, {which} of factor {j}"
            within(ours["value"], intervals[j], place)
            # Its first-order estimate does not take the mean from B, and varies more than ours.
            if which == "total":
                within(values[j], (ours["low"], ours["high"]), place)
            assert ours["low"] < intervals[j][1] and intervals[j][0] < ours["high"], f"{place}: apart"
            width, their_width = ours["high"] - ours["low"], intervals[j][1] - intervals[j][0]
            assert width < 1.2 * their_width + unseen, f"{place}: {width} wide, OpenTURNS {their_width}"


def remainder(y, others):
    with_constant = numpy.column_stack([numpy.ones(len(y))] + others)
    return y - with_constant @ numpy.linalg.lstsq(with_constant, y, rcond=None)[0]


def share_by_neighbours(x, y):
    """First-order index from the products of neighbours in x (Gamboa, Gremaud, Klein & Lagnoux 2022)."""
    y = y[numpy.argsort(x)]
    return (numpy.mean(y * numpy.roll(y, -1)) - numpy.mean(y) ** 2) / numpy.var(y)


def judge_sample(case):
    x, y = numpy.array(case["x"]), numpy.array(case["y"])
    ranks = [stats.rankdata(values) for values in x]
    partial = openturns.CorrelationAnalysis(openturns.Sample(x.T), column(y)).computePRCC()
    for j in range(len(x)):
        place = f"{case['name']}, factor {j}"
        spearman = stats.spearmanr(x[j], y)[0]
        assert abs(case["rank_correlation"][j] - spearman) < 1e-12, f"{place}: Spearman {spearman}"
        others = [ranks[i] for i in range(len(x)) if i != j]
        expected = stats.pearsonr(remainder(ranks[j], others), remainder(stats.rankdata(y), others))[0]
        found = case["partial_rank_correlation"][j]
        assert abs(found - expected) < 1e-10, f"{place}: partial rank correlation {expected}, found {found}"
        if case["without_ties"]:
            assert abs(found - partial[j]) < 1e-10, f"{place}: OpenTURNS has {partial[j]}, found {found}"
            share = share_by_neighbours(x[j], y)
            # Of a standard deviation below 1/√n.
            assert abs(case["first_order"][j] - share) < 4 / len(y) ** 0.5, f"{place}: by neighbours {share}"


def judge_logistic(case):
    x, yes = numpy.array(case["x"]).T, numpy.array(case["yes"])
    z = numpy.column_stack([numpy.ones(len(yes)), (x - x.mean(axis=0)) / x.std(axis=0)])

    def cost(b):
        return numpy.logaddexp(0, (1 - 2 * yes) * (z @ b)).sum()

    def slope(b):
        return z.T @ (1 / (1 + numpy.exp(-(z @ b))) - yes)

    best = optimize.minimize(cost, numpy.zeros(z.shape[1]), jac=slope, method="BFGS", options={"gtol": 1e-9}).x
    step = 1e-5 * numpy.eye(len(best))
    curvature = numpy.array([(slope(best + e) - slope(best - e)) / 2e-5 for e in step])
    errors = numpy.sqrt(numpy.diag(numpy.linalg.inv(curvature)))
    assert len(case["found"]) == len(best)
    for found, b, error in zip(case["found"], best, errors):
        half = stats.norm.ppf(0.975) * error
        for value, expected in ((found["value"], b), (found["low"], b - half), (found["high"], b + half)):
            assert abs(value - expected) < 1e-6 * (1 + abs(expected)), f"{case['name']}: {value}; expected {expected}"


def main():
    judge = {"design": judge_design, "sample": judge_sample, "logistic": judge_logistic}[sys.argv[1]]
    with open(sys.argv[2], encoding="utf-8") as file:
        cases = json.load(file)
    for case in cases:
        judge(case)
    print(f"{len(cases)} cases")


main()
