#!/usr/bin/env python3
"""What `zerocount monitor` tells of the cause of a change, beside a model.

usage: monitor_causes.py PROGRAM [--machines N] [--rows PATTERN]

Prints each row, and fails where more than one machine in eight has a wrong parameter named alone.
"""
import argparse
import collections
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

STUDY = """zerocount: 1
name: watched
seed: 5
rigs: 64
trials: 1280
friction: {k1: {uniform: [100, 120]}, alpha: 0.5}
controller: {ki: 4.0e-5, sample_rate: 2000}
command: {targets: [{integers: [-40, 40]}], hold: 0.25}
initial: {encoder_phase: {uniform: [0, 1]}}
"""
BEFORE, AFTER = 192, 320  # moves
FEW = ["settling_time", "band_settling_time[1]", "overshoot", "outcome", "holding_torque"]
# Settings of the changed machine, and the parameters that are right to name.
CAUSES = {
    "k1 −15 %": (["friction.k1={softer}"], {"friction.k1"}),
    "inertia +20 %": (["plant.inertia=6.648e-4"], {"plant.inertia"}),
    "encoder noise 0 → 0.1 counts": (["encoder.fine_errors.noise=0.1"], {"encoder.fine_errors.noise"}),
    "torque constant +10 %": (["dac.gain_error=0.1"], {"dac.gain_error"}),
    "ki −20 %": (["controller.ki=3.2e-5"], {"controller.ki"}),
    "a sample more of delay": (["controller.delay=1"], {"controller.delay"}),
    "deadband of 2 counts": (["controller.deadband=2"], {"controller.deadband.enter", "controller.error_deadband.band"}),
    "* encoder scale that swings: 0.5 counts rms below 50 Hz":
        (["encoder.fine_errors={{noise: 0.5, noise_bandwidth: 50}}"], {"encoder.fine_errors.noise"}),
    "* encoder scale that skips 5 % of the counts": (["encoder.fine_errors.missed=0.05"], set()),
    "* amplifier of 100 Hz in place of an ideal one": (["amplifier.bandwidth=100"], {"controller.delay"}),
    "* kp 0 → 2e-4 N m per count": (["controller.kp=2e-4"], set()),
}


def moves_of(program, folder, trials, settings):
    """Head and rows of the moves of a machine of the study with these settings."""
    words = [word for setting in settings for word in ("--set", setting)]
    subprocess.run([program, "run", folder / "study.yaml", "-o", folder / "one.h5", "--force", "-q", "--set", f"trials={trials}", *words],
                   check=True, capture_output=True)
    subprocess.run([program, "export", folder / "one.h5", "-o", folder / "tables", "--force"], check=True, capture_output=True)
    with open(folder / "tables/outcomes.csv", encoding="utf-8") as lines:
        head, *rows = csv.reader(lines)
    return head, rows


def told_of(program, folder, rows, head, columns):
    with open(folder / "log.csv", "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([[row[i] for i in columns] for row in [head, *rows]])
    result = subprocess.run([program, "monitor", folder / "model.h5", folder / "log.csv", "--format", "json"],
                            capture_output=True, check=False)
    return json.loads(result.stdout)


def row_of(program, cause, machines):
    """Of both choices of columns: numbers of machines by what is told, and whether too often wrongly."""
    settings, right = CAUSES[cause]
    cells, failed = [], False
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
        subprocess.run([program, "run", folder / "study.yaml", "-o", folder / "model.h5", "-q"], check=True)
        counts = [collections.Counter(), collections.Counter()]
        for i in range(machines):
            k1 = 100 + 20 * (i + 0.5) / machines
            changed = [setting.format(softer=0.85 * k1) for setting in settings]
            head, rows = moves_of(program, folder, BEFORE, [f"friction.k1={k1}", f"seed={100 + i}"])
            rows = rows + moves_of(program, folder, AFTER, [f"friction.k1={k1}", f"seed={1000 + i}", *changed])[1]
            few = [j for j, name in enumerate(head) if re.sub(r" \[.*?\]$", "", name) in FEW]
            for count, columns in zip(counts, (few, range(len(head)))):
                answer = told_of(program, folder, rows, head, columns)
                told = answer["told"] or "no alarm"
                named = {one["parameter"] for one in answer["parameters"]}
                if told == "one":
                    told = "right" if named <= right else "wrong"
                elif told == "several":
                    told = "several, the right one among them" if named & right else "several"
                count[told] += 1
        for count in counts:
            failed = failed or count["wrong"] > machines / 8
            cells.append(", ".join(f"{number} {told}" for told, number in count.most_common()))
    return cells, failed


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--machines", type=int, default=16)
    parser.add_argument("--rows", default="")
    arguments = parser.parse_args()
    wrong = False
    for cause in (cause for cause in CAUSES if re.search(arguments.rows, cause)):
        cells, failed = row_of(arguments.program, cause, arguments.machines)
        print(f"| {cause} | {cells[0]} | {cells[1]} |", flush=True)
        wrong = wrong or (failed and not cause.startswith("* kp"))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
