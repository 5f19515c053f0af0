#!/usr/bin/env python3
"""What `zerocount monitor` tells of the cause of a change, beside a model, for logs of known single causes.

usage: monitor_causes.py PROGRAM [--logs N] [--seed S] [--studies PATTERN] [--jobs N]

Each log is that of a machine with one parameter changed by a factor or an amount, drawn with the seed (default: the number of
the day) from all parameters of its study. The answer is right if it names that parameter, alone or among others, or says that
none of those tried explains the log. Prints each log, and fails where fewer than 95 % of those with an alarm are right (less
what chance allows: a binomial number of wrong ones with a probability below 1 %), or where hardly any is named.
"""
import argparse
import concurrent.futures
import csv
import dataclasses
import datetime
import json
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile

# The manifest, and the parameters that are changed: their values, or amounts where those are 0.
CONTACT = """zerocount: 1
name: contact
seed: 5
machines: 64
trials: 1280
friction: {k1: {uniform: [100, 120]}, alpha: 0.5}
controller: {ki: 4.0e-5, sample_rate: 2000}
command: {targets: [{integers: [-40, 40]}], hold: 0.25}
initial: {encoder_phase: {uniform: [0, 1]}}
"""
AXIS = """zerocount: 1
name: axis
seed: 5
trials: 800
plant: {inertia: 1.0e-4, sliding_damping: 1.0e-3, load: {inertia: 1.5e-4, stiffness: 300, damping: 5.0e-3, gap: 3.0e-4,
  damping_to_ground: 1.0e-3, encoder: motor, friction: {model: coulomb, breakaway: 2.0e-3, coulomb_ratio: 0.9}}}
friction: {model: coulomb, breakaway: 2.0e-3, coulomb_ratio: 0.9}
encoder: {fine: 100000, fine_errors: {noise: 0.2}}
dac: {bits: 16, range: 2}
controller: {sample_rate: 4000, delay: 1, structure: cascade, cascade: {kv: 40, kp: 0.03, ki: 1.0}}
command: {targets: [{integers: [900, 1000]}, 0], hold: 0.2}
initial: {encoder_phase: {uniform: [0, 1]}}
"""


@dataclasses.dataclass
class Study:
    manifest: str
    values: dict  # of parameters that are multiplied
    amounts: dict  # of parameters that are 0: the range of what is added
    spread: dict = dataclasses.field(default_factory=dict)  # range of a value that differs from machine to machine


STUDIES = {
    "contact": Study(
        CONTACT,
        {"friction.k1": None, "friction.k2": 750, "friction.beta": 1e5, "plant.inertia": 5.54e-4, "controller.ki": 4e-5},
        {"encoder.fine_errors.noise": (0.1, 0.6), "controller.delay": (0.5, 2.5), "dac.gain_error": (0.1, 0.6),
         "controller.deadband": (1, 5), "disturbance.torque": (0.05, 0.15)},
        {"friction.k1": (100, 120)},
    ),
    "axis": Study(
        AXIS,
        {"plant.inertia": 1e-4, "plant.sliding_damping": 1e-3, "plant.load.inertia": 1.5e-4, "plant.load.stiffness": 300,
         "plant.load.damping": 5e-3, "plant.load.gap": 3e-4, "plant.load.damping_to_ground": 1e-3,
         "plant.load.friction.breakaway": 2e-3, "friction.breakaway": 2e-3, "encoder.fine_errors.noise": 0.2, "controller.delay": 1,
         "controller.cascade.kv": 40, "controller.cascade.kp": 0.03, "controller.cascade.ki": 1.0},
        {"dac.gain_error": (0.1, 0.6), "disturbance.torque": (2e-4, 2e-3), "disturbance.load.torque": (2e-4, 2e-3)},
    ),
}
NAMES = {"controller.deadband": {"controller.deadband.enter"}}
FEW = ["arrival_time", "band_settling_time[1]", "overshoot", "outcome", "holding_torque", "peak_torque", "final_error"]
BEFORE, AFTER = 192, 256  # trials: whole multiples of the machines of each study


def moves_of(program, folder, trials, seed, settings):
    """Head and rows of the moves of a machine of the study with these settings."""
    words = [word for setting in [f"trials={trials}", f"seed={seed}", *settings] for word in ("--set", setting)]
    subprocess.run([program, "run", folder / "study.yaml", "-o", folder / "one.h5", "--force", "-q", *words], check=True, capture_output=True)
    subprocess.run([program, "export", folder / "one.h5", "-o", folder / "tables", "--force"], check=True, capture_output=True)
    with open(folder / "tables/outcomes.csv", encoding="utf-8") as lines:
        head, *rows = csv.reader(lines)
    return head, rows


def judged(program, name, number, seed):
    """A line about one log, and whether the answer is right; nothing without an alarm."""
    study, draw = STUDIES[name], random.Random(f"{seed} {name} {number}")
    machine = {key: draw.uniform(*limits) for key, limits in study.spread.items()}
    parameter = draw.choice([*study.values, *study.amounts])
    if parameter in study.values:
        factor = draw.choice([-1, 1]) * draw.uniform(math.log(1.25), math.log(2))
        value = math.exp(factor) * (study.values[parameter] or machine[parameter])
        text = f"{parameter} ×{math.exp(factor):.2f}"
    else:
        value = draw.uniform(*study.amounts[parameter])
        value = round(value) if parameter == "controller.deadband" else value
        text = f"{parameter} +{value:.3g}"
    all_columns, since_before = draw.random() < 0.5, draw.random() < 0.5
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        (folder / "study.yaml").write_text(study.manifest, encoding="utf-8")
        subprocess.run([program, "run", folder / "study.yaml", "-o", folder / "model.h5", "-q"], check=True, capture_output=True)
        settings = [f"{key}={number}" for key, number in machine.items()]
        first = draw.randrange(100, 10**6)
        head, rows = moves_of(program, folder, AFTER, first + 1, [*settings, f"{parameter}={value}"])
        if since_before:
            rows = moves_of(program, folder, BEFORE, first, settings)[1] + rows
        columns = [i for i, one in enumerate(head) if all_columns or re.sub(r" \[.*?\]$", "", one) in [*FEW, "move", "target"]]
        with open(folder / "log.csv", "w", encoding="utf-8", newline="") as file:
            csv.writer(file).writerows([[row[i] for i in columns] for row in [head, *rows]])
        result = subprocess.run([program, "monitor", folder / "model.h5", folder / "log.csv", "--format", "json"], capture_output=True, check=False)
    answer = json.loads(result.stdout)
    named = [one["parameter"] for one in answer["parameters"]]
    told = answer["told"]
    text = f"{name} {number}: {text}, {len(columns)} columns, {'from a change on' if since_before else 'all moves'}: "
    if told is None:
        return text + "no alarm", None, 0
    right = told == "none" or bool(set(named) & NAMES.get(parameter, {parameter}))
    shown = ", ".join(f"{one['parameter']} {one['probability']:.2f}" for one in answer["parameters"][:6])
    return text + f"{'' if right else 'WRONG '}{told} of {len(answer['tried'])}: {shown}", right, len(named)


def most_wrong(logs):
    """The most wrong answers among so many that are no reason to doubt 95 %."""
    probability, most = 0.95**logs, 0
    total = probability
    while total < 0.99:
        probability *= (logs - most) / (most + 1) * 0.05 / 0.95
        most += 1
        total += probability
    return most


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--logs", type=int, default=40)
    parser.add_argument("--seed", type=int, default=datetime.date.today().toordinal())
    parser.add_argument("--studies", default="")
    parser.add_argument("--jobs", type=int, default=1)
    arguments = parser.parse_args()
    names = [name for name in STUDIES if re.search(arguments.studies, name)]
    rights, few = [], 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        tasks = [pool.submit(judged, arguments.program, names[i % len(names)], i, arguments.seed) for i in range(arguments.logs)]
        for task in tasks:
            line, right, named = task.result()
            print(line, flush=True)
            rights += [] if right is None else [right]
            few += bool(right) and 1 <= named <= 3
    wrong = rights.count(False)
    print(f"seed {arguments.seed}: {len(rights)} alarms of {arguments.logs} logs, {wrong} wrong, {few} narrowed down to at most three parameters")
    return wrong > most_wrong(len(rights)) or few < len(rights) / 4


if __name__ == "__main__":
    sys.exit(main())
