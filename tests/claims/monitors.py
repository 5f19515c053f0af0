#!/usr/bin/env python3
"""Delays of detection of `zerocount monitor` for changes of one simulated machine: the table of docs/monitor.md.

usage: monitors.py PROGRAM ROOT [--rows PATTERN]

Prints each row, and fails where a delay that the page states beside its mark is off by more than a factor of 1.5 and 4 moves.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
from scipy.stats import mannwhitneyu

import marks

MACHINE = """zerocount: 1
name: watched
seed: 31
trials: {trials}
friction: {{k1: 110, alpha: 0.5}}
controller: {{ki: 4.0e-5, sample_rate: 2000}}
command: {{targets: [{{integers: [-40, 40]}}], hold: 0.25}}
initial: {{encoder_phase: {{uniform: [0, 1]}}}}
"""
# The settings of each change, by the mark in its row.
CHANGES = {
    "monitor-k1-5": ["friction.k1=104.5"],
    "monitor-k1-10": ["friction.k1=99"],
    "monitor-k1-20": ["friction.k1=88"],
    "monitor-creep": ["friction.alpha=1"],
    "monitor-noise": ["encoder.fine_errors.noise=0.2"],
    "monitor-scale-swings": ["encoder.fine_errors={noise: 0.5, noise_bandwidth: 50}"],
    "monitor-scale-skips": ["encoder.fine_errors.missed=0.01"],
    "monitor-breakaway": ["friction.breakaway=0.27"],
}
MEASURES = ["arrival_time", "band_settling_time[1]", "overshoot", "outcome", "holding_torque"]
SEQUENCES, BASELINE, UNCHANGED, LONGEST, ALARM = 40, 500, 300, 2500, 0.001


def simulated(program, folder, moves, settings):
    """The moves of the machine: rows of the columns that are watched, and their heads."""
    manifest, file, tables = folder / "machine.yaml", folder / "machine.h5", folder / "tables"
    manifest.write_text(MACHINE.format(trials=moves), encoding="utf-8")
    options = [word for setting in settings for word in ("--set", setting)]
    subprocess.run([program, "run", manifest, "-o", file, "--force", "-q", *options], check=True, capture_output=True)
    subprocess.run([program, "export", file, "-o", tables, "--force"], check=True, capture_output=True)
    with open(tables / "outcomes.csv", encoding="utf-8") as lines:
        rows = list(csv.reader(lines))
    chosen = [i for i, head in enumerate(rows[0]) if re.sub(r" \[.*?\]$", "", head) in MEASURES]
    return [rows[0][i] for i in chosen], [[row[i] for i in chosen] for row in rows[1:]]


def write_log(path, heads, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([heads, *rows])


def answer_to(program, folder, heads, before, after):
    write_log(folder / "before.csv", heads, before)
    write_log(folder / "after.csv", heads, after)
    result = subprocess.run([program, "monitor", folder / "before.csv", folder / "after.csv", "--alarm", str(ALARM), "--format", "json"],
                            capture_output=True, check=False)
    return json.loads(result.stdout)


def ranked(rows, heads):
    """[measure][move] numbers for a rank test: never is larger than any, an outcome is whether it is zero_count."""
    columns = []
    for i, head in enumerate(heads):
        if head == "outcome":
            columns.append(np.array([row[i] == "zero_count" for row in rows], float))
        else:
            numbers = np.array([float(row[i] or "nan") for row in rows])
            columns.append(np.where(np.isnan(numbers), np.inf, numbers))
    return columns


def fixed_length(before, after, lengths):
    """Moves that the best Mann-Whitney test of fixed length needs for a power of 50 and 90 %, by the sequences."""
    found = []
    for power in (0.5, 0.9):
        def is_enough(length):
            seen = [any(mannwhitneyu(b, a[:length], method="asymptotic").pvalue < ALARM / len(MEASURES)
                        for b, a in zip(b_all, a_all) if np.ptp(np.concatenate([np.nan_to_num(b, posinf=1e9), np.nan_to_num(a[:length], posinf=1e9)])) > 0)
                    for b_all, a_all in zip(before, after)]
            return np.mean(seen) >= power
        found.append(next((length for length in lengths if is_enough(length)), None))
    return found


def row_of(program, name, same, heads):
    """Delays that 50 and 90 % of the sequences do not exceed, those of tests of fixed length, and the measures of the alarms."""
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        _, changed = simulated(program, folder, SEQUENCES * LONGEST, [*CHANGES[name], "seed=32"])
        delays, first, before_all, after_all = [], {}, [], []
        for i in range(SEQUENCES):
            own = same[i * (BASELINE + UNCHANGED):(i + 1) * (BASELINE + UNCHANGED)]
            later = changed[i * LONGEST:(i + 1) * LONGEST]
            answer = answer_to(program, folder, heads, own[:BASELINE], own[BASELINE:] + later)
            delay = (answer["alarm_at"] or np.inf) - UNCHANGED
            delays.append(delay if delay > 0 else np.inf)
            if np.isfinite(delays[-1]):
                first[answer["measure"]] = first.get(answer["measure"], 0) + 1
            before_all.append(ranked(own[:BASELINE], heads))
            after_all.append(ranked(later, heads))
        lengths = [2, 4, 6, 8, 10, 13, 17, 20, 25, 30, 40, 50, 60, 80, 100, 130, 160, 200, 250, 320, 400, 500, 640, 800, 1000, 1300, 1600, 2000, 2500]
        return (np.quantile(delays, [0.5, 0.9], method="higher"), fixed_length(before_all, after_all, lengths),
                sorted(first, key=first.get, reverse=True))


def stated_delays(root, name):
    """The two delays that the page has before the mark; None where it says that they are not within the longest sequence."""
    row = next((mark.before for mark in marks.marks_of(root) if mark.name == name), None)
    if row is None:
        sys.exit(f"no page has the mark {name}")
    cell = row.split("|")[-1].strip()
    return None if cell.startswith("not within") else [float(number) for number in cell.split(",")]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--rows", default="")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        heads, same = simulated(arguments.program, pathlib.Path(folder), SEQUENCES * (BASELINE + UNCHANGED), [])
    failed = False
    for name in (name for name in CHANGES if arguments.rows in name):
        delays, fixed, measures = row_of(arguments.program, name, same, heads)
        print(f"| {name} | {delays[0]:g}, {delays[1]:g} | {fixed[0]}, {fixed[1]} | {', '.join(measures[:3])} |", flush=True)
        stated = stated_delays(arguments.root, name)
        for found, said in zip(delays, stated or [np.inf, np.inf], strict=True):
            near = found == said or said / 1.5 - 4 <= found <= 1.5 * said + 4
            failed = failed or not near
            if not near:
                print(f"  the page says {said:g}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
