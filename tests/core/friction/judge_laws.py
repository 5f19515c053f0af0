"""Rotors with friction, some with a second mass, integrated anew from the published equations by SciPy's DOP853. Kinks (ω = 0,
elements that begin to slip, a breakaway) are located as events; there is no rest rule."""

import json
import subprocess
import sys

import numpy as np

from presliding_rotor import Presliding
from rotor import COUNT, Rotor, Stuck


class Bristle(Rotor):
    def __init__(self, case):
        super().__init__(case)
        lugre = case["model"] == "lugre"
        self.sigma1 = case["sigma1"] if lugre else 0.0
        self.damping = case["sliding_damping" if lugre else "presliding_damping"]

    def start(self):
        w = self.case["velocity"]
        z = np.sign(w) * self.level(w) / self.case["sigma0"] if self.case["slides"] else self.case["holding"] / self.case["sigma0"]
        return np.array([0.0, w, z, 0.0, self.case["load_twist"], w])

    def stiffness(self):
        return self.case["sigma0"]

    def torque(self, y):
        return self.case["sigma0"] * y[2]

    def scales(self):
        return [1e-6 * COUNT]

    def begin(self, t, y):
        pass

    def bristle_rate(self, y):
        return y[1] - self.case["sigma0"] * abs(y[1]) * y[2] / self.level(y[1])

    def rate(self, t, y):
        zdot = self.bristle_rate(y)
        friction = self.case["sigma0"] * y[2] + self.sigma1 * zdot + self.damping * y[1]
        return [y[1], (self.drive(t, y) - friction) / self.case["inertia"], zdot] + self.load_rate(t, y)

    def passed(self, _, y):
        y[1] = 0.0

    def slides(self, y):
        bristle = abs(self.case["sigma0"] * y[2] + self.sigma1 * self.bristle_rate(y))
        return bristle / (0.99 * self.level(y[1]))


class Elements(Rotor):
    def __init__(self, case):
        super().__init__(case)
        self.kappa, self.eta = np.array(case["elements"]).T
        self.slipping = np.zeros(len(self.eta), bool)

    def start(self):
        w = self.case["velocity"]
        steady = self.case["slides"] and w != 0
        self.slipping[:] = steady
        torques = self.eta * np.sign(w) * self.level(w) * steady
        if not steady:
            torques = self.held_torques()
        return np.concatenate([[0.0, w], torques, [0.0, self.case["load_twist"], w]])

    def held_torques(self):
        """Slowly loaded from 0: each element has its spring's torque, at most its share of the level at rest."""
        held, most = self.case["holding"], self.eta * self.level(0.0)
        sign, low, high = np.sign(held), 0.0, 10 * self.Fs / self.kappa.min()
        for _ in range(200):
            x = (low + high) / 2
            low, high = (x, high) if np.minimum(self.kappa * x, most).sum() < abs(held) else (low, x)
        return sign * np.minimum(self.kappa * high, most)

    def stiffness(self):
        return self.kappa.sum()

    def stands(self, y):
        return not self.slipping.any() and super().stands(y)

    def torque(self, y):
        return y[2:-3].sum()

    def scales(self):
        return list(1e-6 * COUNT * self.kappa)

    def begin(self, _, y):
        reached = self.s * y[2:-3] >= self.eta * self.level(y[1]) * (1 - 1e-12)
        y[2:-3] = np.where(reached & ~self.slipping, self.s * self.eta * self.level(y[1]), y[2:-3])
        self.slipping |= reached

    def rate(self, t, y):
        F, w = y[2:-3], y[1]
        slip = self.case["attraction"] * (self.s * self.eta - F / self.level(w))
        acceleration = (self.drive(t, y) - F.sum() - self.case["sliding_damping"] * w) / self.case["inertia"]
        return np.concatenate([[w, acceleration], np.where(self.slipping, slip, self.kappa * w), self.load_rate(t, y)])

    def events(self):
        def margin_of(i):
            def margin(_, y):
                return self.eta[i] * self.level(y[1]) - self.s * y[2 + i]
            margin.terminal, margin.direction = True, -1
            return margin
        self.sticking = np.flatnonzero(~self.slipping)
        return super().events() + [margin_of(i) for i in self.sticking]

    def passed(self, number, y):
        if number == 0:
            y[1] = 0.0
            self.slipping[:] = False
        else:
            i = self.sticking[number - 1]
            y[2 + i] = self.s * self.eta[i] * self.level(y[1])
            self.slipping[i] = True

    def slides(self, _):
        return 2.0 if self.slipping.all() else 0.5


class Free(Rotor):
    """An air bearing."""

    def start(self):
        return np.array([0.0, self.case["velocity"], 0.0, self.case["load_twist"], self.case["velocity"]])

    def torque(self, _):
        return 0.0

    def stands(self, _):
        return False

    def scales(self):
        return []

    def begin(self, t, y):
        pass

    def events(self):
        return []

    def rate(self, t, y):
        acceleration = (self.drive(t, y) - self.case["presliding_damping"] * y[1]) / self.case["inertia"]
        return [y[1], acceleration] + self.load_rate(t, y)

    def slides(self, _):
        return 2.0


class Coulomb(Free):
    """Stands until the torque on it exceeds Fs, then slides until ω = 0."""

    def __init__(self, case):
        super().__init__(case)
        self.sliding = case["velocity"] != 0

    def begin(self, t, y):
        if not self.sliding and abs(self.drive(t, y)) > self.Fs:
            self.sliding = True

    def passed(self, _, y):
        if self.sliding:
            y[1] = 0.0
        self.sliding = not self.sliding

    def events(self):
        if self.sliding:
            return super(Free, self).events()

        def release(t, y):
            return abs(self.drive(t, y)) - self.Fs
        release.terminal, release.direction = True, 1
        return [release]

    def rate(self, t, y):
        if not self.sliding:
            return [0.0, 0.0] + self.load_rate(t, y)
        friction = self.case["sliding_damping"] * y[1] + self.s * self.level(y[1])
        return [y[1], (self.drive(t, y) - friction) / self.case["inertia"]] + self.load_rate(t, y)

    def slides(self, _):
        return 2.0 if self.sliding else 0.5


LAWS = {"dahl": Bristle, "lugre": Bristle, "gms": Elements, "coulomb": Coulomb, "none": Free, "presliding": Presliding,
        "spring": Presliding}


def judge(case):
    """The largest difference of θ, the twist, and xp and xh, over what is allowed: 1e-6 count, and 1e-9 of the travel."""
    rotor = LAWS[case["model"]](case)
    y = rotor.start()
    travel, worst, slid = 0.0, 0.0, 0
    for now, settled, rate, theta, omega, sliding, twist, *creep in case["samples"]:
        rotor.course = (now, settled, rate)
        before = rotor.theta(y)
        y = rotor.advance(y, case["sample_time"])
        rotor.time += case["sample_time"]
        travel += abs(rotor.theta(y) - before)
        allowed = 1e-6 * COUNT + 1e-9 * travel
        differences = np.subtract([theta, *creep], [rotor.theta(y), *rotor.creep(y)])
        if case["load_inertia"]:
            differences = np.append(differences, twist - y[-2])
        worst = max(worst, np.abs(differences).max() / allowed)
        slid += sliding
        ratio = rotor.slides(y)
        if abs(ratio - 1) > 1e-6 and sliding != (ratio > 1):
            sys.exit(f"slides: {sliding}, at {ratio} of the limit: {case['model']}")
    return worst, slid


def main():
    cases = json.loads(subprocess.check_output(sys.argv[1:3]))
    for model in LAWS:
        all_slid = 0
        kinds = [(loaded, disturbed, plain) for loaded in (False, True) for disturbed in (False, True) for plain in (True, False)]
        for loaded, disturbed, plain in kinds:
            judged = [case for case in cases if case["model"] == model and (case["load_inertia"] > 0) == loaded
                      and disturbed == any(case["disturbance"].values()) and plain == Rotor(case).plain]
            results = []
            for case in judged:
                try:
                    results.append(judge(case))
                except Stuck:
                    if not disturbed and plain:
                        raise
            if 4 * len(results) < 3 * len(judged):
                sys.exit(f"{model}: only {len(results)} of {len(judged)} motions could be judged")
            if not results:
                continue
            worst = max(r[0] for r in results)
            slid = sum(r[1] for r in results)
            print(f"{model}{' with a second mass' if loaded else ''}"
                  f"{' disturbed' if disturbed else ''}"
                  f"{'' if plain else ', and what acts on the load'}: {len(results)} motions, {slid} samples sliding; θ within "
                  f"{worst:.3g} of 1e-6 count + 1e-9 of the travel")
            if worst > 1:
                sys.exit(1)
            all_slid += slid
        if all_slid == 0:
            sys.exit(f"no motion of {model} slides")


main()
