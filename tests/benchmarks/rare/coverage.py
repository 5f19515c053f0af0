"""Repeats `zerocount rare` with other seeds, and counts how often its bounds hold the truth.

usage: coverage.py PROGRAM [--repetitions N]     the table of docs/rare.md
       coverage.py PROGRAM --plain CHUNKS NAME   plain trials of a study: moves that are late, for the table TRUTH

The truth of the spring without creep is a closed form: its converter ends at 2047 steps, so that the target of 30 counts is reached
exactly if k1 ≤ 2047·resolution/(29.5·2π/1620000). That of the other studies comes from plain trials.
"""

import argparse
import json
import math
import pathlib
import statistics
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent

# Of each study: within, s; plain moves; of these, moves that were late.
TRUTH = {
    "creeping": [(0.042, 38_000_000, 3684), (0.0445, 38_000_000, 829)],
    "rotors": [(0.044, 6_000_000, 486), (0.0645, 6_000_000, 65)],
    "noisy": [(0.0445, 8_000_000, 568), (0.0465, 8_000_000, 79)],
}

SPRING = """zerocount: 1
name: spring
seed: 1
trials: 100
friction: {model: spring, k1: {lognormal: {median: 110, cv: 0.1}}, k2: 0, breakaway: 10}
dac: {bits: 12, resolution: 1.0e-5}
controller: {ki: 1.0e-5}
command: {targets: [30], hold: 1.0}
initial: {encoder_phase: 0.5}
goal: {band: 0, within: 0.8, moves: 0.99}
"""


def resolution_for(probability):
    k1 = 110.0 * math.exp(-math.sqrt(math.log(1.01)) * statistics.NormalDist().inv_cdf(probability))
    return k1 * 29.5 * 2.0 * math.pi / 1620000.0 / 2047.0


def answers(program, folder, manifest, overrides, repetitions):
    for seed in range(1, repetitions + 1):
        words = [program, "rare", manifest, "-o", folder / "rare.h5", "--format", "json", "-q", "--force"]
        for override in [f"seed={seed}", *overrides]:
            words += ["--set", override]
        yield json.loads(subprocess.run(words, capture_output=True, text=True, check=False).stdout)


def plain_cost(probability, ratio):
    """Plain trials that give bounds with this ratio: of k failures high/low ≈ exp(2·1.96/√k)."""
    return (2.0 * 1.96 / math.log(ratio)) ** 2 / probability


def print_row(name, probability, found):
    held = sum(answer["low"] <= probability <= answer["high"] for answer in found)
    estimated = sum(answer["status"] == "estimated" for answer in found)
    trials = statistics.mean(answer["trials"] for answer in found)
    cost = statistics.mean(
        plain_cost(probability, answer["high"] / answer["low"]) / answer["trials"] for answer in found if answer["low"] > 0.0
    )
    mean = statistics.mean(answer["probability"] or 0.0 for answer in found)
    print(
        f"| {name} | {probability:.3g} | {held} of {len(found)} | {estimated} | {mean / probability:.2f} | {trials:.0f} | {cost:.2g} |",
        flush=True,
    )


def table(program, repetitions):
    print("| study | probability | bounds hold | estimated | mean estimate / probability | trials | plain trials / trials |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        manifest = folder / "spring.yaml"
        manifest.write_text(SPRING, encoding="utf-8")
        for probability in (1e-4, 1e-5, 1e-6, 1e-7, 1e-8):
            overrides = [f"dac.resolution={resolution_for(probability)!r}"]
            print_row("spring", probability, list(answers(program, folder, manifest, overrides, repetitions)))
        for study, rows in TRUTH.items():
            for within, moves, late in rows:
                found = list(answers(program, folder, HERE / f"{study}.yaml", [f"goal.within={within}"], repetitions))
                print_row(study, late / moves, found)


def plain(program, chunks, study):
    import h5py  # only here, so that the table needs no library

    limits = [within for within, _, _ in TRUTH[study]]
    moves, late = 0, [0] * len(limits)
    with tempfile.TemporaryDirectory() as name:
        output = pathlib.Path(name) / "plain.h5"
        for chunk in range(chunks):
            words = [program, "run", HERE / f"{study}.yaml", "-o", output, "-q", "--force", "--set", f"seed={90000 + chunk}"]
            subprocess.run(words, check=True)
            with h5py.File(output) as file:
                times = file["outcome/band_settling_time"][..., list(file["band"]).index(1)].ravel()
            moves += times.size
            for i, within in enumerate(limits):
                late[i] += int((~(times <= within * (1.0 + 1e-12))).sum())
            print(study, [(within, moves, count) for within, count in zip(limits, late)], flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--repetitions", type=int, default=40)
    parser.add_argument("--plain", nargs=2, metavar=("CHUNKS", "NAME"))
    arguments = parser.parse_args()
    if arguments.plain:
        plain(arguments.program.resolve(), int(arguments.plain[0]), arguments.plain[1])
    else:
        table(arguments.program.resolve(), arguments.repetitions)


if __name__ == "__main__":
    main()
