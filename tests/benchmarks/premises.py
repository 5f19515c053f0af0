#!/usr/bin/env python3
"""How many times longer the reference engine takes than the lanes, with each feature of a study.

    tests/benchmarks/premises.py build/release/zerocount
    tests/benchmarks/premises.py OLD/zerocount NEW/zerocount --rows noise coulomb

A time is the CPU time of the user of a whole run with one thread, less that of a run of one trial: the smallest of the repetitions,
which take turns. The workloads are W1, W2 and W3 (bench-*.yaml) with an exponent of creep of 2. With several programs their lanes
are compared with the reference engine of the last one, and the last columns are the time of the first one's lanes over that of the last
one's. Another --seed draws the trials anew.
"""

import argparse
import pathlib
import resource
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TRIALS = {"W1": ("transient", 4000), "W2": ("creep", 200), "W3": ("marginal", 300)}

AMPLIFIER = "amplifier.bandwidth=500"
RIPPLE = "disturbance.ripple=[{amplitude: 1e-3, periods: 36, phase: 1}]"
LINE = "disturbance.vibration=[{amplitude: 1e-4, frequency: 50, phase: 1}]"
SPECTRUM = "disturbance.vibration=[{spectrum: [[1, 1e-10], [100, 1e-10]], lines: 100}]"
NOISE = "encoder.fine_errors.noise=0.1"
LUGRE = ["friction.model=lugre", "friction.sigma0=400"]
LOAD = ["plant.load.inertia=1e-4"]
ROWS = {
    "none": [],
    "delay": ["controller.delay=1"],
    "amplifier": [AMPLIFIER],
    "jitter": ["controller.jitter=1e-4"],
    "missed": ["controller.missed=0.01"],
    "noise": [NOISE],
    "torque": ["disturbance.torque=0.01"],
    "ripple": [RIPPLE],
    "line": [LINE],
    "spectrum": [SPECTRUM],
    "s_curve": ["command.profile.shape=s_curve"],
    "coarse": ["controller.coarse.coarse_beyond=20", "controller.coarse.fine_within=5"],
    "lugre": LUGRE,
    "lugre, amplifier": [*LUGRE, AMPLIFIER],
    "free, amplifier": ["friction.model=none", AMPLIFIER],
    "coulomb": ["friction.model=coulomb"],
    "coulomb, delay": ["friction.model=coulomb", "controller.delay=1"],
    "coulomb, amplifier": ["friction.model=coulomb", AMPLIFIER],
    "coulomb, load": ["friction.model=coulomb", *LOAD],
    "coulomb, ripple": ["friction.model=coulomb", RIPPLE],
    "coulomb, line": ["friction.model=coulomb", LINE],
    "gms": ["friction.model=gms"],
    "gms, load": ["friction.model=gms", *LOAD],
    "gms, amplifier": ["friction.model=gms", AMPLIFIER],
    "load": LOAD,
    "load read": [*LOAD, "plant.load.encoder=load"],
    "load, amplifier": [*LOAD, AMPLIFIER],
    "load, lugre": [*LOAD, *LUGRE],
    "together": [AMPLIFIER, "controller.delay=1", NOISE, "controller.jitter=1e-5", "disturbance.torque=0.01", RIPPLE, LINE],
}


def user_time(program, workload, settings, trials, engine, folder):
    """CPU seconds of a run, without those of the kernel."""
    output = pathlib.Path(folder) / "run.h5"
    command = [program, "run", str(ROOT / f"experiments/bench-{workload}.yaml"), "--threads", "1", "--quiet"]
    command += ["--engine", engine, "-o", str(output)]
    for setting in [f"trials={trials}", "friction.n=2", *settings]:
        command += ["--set", setting]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime  # os.times() counts hundredths
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    output.unlink()
    return used


def times_of(runs, workload, settings, trials, repetitions, folder):
    """CPU seconds of each (program, engine), by turns."""
    best = [float("inf")] * len(runs)
    start = [float("inf")] * len(runs)
    for _ in range(repetitions):
        for i, (program, engine) in enumerate(runs):
            start[i] = min(start[i], user_time(program, workload, settings, 1, engine, folder))
            best[i] = min(best[i], user_time(program, workload, settings, trials, engine, folder))
    return [b - s for b, s in zip(best, start)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+")
    parser.add_argument("--rows", nargs="+", choices=ROWS, default=list(ROWS), metavar="ROW", help=", ".join(ROWS))
    parser.add_argument("--workloads", nargs="+", choices=TRIALS, default=list(TRIALS))
    parser.add_argument("--repetitions", type=int, default=1)
    parser.add_argument("--seed", type=int, default=20020731)
    parser.add_argument("--scale", type=float, default=1.0, help="of the numbers of trials")
    arguments = parser.parse_args()
    programs = [str(pathlib.Path(p).resolve()) for p in arguments.programs]
    runs = [(p, "batch") for p in programs] + [(programs[-1], "reference")]
    names = [*arguments.workloads, *(f"{w}: first/last" for w in arguments.workloads if len(programs) > 1)]
    print(f"| | {' | '.join(names)} |\n| --- |" + " --: |" * len(names))
    with tempfile.TemporaryDirectory() as folder:
        for row in arguments.rows:
            ratios, gains = [], []
            for name in arguments.workloads:
                workload, trials = TRIALS[name]
                settings = [f"seed={arguments.seed}", *ROWS[row]]
                scaled = max(2, round(arguments.scale * trials))
                times = times_of(runs, workload, settings, scaled, arguments.repetitions, folder)
                ratios.append(times[-1] / times[-2])
                gains.append(times[0] / times[-2])
            figures = [f"{r:.1f}" for r in ratios] + [f"{g:.2f}" for g in gains if len(programs) > 1]
            label = ", ".join(f"`{setting}`" for setting in ROWS[row]) or "none"
            print(f"| {label} | {' | '.join(figures)} |", flush=True)


if __name__ == "__main__":
    main()
