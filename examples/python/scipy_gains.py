"""Gains that settle fast on the worst machines, by an optimiser of SciPy.

usage: scipy_gains.py MANIFEST

`zerocount tune` does more: it keeps margins, and proves what it finds on new machines. This shows how to give a study to an optimiser of
one's own: the same 200 machines and moves at every call, in this process.
"""

import sys

import numpy as np
import scipy.optimize
import zerocount as zc

HOLD = 0.5  # s: a move that ends outside the band counts with its duration
LOW, HIGH = np.array([5e3, 0.0, 0.0]), np.array([3e5, 1000.0, 2.0])  # N m/(rad s), N m/rad, N m s/rad


def main(manifest):
    axis = zc.study(manifest).without("sweep").set({"controller.ki": 1e4})
    f = zc.sample(axis, outcome=lambda measures: np.nan_to_num(measures["band_settling_time[1]"], nan=HOLD).max(axis=1))
    machines = f.draw(200, rng=1)

    def settled_95(place):
        """95 % of these moves are within one count for good after this time, s."""
        ki, kp, kd = LOW * (HIGH[0] / LOW[0]) ** place[0], HIGH[1] * place[1], HIGH[2] * place[2]
        gains = {"controller.ki": ki[0], "controller.kp": kp, "controller.kd": kd}
        return np.quantile(f.set(gains)(machines), 0.95), gains

    found = scipy.optimize.differential_evolution(
        lambda place: settled_95(place)[0], [(0, 1)] * 3, seed=1, popsize=6, maxiter=6, polish=False
    )
    time, gains = settled_95(found.x)
    print(f"on these machines 95 % of the moves settle within {1e3 * time:.1f} ms")
    print(", ".join(f"{key.removeprefix('controller.')} {value:.4g}" for key, value in gains.items()))
    others = np.quantile(f.set(gains)(f.draw(2000, rng=2), first=1000), 0.95)
    print(f"on 2000 others within {1e3 * others:.1f} ms")


if __name__ == "__main__":
    main(sys.argv[1])
