"""BCa bounds of means against scipy.stats.bootstrap, which draws other random numbers.

usage: judge_bootstrap.py CASES      (lines of: low high confidence  x1 x2 …)
"""

import sys

import numpy
from scipy import stats

resamples = 200000  # as many as the judged bounds were made of
generator = numpy.random.default_rng(91)

with open(sys.argv[1]) as cases:
    lines = cases.readlines()
for line in lines:
    low, high, confidence, *values = map(float, line.split())
    values = numpy.array(values)
    judge = stats.bootstrap((values,), numpy.mean, n_resamples=resamples, confidence_level=confidence, method="BCa",
                            random_state=generator, batch=20000)
    means = judge.bootstrap_distribution
    whole = numpy.all(values == numpy.round(values))
    gap = 1.01 / len(values) if whole else 0.0  # of means of whole numbers: a quantile may lie on either side of one
    for found, expected in ((low, judge.confidence_interval.low), (high, judge.confidence_interval.high)):
        # The bounds are quantiles of the resampled means: compared by the shares of these below them. Their errors are
        # those of such a share, and of the bias z0, which moves the share by its density; both sides are random.
        share = (means < expected).mean()
        error = numpy.sqrt(share * (1 - share)) + 2.5 * stats.norm.pdf(stats.norm.ppf(share))
        allowed = 5.0 * numpy.sqrt(2.0 / resamples) * error
        least, most = (means < found - gap).mean() - allowed, (means <= found + gap).mean() + allowed
        assert least <= share <= most, f"{found}; expected {expected}, share {share} in {least} to {most}: {line[:80]}"
print(len(lines), "samples")
