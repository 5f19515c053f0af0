"""Quantiles of the distributions against SciPy and OpenTURNS."""

import json
import math
import subprocess
import sys

import openturns as ot
from scipy import stats


def scipy_quantile(name, n, u):
    if name == "uniform":
        return stats.uniform(n[0], n[1] - n[0]).ppf(u)
    if name == "log_uniform":
        return stats.loguniform(n[0], n[1]).ppf(u)
    if name == "normal":
        return stats.norm(n[0], n[1]).ppf(u)
    if name == "truncated_normal":
        return stats.truncnorm((n[2] - n[0]) / n[1], (n[3] - n[0]) / n[1], n[0], n[1]).ppf(u)
    if name == "lognormal":
        return stats.lognorm(math.sqrt(math.log1p(n[1] ** 2)), scale=n[0]).ppf(u)
    if name == "triangular":
        return stats.triang((n[1] - n[0]) / (n[2] - n[0]), n[0], n[2] - n[0]).ppf(u)
    if name == "integers":
        return max(stats.randint(int(n[0]), int(n[1]) + 1).ppf(u), n[0])
    raise ValueError(name)


def openturns_quantile(name, n, u):
    if name == "log_uniform":
        distribution = ot.LogUniform(math.log(n[0]), math.log(n[1]))
    elif name == "truncated_normal":
        distribution = ot.TruncatedNormal(*n)
    elif name == "lognormal":
        mean = n[0] * math.sqrt(1 + n[1] ** 2)
        distribution = ot.ParametrizedDistribution(ot.LogNormalMuSigma(mean, n[1] * mean, 0.0))
    elif name == "triangular":
        distribution = ot.Triangular(*n)
    else:
        return None
    return distribution.computeQuantile(u)[0]


def main():
    answers = json.loads(subprocess.check_output([sys.argv[1], "distributions"]))
    compared = 0
    for answer in answers:
        name, numbers = answer["name"], answer["numbers"]
        spread = scipy_quantile(name, numbers, 0.9) - scipy_quantile(name, numbers, 0.1)
        for u, x in answer["quantiles"]:
            for judge, tolerance in ((scipy_quantile, 1e-9), (openturns_quantile, 1e-6)):
                expected = judge(name, numbers, u)
                if expected is None:
                    continue
                if abs(x - expected) > tolerance * max(spread, abs(expected)):
                    sys.exit(f"{name} {numbers} at {u}: {x}, but {judge.__name__} gives {expected}")
                compared += 1
    if compared < 100:
        sys.exit(f"only {compared} quantiles were compared")
    print(f"{compared} quantiles agree")


main()
