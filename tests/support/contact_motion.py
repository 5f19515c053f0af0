"""Motion of the rotor over one contact: hysteretic spring, creep with hardening, breakaway, sliding and re-stick.

The state is [q, omega, xp, xh, u] with q the rotor's travel since the contact formed and u the motor's torque. Every kink
(reversal, loop closure, creep on or off, breakaway, re-stick) ends a step of the collocation; between kinks all functions
are analytic.
"""

import math

import numpy as np

from collocation import collocate, first_crossing, refine
from contact_friction import Friction, sign


def first_event(step, guards):
    """(fraction of the step, action) of the first event, or (None, None).

    A guard that is broken only for an instant, a loop closed just before the motion turns back, shows at the turning point
    itself: so all guards are looked at there too.
    """
    event, action = None, None
    for guard, consequence in guards:
        fraction = first_crossing(step, guard)
        if fraction is not None and (event is None or fraction < event):
            event, action = fraction, consequence
    found = event is not None and event > 0
    while found:
        found = False
        state = step.at(np.array([event]))
        for guard, consequence in guards:
            at_start, at_event = guard(step.start[:, None])[0], guard(state)[0]
            if consequence != action and at_start > 0 and at_event < 0:
                fraction = refine(step, guard, event * 0, at_start, event, at_event)
                if fraction < event:
                    event, action, found = fraction, consequence, True
                    break
    return event, action


class Contact:
    """The rotor on its present contact."""

    def __init__(self, number, rule, plant, along_rotor, initial):
        self.number, self.rule = number, rule
        real = number.real
        self.J, self.c, self.cs = (real(plant[k]) for k in ("inertia", "presliding_damping", "sliding_damping"))
        self.along_rotor, self.position = along_rotor, real(initial["position"])
        self.zero = real(0)
        self.origin = self.zero  # θ where the contact formed
        self.friction = Friction(number, along_rotor, self.position)
        self.coulomb = along_rotor.get("model") == "coulomb"
        self.state = np.array([self.zero] * 5, dtype=number.dtype)
        self.state[1] = real(initial.get("velocity", 0))
        self.settled, self.rate = self.zero, self.zero
        self.resting, self.frozen, self.creeping = False, False, True
        self.stack, self.direction, self.offset, self.virgin_sign = [], 0, self.zero, 0
        self.events = {}
        self.sliding = self.state[1] != 0 and (self.coulomb or initial.get("mode") == "slide")
        if self.sliding:
            self.direction = sign(self.state[1])
            self.held_torque = self.zero if self.coulomb else self.direction * self.friction.breakaway
        elif not self.coulomb:
            self.state[3] = real(initial["hardening"])
            self.held = self.zero
            for level in [initial["preload"], 0, *initial.get("history_levels", []), 0]:
                self.load_to(real(level))
        self.set_scales()

    def load_to(self, torque):
        """Takes the spring slowly to `torque`, its hook standing: one reversal point, and what its torque closes."""
        s = sign(torque - self.held)
        if s == 0:
            return
        if self.direction not in (0, s):
            self.stack.append((self.offset, self.held))
        self.direction = s
        while len(self.stack) > 1 and s * (torque - self.stack[-2][1]) >= 0:
            del self.stack[-2:]
        if len(self.stack) == 1 and s * (torque + self.stack[0][1]) >= 0:
            del self.stack[:]
        inverse = self.friction.inverse_branch
        if self.stack:
            turn, sigma = self.stack[-1]
            self.offset = turn + s * inverse(self.number, abs(torque - sigma))
        else:
            self.offset = s * inverse(self.number, 2 * abs(torque)) / 2
            self.virgin_sign = s
        self.held = torque

    # -- what the state means ------------------------------------------------------------------------------------

    def theta(self):
        return self.origin + self.state[0]

    def set_scales(self):
        """Fastest natural frequency, rad/s, to two digits; and the tolerances [q, omega, xp, xh, u]."""
        stiffness = float(self.friction.k1 + self.friction.k2)
        self.frequency = self.number.real(round(math.sqrt(stiffness / float(self.J))))
        tol = self.number.tolerance
        self.tolerance = np.array([tol, tol * 1000, tol, tol, tol * 1000], dtype=self.number.dtype)

    def elongation(self, y):
        return y[0] + self.offset - y[2]

    def torque(self, y):
        """Spring torque σ, from the anchor of the present branch."""
        x, f = self.elongation(y), self.friction
        if self.stack:
            turn, sigma = self.stack[-1]
            s = self.direction
            return sigma + s * f.branch(self.number, s * (x - turn))
        s = self.virgin_sign or 1
        return s * f.branch(self.number, 2 * s * x) / 2

    def stiffness(self, y):
        x, f = self.elongation(y), self.friction
        if self.stack:
            return f.branch_slope(self.number, self.direction * (x - self.stack[-1][0]))
        return f.branch_slope(self.number, 2 * (self.virgin_sign or 1) * x)

    def driving(self, sigma):
        """|σ|ⁿ/λ, the hardening at which creep ends."""
        return self.number.power(abs(sigma), self.friction.n) / self.friction.lam

    def creep_rate(self, y, sigma):
        """dxh/dt; creep on or off is held over a step so that the right-hand side is smooth."""
        if not self.creeping:
            return sigma * 0
        return self.friction.alpha * (self.driving(sigma) - y[3])

    @staticmethod
    def signs(sigma):
        return (sigma > 0) * 1 - (sigma < 0) * 1

    def torque_change(self, y):
        """du/dt."""
        return self.rate * (self.settled - y[4])

    def stick_slopes(self, y):
        sigma = self.torque(y)
        hardening = self.creep_rate(y, sigma)
        return np.array([y[1], (y[4] - self.c * y[1] - sigma) / self.J, self.signs(sigma) * hardening, hardening,
                         self.torque_change(y)], dtype=self.number.dtype)

    def elongation_rate(self, y):
        sigma = self.torque(y)
        return y[1] - self.signs(sigma) * self.creep_rate(y, sigma)

    def elongation_acceleration(self, y):
        sigma = self.torque(y)
        acceleration = (y[4] - self.c * y[1] - sigma) / self.J
        if not self.creeping or sigma == 0:
            return acceleration
        rate = self.elongation_rate(y)
        s, n = sign(sigma), self.friction.n
        growth = n * self.number.power(abs(sigma), n - 1) / self.friction.lam * s * self.stiffness(y) * rate
        return acceleration - s * self.friction.alpha * (growth - self.creep_rate(y, sigma))

    def slide_slopes(self, y):
        f, s = self.friction, self.direction
        coulomb = f.coulomb_ratio * f.breakaway
        w = y[1] / f.stribeck_velocity
        level = coulomb + (f.breakaway - coulomb) * self.number.exp(-w * w)
        zero = y[1] * 0
        return np.array([y[1], (y[4] - self.cs * y[1] - s * level) / self.J, zero, zero, self.torque_change(y)],
                        dtype=self.number.dtype)

    # -- events --------------------------------------------------------------------------------------------------

    def target(self):
        """The elongation at which the present loop closes, or None where nothing lies ahead."""
        if len(self.stack) >= 2:
            return self.stack[-2][0]
        if self.stack and sign(self.stack[0][0]) != self.direction:
            return -self.stack[0][0]
        return None

    def close_loops(self):
        x = self.elongation(self.state)
        slack = self.number.tolerance / 100
        while (target := self.target()) is not None and self.direction * (x - target) >= -slack:
            del self.stack[-2:]
            self.virgin_sign = sign(x) or self.direction
            self.note("closure")

    def reverse(self):
        x, sigma = self.elongation(self.state), self.torque(self.state)
        self.stack.append((x, sigma))
        self.direction = -self.direction
        self.note("reversal")
        self.close_loops()

    def break_away(self, s):
        self.held_torque = self.torque(self.state)
        if abs(self.held_torque) * 10**14 < self.friction.breakaway:  # of no sign but by rounding
            self.held_torque = self.zero
        self.sliding, self.frozen, self.direction = True, False, s
        self.note("breakaway")
        if sign(self.held_torque) == -s:
            self.note("breakaway against the spring")

    def stick(self):
        s = self.direction
        self.origin, travel = self.theta(), self.zero
        self.friction = Friction(self.number, self.along_rotor, self.position + self.origin)
        side = sign(self.held_torque)
        self.offset = side * self.friction.inverse_branch(self.number, 2 * abs(self.held_torque)) / 2
        self.state = np.array([travel, self.zero, self.zero, self.zero, self.state[4]], dtype=self.number.dtype)
        self.stack, self.sliding, self.direction, self.virgin_sign = [], False, s, side or s
        self.creeping, self.resting = True, False
        self.set_scales()
        self.note("re-stick")

    def note(self, name):
        self.events[name] = self.events.get(name, 0) + 1

    def guards(self):
        """[(name, function of states that falls below zero at the event, action)]."""
        if self.sliding:
            return [(lambda y: self.direction * y[1], self.stick)]
        found = []
        d = self.direction
        if d and not self.resting:
            found.append((lambda y: d * self.elongation_rate(y), self.reverse))
        target = self.target()
        if target is not None:
            found.append((lambda y: d * (target - self.elongation(y)), self.close_loops))
        if not self.stack and self.virgin_sign and d == -self.virgin_sign:
            found.append((lambda y: self.virgin_sign * self.elongation(y), self.cross_virgin_origin))
        found.append((self.creep_guard(), self.toggle_creep))
        for s in (1, -1):
            found.append((lambda y, s=s: -np.minimum(s * (self.torque(y) + self.c * y[1]) - self.friction.breakaway,
                                                     s * y[1]), lambda s=s: self.break_away(s)))
        return found

    def creep_guard(self):
        """Falls below zero where creep stops or starts.

        While creep is on, the driving term counts as negative beyond σ = 0: otherwise a swift passage through zero, where
        creep stops and starts again, could hide between two points.
        """
        if not self.creeping:
            return lambda y: y[3] - self.driving(self.torque(y))
        side = sign(self.torque(self.state))

        def guard(y):
            sigma = self.torque(y)
            return (self.signs(sigma) * side if side else 1) * self.driving(sigma) - y[3]
        return guard

    def cross_virgin_origin(self):
        self.virgin_sign = -self.virgin_sign
        self.note("virgin origin")

    def toggle_creep(self):
        self.creeping = not self.creeping
        self.note("creep kink")

    def settle(self):
        """Directions at the start of a course of the torque or of a contact, where they may jump."""
        self.frozen = self.resting = False
        if self.sliding or self.coulomb:
            return
        y = self.state
        rate, acceleration = self.elongation_rate(y), self.elongation_acceleration(y)
        change = self.torque_change(y)
        w, still = self.frequency, self.number.still
        moving = sign(rate) if abs(rate) > still * w else sign(acceleration) or sign(change)
        # Rest rule: an oscillation that stays below `still` (rad) turns no branch round during this interval.
        self.resting = change == 0 and abs(rate) <= still * w and abs(acceleration) <= still * w * w
        # ... and where all motion is smaller still, that of rounding, nothing moves.
        calm = still * w / 100
        self.frozen = (change == 0 and abs(rate) <= calm and abs(acceleration) <= calm * w and abs(y[1]) <= calm
                       and self.creep_rate(y, self.torque(y)) <= calm)
        sigma = self.torque(y)
        for s in (1, -1):
            velocity = s * y[1] if y[1] != 0 else s * (y[4] - sigma)
            if s * (sigma + self.c * y[1]) > self.friction.breakaway and velocity > 0:
                return self.break_away(s)
        if self.resting or moving == 0:
            return
        if self.direction == 0:
            self.direction = moving
            self.virgin_sign = self.virgin_sign or moving
        elif moving != self.direction:
            self.reverse()

    def longest_step(self):
        """Steps that cannot jump over what they must see: a part of the natural period, or of the Stribeck peak."""
        if not self.sliding:
            return 1 / (2 * self.frequency)
        speed, peak = abs(self.state[1]), self.friction.stribeck_velocity
        steepest = (max(abs(self.state[4]), abs(self.settled)) + self.friction.breakaway + self.cs * speed) / self.J
        return max(speed / 3, peak / 2) / steepest

    def stand(self, remaining):
        """Lets a Coulomb contact stand, and slide from where |u| exceeds the breakaway torque; the time used.

        |u| is monotonic from where it is within that level; the instant is found by halving.
        """
        level = self.friction.breakaway
        lag = self.state[4] - self.settled

        def torque(time):
            return self.settled + lag * self.number.exp(-self.rate * time)

        high = remaining
        if abs(torque(high)) > level and abs(self.state[4]) <= level:
            low = self.zero
            while low < (middle := (low + high) / 2) < high:
                low, high = (low, middle) if abs(torque(middle)) > level else (middle, high)
                if high - low < remaining * self.number.tolerance:
                    break
        elif abs(self.state[4]) > level:
            high = self.zero
        self.state[4] = torque(high)
        if abs(self.state[4]) > level:
            self.break_away(sign(self.state[4]))
        return high

    def advance(self, now, settled, rate, duration):
        """Moves the rotor for `duration` (s) under the torque settled + (now − settled)·exp(−rate·t), N m."""
        self.state[4], self.settled, self.rate = now, settled, rate
        self.settle()
        if self.frozen:
            return
        remaining = duration
        length = remaining
        while remaining > 0:
            if abs(self.state[4] - self.settled) < self.number.still:
                self.state[4] = self.settled
            if self.coulomb and not self.sliding:
                remaining = remaining - self.stand(remaining)
                continue
            slopes = self.slide_slopes if self.sliding else self.stick_slopes
            length = min(length, remaining)
            length = min(length, self.longest_step())
            tolerance = self.tolerance + abs(self.state) * self.number.tolerance
            step = collocate(self.rule, slopes, self.state, length, tolerance)
            if step is None:
                length = length / 2
                if length * 10**15 < duration:
                    raise ArithmeticError("the step does not converge")
                continue
            event, action = first_event(step, self.guards())
            if event is None:
                self.state = step.end
                remaining = remaining - length
                length = length * 3 / 2
                continue
            self.state = step.at(np.array([event]))[:, 0]
            remaining = remaining - length * event
            was_sliding = self.sliding
            action()
            if was_sliding and not self.sliding:
                self.settle()
