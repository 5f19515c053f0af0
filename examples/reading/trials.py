"""The table of `zerocount summary study.h5` from the single trials: label, trials, zero-count rate with bounds, arrival, jerks."""

import h5py
import numpy as np

with h5py.File("study.h5") as file:
    labels = file["point/label"].asstr()[:]
    lows, highs = file["point/success_rate_low"][:], file["point/success_rate_high"][:]
    point = file["trial/point"][:]                      # of each trial
    worst = file["outcome/outcome"][:].max(axis=1)      # [trial, move] to [trial]: 0 is zero_count
    settling = file["outcome/arrival_time"][:]         # s, [trial, move]; NaN where a move never arrived
    jerks = file["outcome/jerk_count"][:].sum(axis=1)

for p, label in enumerate(labels):
    mine = point == p
    n, k = mine.sum(), (worst[mine] == 0).sum()
    times = np.sort(settling[mine], axis=None)          # NaN comes last: later than any time
    median, p95 = times[np.ceil(np.array([0.5, 0.95]) * times.size).astype(int) - 1]
    print(label, n, k / n, lows[p], highs[p], median, p95, jerks[mine].mean(), sep="\t")
