"""The bets of analysis/machine/monitor/change_test.hpp, once more: `zerocount monitor` beside this program, on random logs.

usage: judge_monitor.py PROGRAM
"""

import hashlib
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

import numpy as np
from scipy.stats import norm

sys.path.insert(0, str(pathlib.Path(__file__).parents[3] / "support"))
from philox import MASK, philox4x32_10

STEPS = [1 / 64, 1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 3 / 4, 7 / 8, 15 / 16, 31 / 32, 63 / 64]


def bits(key, stream, index):
    words = philox4x32_10([index & MASK, index >> 32, 0, stream], key)
    return words[0] | words[1] << 32


# The streams of random numbers keep the names that the measures had first, so that no answer of a seed changes.
FIRST_NAMES = {"arrival_time": "settling_time"}


def p_values(baseline, moves, measure, seed):
    stream = f"{seed}:monitor.{FIRST_NAMES.get(measure, measure)}"
    key = struct.unpack("<2I", hashlib.sha256(stream.encode()).digest()[:8])
    known = list(baseline)
    history = len(known)
    for value in moves:
        before = np.array(known)
        above, equal = int((before > value).sum()), int((before == value).sum())
        u = ((bits(key, 0, history) >> 12) + 0.5) * 2.0**-52
        yield (above + u * (equal + 1)) / (len(known) + 1)
        history = bits(key, 1, history ^ (above + (equal << 32)))
        known.append(value)


def log_gains(p, sizes, step):
    """Logarithms of what a bet on higher values gains at each p-value. `step`: None of normal scores."""
    if step is None:
        return sizes * norm.isf(p) - sizes**2 / 2
    spread = np.sqrt(step * (1 - step))
    bet = np.minimum(sizes, 0.9 * spread / step)
    return np.log1p(bet * np.where(p < step, 1 - step, -step) / spread)


def capitals(p, baseline):
    """The capital after each p-value: a sum over all times of a change, sizes and bets."""
    moves = len(p)
    t = np.arange(1, moves + 1)
    before = baseline + t - 1
    stakes = 1 / np.log2(t + 1) - 1 / np.log2(t + 2)
    total = 1 / np.log2(t + 2)
    highest = np.array([int(n).bit_length() for n in before])
    by_direction = []
    for one_sided in (p, 1 - p):
        sum_of_direction = np.zeros(moves)
        for step in [None, *STEPS]:
            weight = 0.25 if step is None else 0.25 / len(STEPS)
            for exponent in range(highest[0] - 5, highest[-1] + 1):
                staked = np.where((exponent <= highest) & (exponent > highest - 6), stakes * weight / 6, 0.0)
                gains = np.cumsum(log_gains(one_sided, 2.0**exponent / before, step))
                start = np.concatenate([[0.0], gains[:-1]])  # what a stake at each time has missed
                # [time, start]: growth of the stake from then on
                growth = np.tril(np.exp(np.tril(gains[:, None] - start[None, :])))
                sum_of_direction += growth @ staked
        by_direction.append(sum_of_direction)
    return total + sum(by_direction), by_direction


def read_again(baseline, moves, alarm, seed):
    """Evidence, measure, direction and move of the alarm."""
    largest, first = 1 / len(moves), None  # before any move
    for name in moves:
        capital, by_direction = capitals(np.array(list(p_values(baseline[name], moves[name], name, seed))), len(baseline[name]))
        evidence = np.maximum.accumulate(capital / len(moves))
        largest = max(largest, evidence[-1])
        over = np.flatnonzero(capital / len(moves) >= 1 / alarm)
        if over.size and (first is None or over[0] + 1 < first[2]):
            first = (name, "higher" if by_direction[0][over[0]] >= by_direction[1][over[0]] else "lower", int(over[0]) + 1)
    return largest, first or (None, None, None)


def random_values(generator, count, kind, factor):
    if kind == "binary":
        return (generator.random(count) < 0.9 * factor).astype(float)
    values = np.exp(0.3 * generator.standard_normal(count)) * factor
    if kind == "tied":
        values = np.round(values * 4) / 4
    values[generator.random(count) < 0.05] = np.inf
    return values


def write_log(path, columns):
    """What never happened is empty."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(columns) + "\n")
        for row in zip(*columns.values()):
            file.write(",".join("" if np.isinf(v) else repr(float(v)) for v in row) + "\n")


def main():
    program = sys.argv[1]
    generator = np.random.default_rng(20261127)
    kinds = {"arrival_time": "continuous", "jerk_count": "tied", "stable": "binary"}
    alarms = 0
    with tempfile.TemporaryDirectory() as folder:
        for case in range(24):
            names = list(generator.permutation(list(kinds))[: 1 + case % 3])
            size, count = int(generator.integers(2, 120)), int(generator.integers(1, 160))
            factor = generator.choice([1.0, 0.7, 1.3]) if "stable" not in names else generator.choice([1.0, 0.6])
            change = int(generator.integers(0, count))
            baseline = {n: random_values(generator, size, kinds[n], 1.0) for n in names}
            moves = {
                n: np.concatenate(
                    [random_values(generator, change, kinds[n], 1.0), random_values(generator, count - change, kinds[n], factor)]
                )
                for n in names
            }
            write_log(f"{folder}/before.csv", baseline)
            write_log(f"{folder}/after.csv", moves)
            alarm = float(generator.choice([0.001, 0.05]))
            words = [program, "monitor", f"{folder}/before.csv", f"{folder}/after.csv", "--alarm", str(alarm)]
            run = subprocess.run([*words, "--seed", str(case), "--format", "json"], capture_output=True, text=True, check=False)
            answer = json.loads(run.stdout)
            evidence, (measure, direction, at) = read_again(baseline, moves, alarm, case)
            assert abs(answer["evidence"] / evidence - 1) < 1e-9, (case, answer, evidence)
            assert [answer[k] for k in ("measure", "direction", "alarm_at", "moves")] == [measure, direction, at, count], (case, answer)
            assert (run.returncode == 1) == (at is not None), (case, run)
            assert (answer["since"] is None) == (at is None) and (at is None or 1 <= answer["since"] <= at), (case, answer)
            alarms += at is not None
    assert 4 <= alarms <= 20, alarms
    print(f"24 logs, {alarms} alarms: evidence, measure, direction and move of each alarm agree")


main()
