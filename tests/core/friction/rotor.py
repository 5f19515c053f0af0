"""What the judged rotors have in common: their torque, their load, and an integration that restarts at each kink."""

import sys

import numpy as np
from scipy.integrate import solve_ivp

COUNT = 3.878509448876288e-06  # rad


class Stuck(Exception):
    """The judge restarts at kinks without end, where rounding decides the direction of a motion of no size."""


class Rotor:
    """State y = [θ, ω, bristle or element torques ..., bristle zL of the load, twist δ of the coupling, ωL]; s is the sign of ω from now on."""

    def __init__(self, case):
        self.case = case
        self.Fs = case["breakaway"]
        self.Fc = case["coulomb_ratio"] * self.Fs
        self.stribeck = 0.0 if case["model"] == "dahl" else self.Fs - self.Fc
        self.course = (0.0, 0.0, 0.0)
        self.time = 0.0
        self.plain = not (case["load_gap"] or case["load_error"] or case["load_damping_to_ground"] or case["load_friction"]
                          or any(case["load_disturbance"].values()))
        self.varies = bool(case["disturbance"]["ripple"] or case["disturbance"]["vibration"] or not self.plain)
        self.s = 0
        self.on_load = case["load_friction"]
        self.load_stands = case["velocity"] == 0
        self.load_s = np.sign(case["velocity"])  # of ωL from now on
        self.side = None  # of the gap: −1, 0, 1; None before the start

    def level(self, w):
        return self.Fc + self.stribeck * np.exp(-(w / self.case["stribeck_velocity"]) ** 2)

    def transmission(self, y):
        return 1 + sum(a * q * np.cos(q * self.theta(y) + phase) for a, q, phase in self.case["load_error"])

    def twist_rate(self, y):
        return self.transmission(y) * y[1] - y[-1]

    def coupling(self, y):
        """On the load."""
        case = self.case
        if not case["load_inertia"] or case["load_gap"] and not self.side:
            return 0.0
        h = y[-2] - (self.side * case["load_gap"] / 2 if case["load_gap"] else 0.0)
        return case["load_stiffness"] * h + case["load_damping"] * self.twist_rate(y)

    def load_theta(self, y):
        error = sum(a * np.sin(q * self.theta(y) + phase) for a, q, phase in self.case["load_error"])
        return self.theta(y) + error - y[-2]

    def torque_on_load(self, t, y):
        torque = self.coupling(y) - self.case["load_damping_to_ground"] * y[-1]
        return torque + self.waves(self.case["load_disturbance"], t, self.load_theta(y))

    def load_level(self, w):
        p = self.on_load
        excess = 0.0 if p["model"] == "dahl" else p["breakaway"] * (1 - p["coulomb_ratio"])
        return p["breakaway"] * p["coulomb_ratio"] + excess * np.exp(-(w / p["stribeck_velocity"]) ** 2)

    def load_rate(self, t, y):
        if not self.case["load_inertia"]:
            return [0.0, 0.0, 0.0]
        torque, p, zdot = self.torque_on_load(t, y), self.on_load, 0.0
        if p and p["model"] == "coulomb":
            torque = 0.0 if self.load_stands else torque - self.load_s * self.load_level(y[-1])
        elif p:
            zdot = y[-1] - p["sigma0"] * abs(y[-1]) * y[-3] / self.load_level(y[-1])
            torque -= p["sigma0"] * y[-3] + (p["sigma1"] * zdot if p["model"] == "lugre" else 0.0)
        return [zdot, self.twist_rate(y), torque / self.case["load_inertia"]]

    def begin_load(self, t, y):
        p = self.on_load
        if not p:
            return
        torque = self.torque_on_load(t, y)
        self.load_idles = p["model"] != "coulomb" and y[-1] == 0 and torque == p["sigma0"] * y[-3]
        if y[-1] != 0:
            self.load_s = np.sign(y[-1])
        elif p["model"] != "coulomb":
            self.load_s = np.sign(torque - p["sigma0"] * y[-3]) or self.load_s or 1.0
        elif abs(torque) > p["breakaway"]:
            self.load_stands, self.load_s = False, np.sign(torque)
        elif abs(torque) < (1 - 1e-9) * p["breakaway"]:
            self.load_stands = True

    def load_events(self):
        p = self.on_load
        if not p or self.load_idles:
            return []
        stands = p["model"] == "coulomb" and self.load_stands

        def event(t, y):
            return p["breakaway"] - abs(self.torque_on_load(t, y)) if stands else self.load_s * y[-1]
        event.terminal, event.direction = True, -1
        return [event]

    def load_passed(self, t, y):
        if self.on_load["model"] == "coulomb" and self.load_stands:
            self.load_stands, self.load_s = False, np.sign(self.torque_on_load(t, y))
            y[-1] = 1e-13 * self.load_s  # so that the rounded torque does not stop it at once
            return
        y[-1] = 0.0
        self.load_stands = abs(self.torque_on_load(t, y)) <= self.on_load["breakaway"]

    def heading_of_twist(self, t, y):
        """The sign of the change of the twist on an edge of the gap."""
        return np.sign(self.twist_rate(y)) or -np.sign(self.load_rate(t, y)[2])

    def side_at_start(self, y):
        half = self.case["load_gap"] / 2
        if abs(y[-2]) == half and half:
            self.side = 0
            outside = self.heading_of_twist(0.0, y) * y[-2] > 0
        else:
            outside = abs(y[-2]) > half
        self.side = np.sign(y[-2]) if outside else 0

    def edges(self):
        """Events at which the twist comes to an edge of the gap, and the side that begins there."""
        if not self.case["load_gap"]:
            return []

        def edge_of(side, direction):
            def edge(_, y):
                return y[-2] - side * self.case["load_gap"] / 2
            edge.terminal, edge.direction = True, direction
            return edge
        if self.side:
            return [(edge_of(self.side, -self.side), 0)]
        return [(edge_of(1, 1), 1), (edge_of(-1, -1), -1)]

    def disturbance(self, t, y):
        return self.waves(self.case["disturbance"], t, self.theta(y))

    def waves(self, waves, t, theta):
        along = sum(a * np.sin(q * theta + phase) for a, q, phase in waves["ripple"])
        return waves["torque"] + along + sum(a * np.sin(w * (self.time + t) + phase) for a, w, phase in waves["vibration"])

    def drive(self, t, y):
        now, settled, rate = self.course
        return settled + (now - settled) * np.exp(-rate * t) + self.disturbance(t, y) - self.transmission(y) * self.coupling(y)

    def drive_heads(self, t, y):
        """The sign of the rate of the drive, where it alone decides the direction."""
        e = 1e-7
        ahead = y.copy()
        ahead[0] += e * y[1]
        return np.sign(self.course[1] - self.course[0]) or np.sign(self.disturbance(t + e, ahead) - self.disturbance(t, y))

    def theta(self, y):
        return y[0]

    def creep(self, _):
        """xp and xh."""
        return 0.0, 0.0

    def events(self):
        def halt(_, y):
            return y[1]
        halt.terminal, halt.direction = True, -self.s
        return [halt]

    def stands(self, y):
        """So little motion is left under a constant torque that the judge does not see it."""
        now, settled, rate = self.course
        if self.varies:
            return False
        excess = abs(now + self.case["disturbance"]["torque"] - self.torque(y)) / self.stiffness()
        inner = abs(y[1]) * np.sqrt(self.case["inertia"] / self.stiffness())
        if self.case["load_inertia"]:
            inner += abs(y[-2]) * self.case["load_stiffness"] / self.stiffness() + abs(y[-1]) / 100
        return (rate == 0 or now == settled) and excess + inner < 1e-10 * COUNT

    def advance(self, y, duration):
        t = 0.0
        restarts = 0
        if self.side is None:
            self.side_at_start(y)
        while t < duration:
            restarts += 1
            if self.varies and restarts > 200:
                raise Stuck
            if self.stands(y):
                return y
            if y[1] != 0:
                self.s = np.sign(y[1])
            else:
                self.s = np.sign(self.drive(t, y) - self.torque(y)) or self.drive_heads(t, y)
            self.begin(t, y)
            self.begin_load(t, y)
            scale = [1e-6 * COUNT, 1e-4 * COUNT] + self.scales() + [1e-6 * COUNT, 1e-7 * COUNT, 1e-4 * COUNT]
            edges, own, of_load = self.edges(), self.events(), self.load_events()
            solution = solve_ivp(self.rate, (t, duration), y, method="DOP853", rtol=1e-12, atol=1e-6 * np.array(scale),
                                 events=own + of_load + [edge for edge, _ in edges], max_step=duration / (60 if self.case["load_gap"] or self.on_load else 10),
                                 first_step=min(1e-9, duration - t) if self.varies else None)
            if not solution.success:
                sys.exit(f"{solution.message}: {self.case['model']}")
            t, y = solution.t[-1], solution.y[:, -1]
            for number, times in enumerate(solution.t_events):
                if len(times) and number < len(own):
                    self.passed(number, y)
                elif len(times) and number < len(own + of_load):
                    self.load_passed(t, y)
                elif len(times):
                    self.side = edges[number - len(own + of_load)][1]
        return y
