#!/usr/bin/env python3
"""Tunes the designs of experiments/manifests/designs.yaml, each with several seeds of the search, and prints the tables behind docs/findings.md.

    designs.py PROGRAM MANIFEST [--rows TEXT] [--seeds N] [--budget TRIALS] [--jobs N]

A cell is the median over the seeds, with the lowest and the highest in brackets, on 4000 machines that neither the search nor the proof
has seen. Exit code 1 where a sentence of the page does not hold by the medians. All rows with three seeds take about an hour of one core.
"""
import argparse
import concurrent.futures
import os
import pathlib
import statistics
import sys
import tempfile

import tunings

PREMISES = {"no delay": {"controller.delay": "0", "amplifier.bandwidth": "0"},
            "short": {"controller.delay": "0.5", "amplifier.bandwidth": "2000"},
            "usual": {"controller.delay": "1", "amplifier.bandwidth": "1000"},
            "long": {"controller.delay": "1.5", "amplifier.bandwidth": "300"}}
OBSERVER = {"controller.ki": "0", "controller.kp": "100", "controller.observer.bandwidth": "50",
            "tune.free": "{controller.kp: [0, 500], controller.kd: [0, 1], controller.observer.bandwidth: {log: [5, 900]}}"}
ONE_COUNT = {"goal": "{band: 1, within: 0.05, moves: 0.99}"}
LOAD = {"plant.load": "{inertia: 5.54e-4, stiffness: {uniform: [1600, 2400]}, damping: 0.005, encoder: load}"}
AIR = {"friction": "{model: none}", "initial.hardening": "0", "initial.preload": "0", "dac.offset": "{uniform: [-1.2e-4, 1.2e-4]}",
       "dac.bits": "20", "controller.kp": "26", "controller.ki": "1100", "controller.kd": "0.2"}
FINE_DAC = {"dac.bits": "20", "dac.resolution": "2.4e-5"}
AT_USUAL = {"as it is, 2 kHz": {},
            "a dead zone of 1 count": {"controller.deadband": "1"},
            "500 Hz": {"controller.sample_rate": "500"},
            "1 kHz": {"controller.sample_rate": "1000"},
            "4 kHz": {"controller.sample_rate": "4000"},
            "8 kHz": {"controller.sample_rate": "8000"},
            "converter ten times finer": FINE_DAC,
            "converter at 3·k1·Δx": {"dac.bits": "20", "dac.resolution": "1.28e-3"},
            "converter at 10·k1·Δx": {"dac.bits": "20", "dac.resolution": "4.27e-3"},
            "encoder twenty times finer, converter ten times":
                FINE_DAC | {"encoder.fine": "32400000", "command.targets": "[{integers: [20, 600]}]"},
            "a load at 382 to 468 Hz, encoder at the load": LOAD,
            "the same with a wide notch": LOAD | {"controller.filters": "[{notch: {frequency: 428, damping: 1, depth: 0.1}}]"},
            "air bearing without damping": AIR | {"plant.presliding_damping": "0"},
            "air bearing with the damping of the ball bearing": AIR,
            "the same, converter 100 times finer": AIR | {"dac.resolution": "2.4e-6"}}
# What `tune` prints beside the PID, by the parameters that are 0 there.
BESIDE = {(): "PID with an observer", ("controller.kp",): "PID with kp = 0", ("controller.kd",): "PI",
          ("controller.kd", "controller.kp"): "integral alone"}


def rows():
    """(design, premise, settings, options of tune) of each tuning."""
    for premise, loop in PREMISES.items():
        yield "PID: zero counts", premise, loop, ["--extras", "controls"]
        yield "observer with kp, kd, without integral", premise, loop | OBSERVER, ["--extras", "none"]
        yield "PID: ±1 count after", premise, loop | ONE_COUNT, ["--extras", "none"]
        yield "observer with kp, kd: ±1 count after", premise, loop | OBSERVER | ONE_COUNT, ["--extras", "none"]
    for question, settings in AT_USUAL.items():
        yield question, "usual", PREMISES["usual"] | settings, ["--extras", "none"]


def on_new_machines(program, folder, gains, seed):
    """The proportion of the moves that meet the goal, in %, and the p95 of their settling time, in ms."""
    point = tunings.summary_of(program, folder, "tuned.yaml", {"seed": 10 ** 6 + seed, "machines": 4000, "trials": 4000} | gains)[0]
    late = point["bands"][-1]["settling_time"]["p95"]
    return 100.0 * point["goal"]["rate"], None if late is None else 1000.0 * late


def cells_of(program, manifest, budget, row, seed):
    """The values of the cells that one tuning gives: {(design, premise): value}."""
    design, premise, settings, options = row
    trials = budget * (2 if "controls" in options else 1)  # half of it is for the controls
    with tempfile.TemporaryDirectory() as folder:
        answer = tunings.tuned(program, folder, manifest, trials, options, settings | {"seed": seed})
        if not answer["gains"]:
            return {(design, premise): None}
        rate, late = on_new_machines(program, folder, {}, seed)
        if "±1" in design:
            return {(design, premise): late, (f"{design}, in the goal", premise): rate}
        found = {(design, premise): rate}
        for one in answer["alternatives"]:
            if not one["gains"]:
                continue
            gains = one["fixed"] | one["gains"]
            if "controller.observer.bandwidth" in gains:
                gains["controller.observer.inertia"] = 5.54e-4
            found[BESIDE[tuple(sorted(one["fixed"]))], premise] = on_new_machines(program, folder, gains, seed)[0]
        return found


def text_of(values):
    """A cell: "97.5 (97.1–97.8)"."""
    known = [value for value in values if value is not None]
    if not known:
        return "none keeps the margins"
    text = f"{statistics.median(known):.3g}"
    return text if len(known) == 1 else f"{text} ({min(known):.3g}–{max(known):.3g})"


# Of the medians m(design, premise).
SENTENCES = {
    "an observer in place of the integral does as well without delay":
        lambda m: m("observer with kp, kd, without integral", "no delay") > m("PID: zero counts", "no delay") - 0.5,
    "with delay it does worse": lambda m: m("observer with kp, kd, without integral", "long") < m("PID: zero counts", "long") - 0.5,
    "the derivative matters": lambda m: all(m("PI", one) < m("PID with kp = 0", one) - 1.0 for one in PREMISES),
    "kp does not with delay":
        lambda m: all(m("PID with kp = 0", one) > m("PID: zero counts", one) - 0.5 for one in ("short", "usual", "long")),
    "a dead zone of a count loses most zero counts": lambda m: m("a dead zone of 1 count", "usual") < 60.0,
    "4 and 8 kHz hold more zero counts":
        lambda m: min(m("4 kHz", "usual"), m("8 kHz", "usual")) > m("as it is, 2 kHz", "usual") + 0.5,
    "a coarse converter loses them": lambda m: m("converter at 10·k1·Δx", "usual") < 90.0,
    "a notch is not needed":
        lambda m: m("the same with a wide notch", "usual") < m("a load at 382 to 468 Hz, encoder at the load", "usual") + 0.5,
    "an air bearing needs damping beside a finer converter":
        lambda m: m("air bearing with the damping of the ball bearing", "usual") < 50.0 < m("the same, converter 100 times finer", "usual"),
}


def false_sentences(cells):
    """The sentences that the medians contradict; those without all of their cells are left out."""
    def median(design, premise):
        return statistics.median([value for value in cells[design, premise] if value is not None])
    for sentence, holds in SENTENCES.items():
        try:
            if not holds(median):
                yield sentence
        except (KeyError, statistics.StatisticsError):
            print(f"not judged: {sentence}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("manifest", type=pathlib.Path)
    parser.add_argument("--rows", default="", help="only designs and premises whose name contains this")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--budget", type=int, default=60_000, help="trials of a tuning")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    wanted = parser.parse_args()
    program, manifest = str(wanted.program.resolve()), str(wanted.manifest.resolve())
    chosen = [row for row in rows() if wanted.rows in f"{row[0]} {row[1]}"]
    cells = {}
    with concurrent.futures.ThreadPoolExecutor(wanted.jobs) as pool:
        jobs = [pool.submit(cells_of, program, manifest, wanted.budget, row, seed)
                for seed in range(1, wanted.seeds + 1) for row in chosen]
        for job in jobs:
            for cell, value in job.result().items():
                cells.setdefault(cell, []).append(value)
                print(", ".join(cell), value, sep=": ", file=sys.stderr, flush=True)
    print(f"| design | {' | '.join(PREMISES)} |\n| --- |{' --: |' * len(PREMISES)}")
    for design in dict.fromkeys(design for design, _ in cells):
        found = [text_of(cells[design, premise]) if (design, premise) in cells else "" for premise in PREMISES]
        print(f"| {design} | {' | '.join(found)} |")
    wrong = list(false_sentences(cells))
    for sentence in wrong:
        print(f"FALSE: {sentence}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
