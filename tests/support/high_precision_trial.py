#!/usr/bin/env python3
"""One trial by high-order collocation in more than double precision: the judge between two integrators in double.

    high_precision_trial.py PARAMETERS.json [-o TRACE.csv] [--digits N]

Reads the parameters of one trial as JSON and writes its samples as CSV. The plant is integrated in 64-bit-mantissa
arithmetic, or with --digits in decimal arithmetic of N ≥ 30 digits; the controller and the DAC, which are software and
compute in double, are computed in double in the stated order.
"""

import argparse
import csv
import json
import math
import sys

import numpy as np

from collocation import Digits, GaussRule, LongDouble
from contact_motion import Contact

COLUMNS = "k,t,target,count,coarse_count,error,code,torque,theta,omega,xp,xh,depth,mode".split(",")


def floor_count(theta, counts_per_revolution, phase, number):
    resolution = number.real(2 * math.pi / counts_per_revolution)
    return int(math.floor(theta / resolution + number.real(phase)))


def clip(value, low, high):
    return min(max(value, low), high)


class Controller:
    """The sampled loop: error, trapezoidal integral, PID and DAC, in double precision and in the stated order."""

    def __init__(self, controller, dac, integral):
        self.kp, self.ki, self.kd = controller["kp"], controller["ki"], controller["kd"]
        self.clamp = controller["anti_windup"] == "clamp"
        self.resolution = dac["resolution"]
        self.low, self.high = -2 ** (dac["bits"] - 1), 2 ** (dac["bits"] - 1) - 1
        self.integral, self.last_error, self.last_count = integral, 0, None

    def decide(self, target, count):
        """The DAC code for this sample."""
        error = target - count
        self.integral = self.integral + self.ki * float(error + self.last_error)
        if self.clamp:
            self.integral = clip(self.integral, self.low * self.resolution, self.high * self.resolution)
        change = 0 if self.last_count is None else count - self.last_count
        self.last_error, self.last_count = error, count
        torque = self.integral + self.kp * float(error) - self.kd * float(change)
        return int(clip(np.rint(torque / self.resolution), self.low, self.high))


def run(parameters, number, order, events=None):
    """Yields one record (dict by column) per sample."""
    contact = Contact(number, GaussRule(order, number), parameters["plant"], parameters["friction"],
                      parameters["initial"])
    controller = Controller(parameters["controller"], parameters["dac"], parameters["initial"].get("integral", 0.0))
    amplifier = number.real(2 * math.pi * parameters.get("amplifier", {}).get("bandwidth", 0.0))
    rate, delay = parameters["controller"]["sample_rate"], parameters["controller"]["delay"]
    period = number.real(1) / number.real(rate)
    samples = int(math.floor(parameters["command"]["hold"] * rate + 0.5))
    phase = parameters["initial"]["encoder_phase"]
    waiting = [0.0] * delay
    drive = number.real(0)
    targets = [target for target in parameters["command"]["targets"] for _ in range(samples)]
    for k, target in enumerate(targets):
        theta = contact.theta()
        count = floor_count(theta, parameters["encoder"]["fine"], phase, number)
        code = controller.decide(target, count)
        torque = code * parameters["dac"]["resolution"]
        yield {
            "k": k, "t": k / rate, "target": target, "count": count,
            "coarse_count": floor_count(theta, parameters["encoder"]["coarse"], phase, number),
            "error": target - count, "code": code, "torque": torque,
            "theta": repr(float(theta)), "omega": repr(float(contact.state[1])),
            "xp": repr(float(contact.state[2])), "xh": repr(float(contact.state[3])),
            "depth": len(contact.stack), "mode": "slide" if contact.sliding else "stick",
        }
        waiting.append(torque)
        settled = number.real(waiting.pop(0))
        if amplifier == 0:
            drive = settled
        contact.advance(drive, settled, amplifier, period)
        drive = settled + (drive - settled) * number.exp(-amplifier * period)
    if events is not None:
        events.update(contact.events)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parameters")
    parser.add_argument("-o", "--output")
    parser.add_argument("--digits", type=int, help="decimal digits, at least 30; without it the 64-bit mantissa")
    parser.add_argument("--order", type=int, default=16, help="collocation nodes per step")
    parser.add_argument("--events", action="store_true", help="count the events on stderr")
    arguments = parser.parse_args()
    with open(arguments.parameters, encoding="utf-8") as file:
        parameters = json.load(file)
    number = Digits(max(arguments.digits, 30)) if arguments.digits else LongDouble()
    events = {}
    output = open(arguments.output, "w", encoding="utf-8", newline="") if arguments.output else sys.stdout
    writer = csv.DictWriter(output, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(run(parameters, number, arguments.order, events))
    output.flush()
    if arguments.events:
        print(events, file=sys.stderr)


if __name__ == "__main__":
    main()
