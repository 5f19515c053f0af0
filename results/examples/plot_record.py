"""Draws a record of a machine in closed loop beside its prediction: following error, and what the prediction leaves.

usage: python3 plot_record.py RECORD.csv TRACE.csv RESOLUTION FROM TO PICTURE.png    (numpy, matplotlib)

RECORD.csv has the columns time (s), force (N) and count; TRACE.csv is what `zerocount trace` wrote of the same reference.
RESOLUTION is a count in m; FROM and TO are the times (s) between which is drawn.
"""

import sys

import matplotlib
import numpy

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def columns(path, *names):
    table = numpy.genfromtxt(path, delimiter=",", names=True, encoding="utf-8", dtype=None)
    return [table[name] for name in names]


if __name__ == "__main__":
    record, trace, resolution, begin, end, picture = sys.argv[1:]
    micrometre = 1e6 * float(resolution)
    recorded = numpy.loadtxt(record, delimiter=",", skiprows=1)
    time, reference, count = columns(trace, "t", "target", "count")
    time, reference, count = (values[: len(recorded)] for values in (time, reference, count))
    measured = recorded[:, 2] - recorded[0, 2]
    shown = (float(begin) <= time) & (time <= float(end))
    figure, (errors, rest) = plt.subplots(2, 1, sharex=True, figsize=(9, 5), constrained_layout=True)
    errors.plot(time[shown], micrometre * (reference - measured)[shown], label="record", linewidth=1.6)
    errors.plot(time[shown], micrometre * (reference - count)[shown], "--", label="prediction", linewidth=1.0)
    errors.set(ylabel="following error (µm)")
    errors.legend(loc="upper right")
    rest.plot(time[shown], micrometre * (count - measured)[shown], linewidth=0.9)
    rest.set(xlabel="time (s)", ylabel="prediction − record (µm)")
    for axes in (errors, rest):
        axes.grid(alpha=0.3)
    figure.savefig(picture, dpi=110)
