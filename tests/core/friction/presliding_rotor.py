"""The pre-sliding model: a hysteretic spring by Masing's rule, creep with hardening, and a hook that slides."""

import numpy as np
from scipy.optimize import brentq

from rotor import COUNT, Rotor

QUIET = 1e-9 * COUNT  # rad; an oscillation of this size turns no branch round


class Spring:
    """σ(x) = σr + d·f(d·(x − xr)) from the last reversal (xr, σr); ½·side·f(2·side·x) from the virgin state."""

    def __init__(self, case):
        self.k1, self.k2, self.beta = case["k1"], case["k2"], case["beta"]
        self.stack = []
        self.direction = 0  # of the elongation
        self.side = 0  # sgn σ

    def branch(self, u):
        return self.k1 * u - self.k2 / self.beta * np.expm1(-self.beta * u)

    def torque(self, x):
        if not self.stack:
            return self.side * self.branch(2 * self.side * x) / 2
        turn, torque = self.stack[-1]
        return torque + self.direction * self.branch(self.direction * (x - turn))

    def tangent(self, x):
        u = self.direction * (x - self.stack[-1][0]) if self.stack else 2 * self.side * x
        return self.k1 + self.k2 * np.exp(-self.beta * u)

    def head(self, direction, x):
        """Moves in `direction` from now on."""
        if self.direction == -direction:
            self.stack.append((x, self.torque(x)))
        self.direction = direction
        self.side = self.side or direction

    def closure(self):
        """Where the loop closes that the spring is on; None if it is on none."""
        if len(self.stack) >= 2:
            return self.stack[-2][0]
        if self.stack and self.stack[0][0] * self.direction < 0:
            return -self.stack[0][0]
        return None

    def close(self):
        x = self.closure()
        del self.stack[-2:]
        while self.closure() is not None and self.direction * (x - self.closure()) >= 0:
            del self.stack[-2:]

    def load(self, x, torque):
        """The elongation after a slow load to `torque`."""
        missing = torque - self.torque(x)
        if missing == 0:
            return x
        self.head(np.sign(missing), x)
        while self.closure() is not None and self.direction * (torque - self.torque(self.closure())) >= 0:
            x = self.closure()
            self.close()
        if not self.stack:
            self.side = np.sign(torque) or self.side
        end = x + 1.01 * (torque - self.torque(x)) / self.k1
        return brentq(lambda each: self.torque(each) - torque, x, end, xtol=1e-22, rtol=1e-15) if end != x else x


class Presliding(Rotor):
    """State y = [xs, ω, xp, xh, zL, twist, ωL], θ = hook + xs + xp. In a slide xs goes on with θ."""

    def __init__(self, case):
        super().__init__(case)
        self.alpha = 0.0 if case["model"] == "spring" else case["alpha"]
        self.sliding = case["slides"] and case["velocity"] != 0
        self.spring = Spring(case)
        self.hook = 0.0
        self.creeps = self.rests = False
        self.held = 0.0  # torque of the spring when the hook let go
        self.watched = []

    def start(self):
        w, x, hardening = self.case["velocity"], 0.0, 0.0
        if self.sliding:
            self.held = np.sign(w) * self.Fs
        else:
            hardening = self.case["hardening"]
            for torque in self.case["loads"]:
                x = self.spring.load(x, torque)
            if self.case["holding"] == 0:
                self.spring.side = 0  # the last load was 0
            self.creeps = self.alpha > 0 and self.limit(x) >= hardening
        self.hook = -x
        return np.array([x, w, 0.0, hardening, 0.0, self.case["load_twist"], w])

    def theta(self, y):
        return self.hook + y[0] + y[2]

    def creep(self, y):
        return y[2], y[3]

    def scales(self):
        return [1e-6 * COUNT, 1e-6 * COUNT]

    def torque(self, y):
        return self.spring.torque(y[0])

    def stiffness(self):
        return self.spring.k1

    def stands(self, y):
        return not self.sliding and not self.creeps and super().stands(y)

    def slides(self, _):
        return 2.0 if self.sliding else 0.5

    def limit(self, x):
        """The hardening at which creep ends."""
        return abs(self.spring.torque(x)) ** self.case["n"] / self.case["lambda"]

    def creep_rate(self, y):
        return self.alpha * (self.limit(y[0]) - y[3]) if self.creeps else 0.0

    def pull(self, y):
        """On the hook."""
        return self.torque(y) + self.case["presliding_damping"] * y[1]

    def elongation_rate(self, y):
        return y[1] - self.spring.side * self.creep_rate(y)

    def elongation_acceleration(self, t, y):
        acceleration = (self.drive(t, y) - self.pull(y)) / self.case["inertia"]
        if not self.creeps or self.torque(y) == 0:
            return acceleration
        n, sigma = self.case["n"], self.torque(y)
        growth = n * abs(sigma) ** (n - 1) / self.case["lambda"] * self.spring.tangent(y[0]) * self.elongation_rate(y)
        return acceleration - self.alpha * (growth - self.spring.side * self.creep_rate(y))

    def begin(self, t, y):
        if self.sliding:
            return
        if abs(self.pull(y)) > self.Fs and self.pull(y) * y[1] > 0:
            self.break_away(y)
            return
        rate, acceleration = self.elongation_rate(y), self.elongation_acceleration(t, y)
        fastest = np.sqrt((self.spring.k1 + self.spring.k2) / self.case["inertia"])
        now, settled, torque_rate = self.course
        steady = not self.varies and (torque_rate == 0 or now == settled)
        self.rests = steady and abs(rate) < QUIET * fastest and abs(acceleration) < QUIET * fastest**2
        if self.rests:
            return
        heading = self.drive_heads(t, y) if self.varies else settled - now
        if abs(rate) > QUIET * fastest:
            heading = rate
        elif abs(acceleration) > 1e-3 * QUIET * fastest**2:
            heading = acceleration
        if heading != 0:
            self.spring.head(np.sign(heading), y[0])
        if abs(self.torque(y)) < 1e-13 * self.Fs:  # σ = 0 but for rounding: its sign is to come
            self.spring.side = self.spring.direction

    def rate(self, t, y):
        w, drive = y[1], self.drive(t, y)
        if self.sliding:
            friction = self.case["sliding_damping"] * w + self.s * self.level(w)
            return [w, (drive - friction) / self.case["inertia"], 0.0, 0.0] + self.load_rate(t, y)
        creep = self.creep_rate(y)
        extension = self.spring.side * creep
        return [w - extension, (drive - self.pull(y)) / self.case["inertia"], extension, creep] + self.load_rate(t, y)

    def break_away(self, y):
        self.held, self.sliding, self.s = self.torque(y), True, np.sign(y[1])

    def stick(self, y):
        theta = self.theta(y)
        spring = self.spring = Spring(self.case)
        y[:4] = [spring.load(0.0, self.held), 0.0, 0.0, 0.0]
        spring.direction = self.s
        self.hook = theta - y[0]
        self.sliding, self.creeps = False, self.alpha > 0

    def switch_creep(self, _):
        self.creeps = not self.creeps

    def cross_zero(self, _):
        self.spring.side = -self.spring.side

    def turn(self, _):
        """begin() sees which way it goes on."""

    def kinks(self):
        """[(falls through zero there, what happens)]."""
        if self.sliding:
            return [(lambda y: self.s * y[1], self.stick)]
        spring = self.spring
        away = [(lambda y, s=s: -min(s * self.pull(y) - self.Fs, s * y[1]), self.break_away) for s in (1, -1)]
        found = [*away, (lambda y: spring.side * spring.torque(y[0]), self.cross_zero)]
        if not self.rests:
            found.append((lambda y: spring.direction * self.elongation_rate(y), self.turn))
        closure = spring.closure()
        if closure is not None:
            found.append((lambda y: spring.direction * (closure - y[0]), lambda _: spring.close()))
        if self.alpha > 0:
            sign = 1 if self.creeps else -1
            found.append((lambda y: sign * (self.limit(y[0]) - y[3]), self.switch_creep))
        return found

    def events(self):
        self.watched = self.kinks()

        def event_of(guard):
            def event(_, y):
                return guard(y)
            event.terminal, event.direction = True, -1
            return event
        return [event_of(guard) for guard, _ in self.watched]

    def passed(self, number, y):
        self.watched[number][1](y)
