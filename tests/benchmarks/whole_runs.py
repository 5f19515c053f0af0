#!/usr/bin/env python3
"""CPU time of whole runs by several builds of the program, as ratios to the first.

    tests/benchmarks/whole_runs.py OLD/zerocount NEW/zerocount

Each build runs the same manifests with one thread, by turns. A time is the CPU time of the user, for drawing, trials, statistics and
files, less that of a run of one trial: the smallest, and the median of the ratios of each turn. The workloads are transient, creep and
marginal (experiments/bench-*.yaml), each with three sets of distributions: as shipped, with most spreads of the manifest paper-gains;
`uniform`; and `narrow`, both with n = 2. Another --seed draws them anew.
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TRIALS = {"transient": 100_000, "creep": 8_000, "marginal": 4_000}
DISTRIBUTIONS = {
    "shipped": [],
    "uniform": [
        "friction.k1={uniform: [90, 130]}",
        "friction.k2={uniform: [600, 900]}",
        "friction.beta={uniform: [1.0e+5, 2.0e+5]}",
        "friction.alpha={uniform: [0.1, 2]}",
        "friction.lambda={uniform: [5, 20]}",
        "friction.n=2",
    ],
    "narrow": [
        "friction.k1={truncated_normal: {mean: 110, sd: 15, low: 90, high: 130}}",
        "friction.k2={truncated_normal: {mean: 750, sd: 110, low: 600, high: 900}}",
        "friction.beta={lognormal: {median: 2.0e+5, cv: 0.2}}",
        "friction.alpha={log_uniform: [0.25, 1.0]}",
        "friction.lambda={log_uniform: [5, 20]}",
        "friction.n=2",
    ],
}


def user_time(program, workload, settings, trials, folder):
    """CPU seconds of a run, without those of the kernel."""
    command = [program, "run", str(ROOT / f"experiments/bench-{workload}.yaml"), "--threads", "1", "--quiet"]
    output = pathlib.Path(folder) / "run.h5"
    command += ["-o", str(output)]
    for setting in [f"trials={trials}", *settings]:
        command += ["--set", setting]
    before = os.times().children_user
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    used = os.times().children_user - before
    output.unlink()
    return used


def times_of(programs, workload, settings, trials, repetitions, folder):
    """[turn][program] CPU seconds, less the smallest time of a run of one trial."""
    starts = [min(user_time(p, workload, settings, 1, folder) for _ in range(repetitions)) for p in programs]
    turns = range(repetitions)
    return [[user_time(p, workload, settings, trials, folder) - s for p, s in zip(programs, starts)] for _ in turns]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", help="executables; ratios are to the first")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--seed", type=int, default=77, help="of the trials (default 77)")
    parser.add_argument("--scale", type=float, default=1.0, help="of the numbers of trials")
    arguments = parser.parse_args()
    programs = [str(pathlib.Path(p).resolve()) for p in arguments.programs]
    columns = [f"{i + 1}: s" for i in range(len(programs))] + [f"1/{i + 1}" for i in range(1, len(programs))]
    print(f"| workload | distributions | {' | '.join(columns)} |")
    print("| --- | --- |" + " --: |" * len(columns))
    with tempfile.TemporaryDirectory() as folder:
        for workload, trials in TRIALS.items():
            for name, distributions in DISTRIBUTIONS.items():
                settings = [f"seed={arguments.seed}", *distributions]
                scaled = max(1, round(arguments.scale * trials))
                times = times_of(programs, workload, settings, scaled, arguments.repetitions, folder)
                ratios = [statistics.median(t[0] / t[i] for t in times) for i in range(1, len(programs))]
                figures = [f"{min(t):.2f}" for t in zip(*times)] + [f"{ratio:.2f}" for ratio in ratios]
                print(f"| {workload} | {name} | {' | '.join(figures)} |", flush=True)


if __name__ == "__main__":
    main()
