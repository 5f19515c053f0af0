"""Encoders, drive and random histories, computed anew from their documented definitions: the random numbers with integers,
quantiles by SciPy, readings with 40 digits, disagreements with fractions."""

import json
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import mpmath
from scipy.special import ndtri
from scipy.stats import binom

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from philox import uniform_at  # noqa: E402

mpmath.mp.dps = 40
mpf = mpmath.mpf


class Encoder:
    def __init__(self, encoder, case):
        self.e, self.case = encoder, case
        self.counts = int(encoder["counts"])
        self.raw = None
        self.lost = 0

    def wave(self, x):
        first = mpmath.floor(mpf(self.case["position"]) * self.counts / (2 * mpmath.pi))
        return mpmath.sin(2 * mpmath.pi * (first + x) / mpf(self.e["interpolation_period"]))

    def uniform(self, key, k):
        return uniform_at(self.e[key], self.case["stream"], self.case["trial"], k)

    def read(self, k, theta):
        e, phase = self.e, mpf(self.case["phase"])
        angle = mpf(self.case["position"]) - mpf(e["eccentricity_angle"])
        theta = mpf(theta) + mpf(e["eccentricity"]) * (mpmath.sin(angle + mpf(theta)) - mpmath.sin(angle))
        x = theta * self.counts / (2 * mpmath.pi) + phase
        x += mpf(e["interpolation"]) * (self.wave(x) - self.wave(phase))
        x += mpf(e["noise"]) * mpf(ndtri(self.uniform("noise_key", k)))
        if theta != 0 and abs(x - mpmath.nint(x)) < 1e-8:
            sys.exit(f"sample {k}: {x} is too close to an edge for this judge")
        raw = int(mpmath.floor(x))
        passed = 0 if self.raw is None else raw - self.raw
        self.raw = raw
        if passed and e["missed"]:
            missed = int(binom.ppf(self.uniform("missed_key", k), abs(passed), e["missed"]))
            self.lost += missed if passed > 0 else -missed
        return raw - self.lost


def possible(fine, coarse, phase, fine_count, coarse_count):
    """Whether some angle, in revolutions, lies in both counts."""
    fine_start, fine_end = ((fine_count + i - phase) / fine for i in (0, 1))
    coarse_start, coarse_end = ((coarse_count + i - phase) / coarse for i in (0, 1))
    return max(fine_start, coarse_start) < min(fine_end, coarse_end)


def judge_measurement(case):
    fine, coarse = (Encoder(case[name], case) for name in ("fine", "coarse"))
    flawed = any(case[name][error] for name in ("fine", "coarse")
                 for error in ("eccentricity", "interpolation", "noise", "missed"))
    disagreements = 0
    for k, theta, fine_count, coarse_count, counted in case["samples"]:
        expected = fine.read(k, theta), coarse.read(k, theta)
        if expected != (fine_count, coarse_count):
            sys.exit(f"sample {k} reads {fine_count, coarse_count}, expected {expected}: {case}")
        phase = Fraction(case["phase"])
        disagreements += not possible(fine.counts, coarse.counts, phase, fine_count, coarse_count)
        if counted != disagreements:
            sys.exit(f"sample {k}: {counted} disagreements, expected {disagreements}: {case}")
    if disagreements and not flawed:
        sys.exit(f"ideal encoders disagree: {case}")
    return disagreements


def converter(case, k, code):
    lowest, highest = -(2 ** (case["bits"] - 1)), 2 ** (case["bits"] - 1) - 1
    middle, half = Fraction(lowest + highest, 2), Fraction(highest - lowest, 2)
    bow = Fraction(case["nonlinearity"]) * (1 - ((code - middle) / half) ** 2)
    torque = Fraction(case["resolution"]) * (1 + Fraction(case["gain_error"])) * (code + bow)
    z = ndtri(uniform_at(case["key"], case["stream"], case["trial"], k))
    return float(torque + Fraction(case["offset"]) + Fraction(case["noise"]) * Fraction(float(z)))


def judge_drive(case):
    """The amplifier's output as the sum of its answers to the steps of its input."""
    inputs = [0.0] * case["delay"]
    rate = 2 * mpmath.pi * mpf(case["bandwidth"])
    scale = case["resolution"] * 2 ** case["bits"] + abs(case["offset"]) + 10 * case["noise"]
    for i, (k, wanted, code, now, settled, given_rate) in enumerate(case["samples"]):
        inputs.append(wanted if case["exact"] else converter(case, k, code))
        if rate:
            steps = zip(inputs[:i + 1], [0.0] + inputs[:i])
            expected = sum((mpf(new) - mpf(old)) * -mpmath.expm1(-rate * (i - j) * mpf(case["sample_time"]))
                           for j, (new, old) in enumerate(steps))
        else:
            expected = inputs[i]
        if abs(now - expected) > 1e-14 * scale or abs(settled - inputs[i]) > 1e-14 * scale:
            sys.exit(f"sample {k}: torque {now} towards {settled}, expected {expected} towards {inputs[i]}: {case}")
        if abs(given_rate - rate) > 1e-15 * rate:
            sys.exit(f"rate {given_rate}, expected {rate}")


def judge_history(case):
    u = [uniform_at(case["key"], case["stream"], case["trial"], k) for k in range(case["reversals"] + 1)]
    level, sign = 0.0, 1 if u[0] >= 0.5 else -1
    if len(case["levels"]) != case["reversals"]:
        sys.exit(f"wrong number of levels: {case}")
    for given, share in zip(case["levels"], u[1:]):
        level = level * (1 - share) + share * sign * case["torque"]
        sign = -sign
        if abs(given - level) > 1e-14 * case["torque"]:
            sys.exit(f"level {given}, expected {level}: {case}")


def main():
    answers = json.loads(subprocess.check_output(sys.argv[1:3]))
    disagreements = [judge_measurement(case) for case in answers["measurement"]]
    for case in answers["drive"]:
        judge_drive(case)
    for case in answers["history"]:
        judge_history(case)
    samples = sum(len(case["samples"]) for case in answers["measurement"])
    if not 0.1 * samples < sum(disagreements) < 0.9 * samples or 0 not in disagreements:
        sys.exit(f"{sum(disagreements)} disagreements in {samples} samples show too little")
    print(f"{samples} readings, {sum(disagreements)} of them impossible, {len(answers['drive'])} drives and "
          f"{len(answers['history'])} histories agree")


main()
