"""Draws two studies, read straight from their results files: the stability map and a 30-count step with its jerks.

usage: python3 plot_study.py STABILITY_MAP.h5 PAPER_FIG8.h5 PICTURE.png      (h5py, numpy, matplotlib)
"""

import sys

import h5py
import matplotlib
import numpy

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def draw_stability(file, axes):
    """Proportion of stable trials against ki, one curve per kp, with the 95 % bounds."""
    ki = file["point/controller.ki"][:]
    kp = file["point/controller.kp"][:]
    rate, low, high = (file[f"point/stable_rate{end}"][:] for end in ("", "_low", "_high"))
    for value, colour in zip(numpy.unique(kp), plt.cm.viridis(numpy.linspace(0, 0.85, len(numpy.unique(kp))))):
        here = kp == value
        axes.fill_between(ki[here], low[here], high[here], color=colour, alpha=0.2, linewidth=0)
        axes.plot(ki[here], rate[here], color=colour, marker=".", label=f"kp = {value:.1e}")
    for gain, name in ((3.85e-5, "(6)"), (3.01e-4, "(7)")):
        axes.axvline(gain, color="grey", linestyle=":")
        axes.annotate(f"{name} at kp = 0", (gain, 1.03), ha="center", va="bottom", color="grey", fontsize=8)
    axes.set(xscale="log", xlabel="integral gain ki (N m/count)", ylabel="stable trials", ylim=(-0.02, 1.1))
    axes.legend(fontsize=8, loc="upper right", bbox_to_anchor=(1.0, 0.95))


def draw_step(file, position, drive):
    """Of the trials whose samples the study retained, the one with the most jerks."""
    trial = file["trace/trial"][:]
    jerks = file["outcome/jerk_count"][:].sum(axis=1)
    shown = trial == max(numpy.unique(trial), key=lambda row: jerks[row])
    time = file["trace/t"][:][shown]
    position.plot(time, file["trace/count"][:][shown], linewidth=0.8)
    position.set(ylabel="position (counts)", title="30 counts commanded: one-count jerks that slow down")
    drive.plot(time, 1e3 * file["trace/torque"][:][shown], linewidth=0.8, color="tab:red")
    drive.set(xlabel="time (s)", ylabel="torque (mN m)")


def main(map_path, step_path, picture):
    figure = plt.figure(figsize=(11, 4), constrained_layout=True)
    grid = figure.add_gridspec(2, 2)
    with h5py.File(map_path) as file:
        draw_stability(file, figure.add_subplot(grid[:, 0]))
    with h5py.File(step_path) as file:
        draw_step(file, figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1]))
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:4])
