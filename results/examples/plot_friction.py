"""Draws what friction does before it slides, from the sample records of three studies: the spring's hysteresis (Fig. 4 of
the paper), creep and work hardening (Fig. 6), and an integral control on this friction and on Coulomb's.

usage: python3 plot_friction.py PAPER_FIG4.h5 PAPER_FIG6.h5 WHY_PRESLIDING.h5 PICTURE.png    (h5py, numpy, matplotlib)
"""

import sys

import h5py
import matplotlib
import numpy

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def record(file, row):
    """The sample records of one trial, by column."""
    shown = file["trace/trial"][:] == row
    return {name: file[f"trace/{name}"][:][shown] for name in ("t", "theta", "xp", "torque", "error")}


def draw_hysteresis(file, axes):
    trial = record(file, file["trace/trial"][0])
    axes.plot(1e6 * trial["theta"], trial["torque"], linewidth=0.9)
    axes.set(xlabel="rotor angle (µrad)", ylabel="torque (N m)", title="paper-fig4: the spring")


def draw_creep(file, axes):
    trial = record(file, file["trace/trial"][0])
    axes.plot(1e6 * trial["xp"], trial["torque"], linewidth=0.9, color="tab:red")
    axes.set(xlabel="plastic extension (µrad)", ylabel="torque (N m)", title="paper-fig6: creep and hardening")


def draw_control(file, axes):
    labels = file["point/label"].asstr()[:]
    trials = file.attrs["trials"]
    for point, label in enumerate(labels):
        if label not in ("presliding", "coulomb"):
            continue
        trial = record(file, point * trials)
        axes.plot(trial["t"], trial["error"], linewidth=0.9, label=label)
    axes.set(yscale="symlog", xlabel="time (s)", ylabel="error (counts)", title="why-presliding: the same loop", xlim=(0, 0.5))
    axes.set_yticks([-1e4, -1e2, -1, 0, 1, 1e2, 1e4])
    axes.legend(fontsize=8, loc="lower right")


def main(hysteresis, creep, control, picture):
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.6), constrained_layout=True)
    for path, draw, place in zip((hysteresis, creep, control), (draw_hysteresis, draw_creep, draw_control), axes):
        with h5py.File(path) as file:
            draw(file, place)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:5])
