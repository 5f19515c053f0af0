"""What `zerocount jerks` says of a study, found again from its file, sample by sample, with NumPy and SciPy.

usage: judge_jerks.py ZEROCOUNT
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy
from scipy import stats

manifest = """\
zerocount: 1
name: jerking
seed: 11
trials: 80
{machines}friction:
  k1: {{uniform: [90, 130]}}
  k2: {{uniform: [600, 900]}}
  alpha: {{log_uniform: [0.25, 2.0]}}
  lambda: {{log_uniform: [3, 20]}}
command: {{targets: [{{integers: [5, 30]}}, {{integers: [-30, 30]}}], hold: 1.5}}
initial: {{encoder_phase: {{uniform: [0, 1]}}}}
sweep:
  cases: {{low: {{controller.ki: 3.85e-5}}, high: {{controller.ki: 9.45e-5, controller.kp: 6.21e-4}}}}
"""

confidence = 0.9
tail = 0.5 * (1 - confidence)
rate, samples, dwell = 2000, 3000, 100


def close(found, expected, place):
    if expected is None or numpy.isnan(expected):
        assert found is None, f"{place}: {found}; expected none"
    else:
        assert abs(found - expected) <= 1e-9 * max(1.0, abs(expected)), f"{place}: {found}; expected {expected}"


def garwood(k, exposure):
    low = stats.gamma.ppf(tail, k) if k > 0 else 0.0
    return low / exposure, stats.gamma.isf(tail, k + 1) / exposure


def independent(hits, events):
    """Events that clustered ones are worth; arrays by trial."""
    hits, events = hits[events > 0].astype(float), events[events > 0].astype(float)
    n, m = events.sum(), len(events)
    p = hits.sum() / n
    if m == n:
        return n
    if p in (0.0, 1.0) or m == 1:
        return n**2 / (events**2).sum()
    deff = m / (m - 1) * ((hits - p * events) ** 2).sum() / n**2 / (p * (1 - p) / n)
    return max(1.0, n / max(1.0, deff))


def adjusted(hits, events):
    """The same, with Student's factor of an estimated variance (Korn and Graubard 1998)."""
    hits, events = hits[events > 0], events[events > 0]
    n, m = events.sum(), len(events)
    known = 0 < hits.sum() < n and 1 < m < n
    return independent(hits, events) * ((stats.t.isf(tail, n - 1) / stats.t.isf(tail, m - 1)) ** 2 if known else 1.0)


def judge_proportion(found, hits, events, place):
    p = hits.sum() / events.sum()
    close(found["proportion"], p, place)
    close(found["independent"], independent(hits, events), place)
    n = adjusted(hits, events)
    close(found["proportion_low"], stats.beta.ppf(tail, p * n, n - p * n + 1) if p > 0 else 0.0, place)
    close(found["proportion_high"], stats.beta.isf(tail, p * n + 1, n - p * n) if p < 1 else 1.0, place)


def judge_point(found, file, point, machines):
    """@param machines that the trials run on, trial i on machine i mod machines; 0: each trial is a cluster of its own."""
    rows = numpy.flatnonzero(file["trial/point"][:] == point)
    arrival = file["outcome/arrival"][rows]
    arrived = file["outcome/arrived"][rows].astype(bool) & (file["outcome/outcome"][rows] != 3)
    holding = numpy.sign(file["outcome/holding_torque"][rows])
    jerk = {name: file["jerk/" + name][:] for name in ("trial", "move", "onset", "duration", "magnitude", "direction")}
    trials = len(rows)
    clusters = machines or trials
    edges = 10.0 ** (numpy.arange(-30, 20) / 5.0)
    exposure, onsets = numpy.zeros((clusters, len(edges))), numpy.zeros((clusters, len(edges)))
    intervals, owners = [], []
    agreeing, one_count, jerks = numpy.zeros(clusters), numpy.zeros(clusters), numpy.zeros(clusters)
    jerking_trials = set()
    excess = variance = 0.0
    scores, trends = [], []
    for trial, row in enumerate(rows):
        i = trial % clusters
        for move in range(arrival.shape[1]):
            if not arrived[trial, move]:
                continue
            own = (jerk["trial"] == row) & (jerk["move"] == move)
            onset = numpy.rint(jerk["onset"][own] * rate).astype(int)
            length = numpy.rint(jerk["duration"][own] * rate).astype(int)
            error = numpy.zeros(samples, bool)
            for first, count in zip(onset, length):
                error[first:first + count] = True
            k = numpy.arange(arrival[trial, move] + dwell, samples)
            k = k[~error[k - 1]]
            since = (k - arrival[trial, move]) / rate
            place = numpy.searchsorted(edges, since * (1 + 1e-12), side="right") - 1
            numpy.add.at(exposure[i], place, 1.0 / rate)
            begins = error[k]
            numpy.add.at(onsets[i], place[begins], 1.0)
            assert begins.sum() == len(onset)
            jerks[i] += len(onset)
            jerking_trials |= {trial} if len(onset) else set()
            agreeing[i] += (jerk["direction"][own] == holding[trial, move]).sum()
            one_count[i] += (jerk["magnitude"][own] == 1).sum()
            intervals += list(numpy.diff(onset) / rate)
            owners += [i] * max(0, len(onset) - 1)
            between = numpy.diff(onset)
            if len(set(between)) > 1:
                weights = numpy.arange(len(between), 0, -1)
                difference = (weights * (between - between.mean())).sum()
                spread = len(between) * (len(between) + 1) / 12 * ((between - between.mean()) ** 2).sum()
                excess += difference
                variance += spread
                scores.append(difference / numpy.sqrt(spread))
                trends.append((weights, between))
    assert found["jerks"] == jerks.sum() and found["arrived"] == arrived.sum()
    assert found["trials_with_jerks"] == len(jerking_trials)

    used = numpy.flatnonzero(exposure.sum(axis=0) > 0)
    assert len(used) == len(found["rates"])
    for j, told in zip(used, found["rates"]):
        place = f"point {point}, rate from {told['from']}"
        total, k = exposure[:, j].sum(), onsets[:, j].sum()
        m = (exposure[:, j] > 0).sum()
        close(told["exposure"], total, place)
        assert told["jerks"] == k, place
        close(told["rate"], k / total, place)
        dispersion = 1.0
        if k > 0 and m > 1:
            dispersion = m / (m - 1) * ((onsets[:, j] - k / total * exposure[:, j]) ** 2).sum() / k
        close(told["dispersion"], dispersion, place)
        for name, scale in (("poisson", 1.0), ("rate", max(1.0, dispersion))):
            low, high = garwood(k / scale, total / scale)
            close(told[name + "_low"], low, place)
            close(told[name + "_high"], high, place)

    intervals, owners = numpy.round(intervals, 12), numpy.array(owners)
    assert found["interval"]["n"] == len(intervals)
    close(found["interval"]["mean"], intervals.mean(), "mean interval")
    ordered = numpy.sort(intervals)
    per_cluster = numpy.bincount(owners, minlength=clusters)
    for name, p in (("p05", 0.05), ("p50", 0.5), ("p95", 0.95)):
        value = numpy.quantile(intervals, p, method="inverted_cdf")
        close(found["interval"][name], value, name)
        n = int(adjusted(numpy.bincount(owners, intervals <= value, minlength=clusters), per_cluster))
        low = int(stats.binom.ppf(tail, n, p))
        high = int(stats.binom.ppf(1 - tail, n, p)) + 1
        low_rank, high_rank = int(numpy.floor(low * len(ordered) / n)), int(numpy.ceil(high * len(ordered) / n))
        close(found["interval"][name + "_low"], ordered[low_rank - 1] if low_rank >= 1 else numpy.nan, name)
        close(found["interval"][name + "_high"], ordered[high_rank - 1] if high <= n else numpy.nan, name)

    slowing = found["slowing"]
    assert slowing["moves"] == len(scores)
    close(slowing["score"], excess / numpy.sqrt(variance), "score")
    close(slowing["stouffer"], numpy.sum(scores) / numpy.sqrt(len(scores)), "stouffer")
    random = numpy.random.default_rng(5)
    rounds = 4000
    permuted = numpy.zeros(rounds, dtype=int)
    for weights, between in trends:
        permuted += random.permuted(numpy.tile(between, (rounds, 1)), axis=1) @ weights
    p = ((permuted <= sum((weights * between).sum() for weights, between in trends)).sum() + 1) / (rounds + 1)
    assert slowing["permutations"] == 9999
    assert abs(slowing["p_value"] - p) < 4 * numpy.sqrt(p * (1 - p) * (1 / rounds + 1 / 9999)) + 1 / rounds, (slowing, p)
    judge_proportion(found["agreement"], agreeing, jerks, "agreement")
    judge_proportion(found["magnitude"]["one_count"], one_count, jerks, "one count")
    return int(jerks.sum())


def judge_study(zerocount, machines):
    text = manifest.format(machines=f"machines: {machines}\n" if machines else "")
    pathlib.Path("study.yaml").write_text(text, encoding="utf-8")
    output = f"study-{machines}.h5"
    subprocess.run([zerocount, "run", "study.yaml", "-o", output], check=True, stderr=subprocess.DEVNULL)
    words = [zerocount, "jerks", output, "--format", "json", "--confidence", str(confidence), "--creep-trials", "5"]
    report = json.loads(subprocess.check_output(words, text=True))
    assert report["name"] == "jerking" and report["confidence"] == confidence
    with h5py.File(output) as file:
        counts = [judge_point(found, file, found["point"], machines) for found in report["points"]]
    assert len(counts) == 2 and min(counts) > 30, counts
    for found in report["points"]:
        creep = found["creep"]
        assert creep["predicted"] == creep["ended"] and creep["lasting_predicted"] == creep["lasting"], creep
    print(f"{counts} jerks agree, {machines} machines")


def main():
    zerocount = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for machines in (0, 16):
            judge_study(zerocount, machines)
        os.chdir("/")


main()
