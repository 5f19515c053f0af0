"""Rotors with friction, some with a second mass, integrated anew from the published equations by SciPy's DOP853. Kinks (ω = 0,
elements that begin to slip, a breakaway) are located as events; there is no rest rule."""

import json
import subprocess
import sys

import numpy as np
from scipy.integrate import solve_ivp

COUNT = 3.878509448876288e-06  # rad


class Rotor:
    """State y = [θ, ω, bristle or element torques ..., twist δ of the coupling, ωL]; s is the sign of ω from now on."""

    def __init__(self, case):
        self.case = case
        self.Fs = case["breakaway"]
        self.Fc = case["coulomb_ratio"] * self.Fs
        self.stribeck = 0.0 if case["model"] == "dahl" else self.Fs - self.Fc
        self.course = (0.0, 0.0, 0.0)
        self.s = 0

    def level(self, w):
        return self.Fc + self.stribeck * np.exp(-(w / self.case["stribeck_velocity"]) ** 2)

    def coupling(self, y):
        case = self.case
        return case["load_stiffness"] * y[-2] + case["load_damping"] * (y[1] - y[-1]) if case["load_inertia"] else 0.0

    def load_rate(self, y):
        if not self.case["load_inertia"]:
            return [0.0, 0.0]
        return [y[1] - y[-1], self.coupling(y) / self.case["load_inertia"]]

    def drive(self, t, y):
        now, settled, rate = self.course
        return settled + (now - settled) * np.exp(-rate * t) - self.coupling(y)

    def events(self):
        def halt(_, y):
            return y[1]
        halt.terminal, halt.direction = True, -self.s
        return [halt]

    def stands(self, y):
        """So little motion is left under a constant torque that the judge does not see it."""
        now, settled, rate = self.course
        excess = abs(now - self.torque(y)) / self.stiffness()
        inner = abs(y[1]) * np.sqrt(self.case["inertia"] / self.stiffness())
        if self.case["load_inertia"]:
            inner += abs(y[-2]) * self.case["load_stiffness"] / self.stiffness() + abs(y[-1]) / 100
        return (rate == 0 or now == settled) and excess + inner < 1e-10 * COUNT

    def advance(self, y, duration):
        t = 0.0
        while t < duration:
            if self.stands(y):
                return y
            if y[1] != 0:
                self.s = np.sign(y[1])
            else:
                self.s = np.sign(self.drive(t, y) - self.torque(y)) or np.sign(self.course[1] - self.course[0])
            self.begin(y)
            scale = [1e-6 * COUNT, 1e-4 * COUNT] + self.scales() + [1e-7 * COUNT, 1e-4 * COUNT]
            solution = solve_ivp(self.rate, (t, duration), y, method="DOP853", rtol=1e-12, atol=1e-6 * np.array(scale),
                                 events=self.events(), max_step=duration / 10)
            if not solution.success:
                sys.exit(f"{solution.message}: {self.case['model']}")
            t, y = solution.t[-1], solution.y[:, -1]
            for number, times in enumerate(solution.t_events):
                if len(times):
                    self.passed(number, y)
        return y


class Bristle(Rotor):
    def __init__(self, case):
        super().__init__(case)
        lugre = case["model"] == "lugre"
        self.sigma1 = case["sigma1"] if lugre else 0.0
        self.damping = case["sliding_damping" if lugre else "presliding_damping"]

    def start(self):
        w = self.case["velocity"]
        z = np.sign(w) * self.level(w) / self.case["sigma0"] if self.case["slides"] else 0.0
        return np.array([0.0, w, z, 0.0, w])

    def stiffness(self):
        return self.case["sigma0"]

    def torque(self, y):
        return self.case["sigma0"] * y[2]

    def scales(self):
        return [1e-6 * COUNT]

    def begin(self, y):
        pass

    def bristle_rate(self, y):
        return y[1] - self.case["sigma0"] * abs(y[1]) * y[2] / self.level(y[1])

    def rate(self, t, y):
        zdot = self.bristle_rate(y)
        friction = self.case["sigma0"] * y[2] + self.sigma1 * zdot + self.damping * y[1]
        return [y[1], (self.drive(t, y) - friction) / self.case["inertia"], zdot] + self.load_rate(y)

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
        return np.concatenate([[0.0, w], self.eta * np.sign(w) * self.level(w) * steady, [0.0, w]])

    def stiffness(self):
        return self.kappa.sum()

    def stands(self, y):
        return not self.slipping.any() and super().stands(y)

    def torque(self, y):
        return y[2:-2].sum()

    def scales(self):
        return list(1e-6 * COUNT * self.kappa)

    def begin(self, y):
        reached = self.s * y[2:-2] >= self.eta * self.level(y[1]) * (1 - 1e-12)
        y[2:-2] = np.where(reached & ~self.slipping, self.s * self.eta * self.level(y[1]), y[2:-2])
        self.slipping |= reached

    def rate(self, t, y):
        F, w = y[2:-2], y[1]
        slip = self.case["attraction"] * (self.s * self.eta - F / self.level(w))
        acceleration = (self.drive(t, y) - F.sum() - self.case["sliding_damping"] * w) / self.case["inertia"]
        return np.concatenate([[w, acceleration], np.where(self.slipping, slip, self.kappa * w), self.load_rate(y)])

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
        return np.array([0.0, self.case["velocity"], 0.0, self.case["velocity"]])

    def torque(self, _):
        return 0.0

    def stands(self, _):
        return False

    def scales(self):
        return []

    def begin(self, y):
        pass

    def events(self):
        return []

    def rate(self, t, y):
        acceleration = (self.drive(t, y) - self.case["presliding_damping"] * y[1]) / self.case["inertia"]
        return [y[1], acceleration] + self.load_rate(y)

    def slides(self, _):
        return 2.0


class Coulomb(Free):
    """Stands until the torque on it exceeds Fs, then slides until ω = 0."""

    def __init__(self, case):
        super().__init__(case)
        self.sliding = case["velocity"] != 0

    def begin(self, y):
        if not self.sliding and abs(self.drive(0.0, y)) > self.Fs:
            self.sliding, self.s = True, np.sign(self.drive(0.0, y))

    def advance(self, y, duration):
        # Time 0 of the course moves on with each kink, which Rotor.advance does not do.
        t = 0.0
        while t < duration:
            now, settled, rate = self.course
            self.begin(y)
            if self.sliding and y[1] != 0:
                self.s = np.sign(y[1])
            scale = [1e-6 * COUNT, 1e-4 * COUNT, 1e-7 * COUNT, 1e-4 * COUNT]
            solution = solve_ivp(self.rate, (0.0, duration - t), y, method="DOP853", rtol=1e-12,
                                 atol=1e-6 * np.array(scale), events=self.events(), max_step=duration / 10)
            used, y = solution.t[-1], solution.y[:, -1]
            if any(len(times) for times in solution.t_events):
                if self.sliding:
                    y[1] = 0.0
                self.sliding = not self.sliding
                if self.sliding:
                    self.s = np.sign(self.drive(used, y))
            t += used
            self.course = (settled + (now - settled) * np.exp(-rate * used), settled, rate)
        return y

    def events(self):
        if self.sliding:
            return super(Free, self).events()

        def release(t, y):
            return abs(self.drive(t, y)) - self.Fs
        release.terminal, release.direction = True, 1
        return [release]

    def rate(self, t, y):
        if not self.sliding:
            return [0.0, 0.0] + self.load_rate(y)
        friction = self.case["sliding_damping"] * y[1] + self.s * self.level(y[1])
        return [y[1], (self.drive(t, y) - friction) / self.case["inertia"]] + self.load_rate(y)

    def slides(self, _):
        return 2.0 if self.sliding else 0.5


LAWS = {"dahl": Bristle, "lugre": Bristle, "gms": Elements, "coulomb": Coulomb, "none": Free}


def judge(case):
    """The largest difference of θ and of the twist, over what is allowed: 1e-6 count, and 1e-9 of the travel."""
    rotor = LAWS[case["model"]](case)
    y = rotor.start()
    travel, worst, slid = 0.0, 0.0, 0
    for now, settled, rate, theta, omega, sliding, twist in case["samples"]:
        rotor.course = (now, settled, rate)
        before = y[0]
        y = rotor.advance(y, case["sample_time"])
        travel += abs(y[0] - before)
        allowed = 1e-6 * COUNT + 1e-9 * travel
        worst = max(worst, abs(theta - y[0]) / allowed, abs(twist - y[-2]) / allowed if case["load_inertia"] else 0)
        slid += sliding
        ratio = rotor.slides(y)
        if abs(ratio - 1) > 1e-6 and sliding != (ratio > 1):
            sys.exit(f"slides: {sliding}, at {ratio} of the limit: {case['model']}")
    return worst, slid


def main():
    cases = json.loads(subprocess.check_output([sys.argv[1]]))
    for model in LAWS:
        for loaded in (False, True):
            results = [judge(case) for case in cases if case["model"] == model and (case["load_inertia"] > 0) == loaded]
            worst = max(r[0] for r in results)
            slid = sum(r[1] for r in results)
            print(f"{model}{' with a second mass' if loaded else ''}: {len(results)} motions, {slid} samples sliding; θ within "
                  f"{worst:.3g} of 1e-6 count + 1e-9 of the travel")
            if worst > 1 or slid == 0:
                sys.exit(1)


main()
