#!/usr/bin/env python3
"""Rates and delays of `zerocount monitor`: false alarms by --block, of days and of exchangeable moves, and delays of detection.

usage: monitor_tables.py PROGRAM MONITOR_RATES ROOT [--machines N]

Compares what it finds with the marked tables of docs/monitor.md (marks.py).

False alarms of exchangeable moves must not exceed what --alarm allows, and all must be near those stated; delays must be within a factor of
1.5 and 4 moves.
"""
import argparse
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

import marks

STUDY = """zerocount: 1
name: blocks
seed: 41
trials: {machines}
friction: {{k1: {{uniform: [70, 150]}}, alpha: {{log_uniform: [0.1, 4]}}}}
controller: {{ki: 4.0e-5, sample_rate: 2000}}
command: {{targets: [{targets}], hold: 0.25}}
initial: {{encoder_phase: {{uniform: [0, 1]}}}}
"""
MEASURES = ["arrival_time", "band_settling_time[1]", "overshoot", "outcome", "holding_torque"]
BASELINE, MOVES = 300, 1000


def spread_of(count, of, all_of):
    """How far a count of `all_of` may be from `count` of `of`, by chance: four standard deviations of both."""
    rate = (count + 1) / (of + 2)
    return 4 * math.sqrt(rate * (1 - rate) * all_of * (1 + all_of / of)) + 1


def machines_by_blocks(program, machines):
    """[measure][block] machines with a false alarm at --alarm 0.05."""
    blocks = [1, 5, 10, 20, 50]
    alarms = {measure: dict.fromkeys(blocks, 0) for measure in MEASURES}
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        targets = ", ".join(["{integers: [-40, 40]}"] * MOVES)
        (folder / "blocks.yaml").write_text(STUDY.format(machines=machines, targets=targets), encoding="utf-8")
        subprocess.run([program, "run", folder / "blocks.yaml", "-o", folder / "blocks.h5", "-q"], check=True, capture_output=True)
        subprocess.run([program, "export", folder / "blocks.h5", "-o", folder / "tables"], check=True, capture_output=True)
        with open(folder / "tables/outcomes.csv", encoding="utf-8") as lines:
            head, *rows = csv.reader(lines)
        for machine in range(machines):
            own = rows[machine * MOVES:(machine + 1) * MOVES]
            for measure in MEASURES:
                column = next(i for i, name in enumerate(head) if re.sub(r" \[[^0-9].*?\]$", "", name) == measure)
                for name, part in (("before", own[:BASELINE]), ("after", own[BASELINE:])):
                    with open(folder / f"{name}.csv", "w", encoding="utf-8", newline="") as file:
                        csv.writer(file).writerows([[head[column]], *([row[column]] for row in part)])
                for block in blocks:
                    result = subprocess.run([program, "monitor", folder / "before.csv", folder / "after.csv", "--alarm", "0.05", "--block",
                                             str(block), "--format", "json"], capture_output=True, check=False)
                    alarms[measure][block] += json.loads(result.stdout)["status"] == "changed"
    return alarms


def check_blocks(program, root, machines):
    failed = False
    found = machines_by_blocks(program, machines)
    for row in marks.rows_below(root, "monitor-blocks", 5):
        block = int(row[0])
        for measure, cell in zip(MEASURES, row[1:], strict=True):
            said, here = int(cell.split()[0]), found[measure][block]
            near = abs(here - said * machines / 200) <= spread_of(said, 200, machines)
            print(f"--block {block}, {measure}: {here} of {machines}; stated: {said} of 200{'' if near else '  <- differs'}", flush=True)
            failed = failed or not near
    return failed


def check_rates(rates, root):
    """The tables that monitor_rates prints: false alarms of exchangeable moves, and delays of lognormal values."""
    failed = False
    printed = subprocess.run([rates], capture_output=True, text=True, check=True).stdout.splitlines()
    rows = {tuple(marks.cells_of(line)[:2]): marks.cells_of(line)[2:] for line in printed if line.startswith("|")}
    for row in marks.rows_below(root, "monitor-exchangeable", 9):
        kind = next(key for key in rows if key[1] == row[1] and key[0] in (row[0], {"continuous": "lognormal"}.get(row[0])))
        for alarm, said, here in zip((0.05, 0.01, 0.001), row[2:], rows[kind], strict=True):
            most = 1000 * alarm + 3 * math.sqrt(1000 * alarm)
            good = int(here) <= most and abs(int(here) - int(said)) <= spread_of(int(said), 1000, 1000)
            print(f"{row[0]}, baseline {row[1]}, --alarm {alarm}: {here} of 1000; stated: {said}{'' if good else '  <- differs'}", flush=True)
            failed = failed or not good
    for row in marks.rows_below(root, "monitor-days", 8):
        for said, here in zip(row[2:5], rows[tuple(row[:2])][:3], strict=True):
            near = abs(int(here) - int(said)) <= spread_of(int(said), 200, 200)
            print(f"days, {row[0]}, {row[1]}: {here} of 200; stated: {said}{'' if near else '  <- differs'}", flush=True)
            failed = failed or not near
    first = {}
    for line in printed:                       # the first table of delays is of lognormal values
        if line.startswith("|") and re.match(r"\| [+-]", line):
            first.setdefault(tuple(marks.cells_of(line)[:2]), marks.cells_of(line)[2:])
    for row in marks.rows_below(root, "monitor-delays", 6):
        here = first[(row[0].replace("−", "-"), row[1])]
        for said, found in zip(row[2:], here, strict=True):
            pairs = list(zip(np.fromstring(said, sep=","), np.fromstring(found, sep=",")))
            near = len(pairs) == 2 and all(a / 1.5 - 4 <= b <= 1.5 * a + 4 for a, b in pairs)
            print(f"{row[0]}, baseline {row[1]}: {found}; stated: {said}{'' if near else '  <- differs'}", flush=True)
            failed = failed or not near
    return failed


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("rates")
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--machines", type=int, default=200)
    arguments = parser.parse_args()
    failed = check_rates(arguments.rates, arguments.root) if arguments.rates != "-" else False
    failed = check_blocks(arguments.program, arguments.root, arguments.machines) or failed
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
