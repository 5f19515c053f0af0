"""The probability of a late move, and what it depends on, by OpenTURNS.

usage: openturns_uncertainty.py MANIFEST

The study becomes a function of its random variables, with their joint distribution. Any method of OpenTURNS applies to it: here a
simulation of the probability that a move takes more than 50 ms to stay within one count, and Sobol' indices of that time.
"""

import sys

import numpy as np
import openturns as ot
import zerocount as zc

HOLD = 0.5  # s: a move that ends outside the band counts with its duration


def time_within_one_count(measures):
    """The longest of a trial's moves, s."""
    return np.nan_to_num(measures["band_settling_time[1]"], nan=HOLD).max(axis=1)


def main(manifest):
    axis = zc.study(manifest).without("sweep").set({"controller.ki": 11767.7})
    f = zc.sample(axis, outcome=time_within_one_count)
    ot.RandomGenerator.SetSeed(1)

    late = ot.ThresholdEvent(ot.CompositeRandomVector(f.function, ot.RandomVector(f.distribution)), ot.Greater(), 0.05)
    simulation = ot.ProbabilitySimulationAlgorithm(late, ot.MonteCarloExperiment())
    simulation.setBlockSize(1000)
    simulation.setMaximumOuterSampling(20)
    simulation.setMaximumCoefficientOfVariation(0.05)
    simulation.run()
    result = simulation.getResult()
    half = result.getConfidenceLength(0.95) / 2
    print(f"a move is late in {result.getProbabilityEstimate():.1%} ± {half:.1%} of the trials")

    size = 2000
    design = ot.SobolIndicesExperiment(f.distribution, size).generate()
    indices = ot.SaltelliSensitivityAlgorithm(design, f.function(design), size).getTotalOrderIndices()
    for name, index in sorted(zip(f.names, indices), key=lambda pair: -pair[1]):
        print(f"{name:22} total index {index:5.2f}")


if __name__ == "__main__":
    main(sys.argv[1])
