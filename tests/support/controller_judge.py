"""The whole controller written once more, from its definition in words and with SciPy's filters: what codes it decides from
the counts that it reads. Parameters are those of a manifest, as maps inside one another, with None for a limit that is off."""

import math

import numpy as np
from scipy.signal import bilinear, lfilter, lfilter_zi, lfiltic


class Motion:
    """The reference from one target to the next, in rad, as pieces of constant jerk."""

    def __init__(self, profile, start, end, dx):
        self.start, self.end, self.dx = start, end, dx
        self.direction = -1.0 if end < start else 1.0
        self.pieces = []  # (beginning, position, velocity, acceleration, jerk)
        self.duration = 0.0
        travel = abs(end - start) * dx
        if profile["shape"] == "step" or travel == 0.0:
            return
        v_max, a_max = profile["velocity_limit"], profile["acceleration_limit"]
        j_max = profile["jerk_limit"] if profile["shape"] == "s_curve" else math.inf

        def times(v):  # of the jerk, and of the constant acceleration, on the way to the velocity v
            if math.isinf(j_max):
                return 0.0, v / a_max
            if v * j_max >= a_max**2:
                return a_max / j_max, v / a_max - a_max / j_max
            return math.sqrt(v / j_max), 0.0

        def covered(v):
            jerk_time, constant = times(v)
            return v * (2 * jerk_time + constant)

        v = v_max
        if covered(v) > travel:
            low, high = 0.0, v_max
            for _ in range(200):
                v = 0.5 * (low + high)
                low, high = (v, high) if covered(v) < travel else (low, v)
        jerk_time, constant = times(v)
        cruise = max(0.0, (travel - covered(v)) / v)
        a = a_max if math.isinf(j_max) else min(a_max, j_max * jerk_time)
        up = [(jerk_time, 0.0, j_max), (constant, a, 0.0), (jerk_time, a, -j_max)]
        down = [(d, -a0 - (j * d if d else 0.0), j) for d, a0, j in reversed(up)]
        t = x = speed = 0.0
        for d, a0, j in up + [(cruise, 0.0, 0.0)] + down:
            if d == 0.0:
                continue
            self.pieces.append((t, x, speed, a0, j))
            x += speed * d + a0 * d**2 / 2 + j * d**3 / 6
            speed += a0 * d + j * d**2 / 2
            t += d
        self.duration = t

    def at(self, t, nearly):
        """Position in counts, velocity and acceleration just after t."""
        if t >= self.duration - nearly:
            return float(self.end), 0.0, 0.0
        begin, x, v, a, j = [p for p in self.pieces if p[0] <= t + nearly][-1]
        s = t - begin
        position = x + v * s + a * s**2 / 2 + j * s**3 / 6
        velocity = v + a * s + j * s**2 / 2
        if t == 0.0:
            velocity = 0.0
        return (self.start + self.direction * position / self.dx, self.direction * velocity,
                self.direction * (a + j * s))


class Record:
    """A recorded reference: straight between its rows, its rates central differences of them."""

    duration = math.inf

    def __init__(self, rows, dx):
        self.times, positions = np.transpose(rows)
        between = np.diff(positions) / np.diff(self.times)
        span = self.times[2:] - self.times[:-2]
        velocity = np.concatenate([between[:1], (positions[2:] - positions[:-2]) / span, between[-1:]])
        acceleration = np.concatenate([[0.0], 2 * np.diff(between) / span, [0.0]])
        self.values = positions / dx, velocity, acceleration

    def at(self, t, nearly):
        """Position in counts, velocity and acceleration at t; it stands after its last row."""
        position, *rates = (float(np.interp(t, self.times, values)) for values in self.values)
        return (position, 0.0, 0.0) if t > self.times[-1] + nearly else (position, *rates)


class Before:
    """The counts before the first: those of a motion at the velocity v up to the angle 0."""

    def __init__(self, dx, phase, v, T, unit=1.0):
        self.dx, self.phase, self.v, self.T, self.unit = dx, phase, v, T, unit
        self.rate = unit * v * T / dx  # counts per sample

    def of(self, first, j):
        """n of j samples before the first one."""
        passed = math.floor(self.phase) - math.floor(-j * self.v * self.T / self.dx + self.phase)
        return first - self.unit * passed


class Filter:
    """y = b/a·x, past values 0."""

    def __init__(self, b, a):
        self.b, self.a = np.asarray(b, float), np.asarray(a, float)
        self.z = np.zeros(max(len(b), len(a)) - 1)

    def __call__(self, x):
        y, self.z = lfilter(self.b, self.a, [x], zi=self.z)
        return y[0]

    def remember(self, x, y):
        """Past inputs and outputs, the last one first."""
        self.z = lfiltic(self.b, self.a, y, x)

    def settle(self, y):
        """The state in which a constant input gives y; returns that input."""
        gain, pole = self.b.sum(), self.a.sum()
        self.z = np.zeros_like(self.z)
        if gain == 0.0 or pole == 0.0:
            return y
        x = y * pole / gain
        if len(self.z):
            self.z = lfilter_zi(self.b, self.a) * x
        return x


def make_filter(element, T):
    (kind, p), = element.items()
    if kind == "biquad":
        return Filter(p["b"], [1.0, *p["a"]])
    w = 2 * math.pi * p["frequency"]
    prewarped = w / (2 * math.tan(w * T / 2))  # SciPy's bilinear transform is s = 2·fs·(z − 1)/(z + 1)
    if kind == "lowpass":
        b, a = [w**2], [1, 2 * p["damping"] * w, w**2]
    elif kind == "notch":
        b, a = [1, 2 * p["damping"] * p["depth"] * w, w**2], [1, 2 * p["damping"] * w, w**2]
    else:
        root = math.sqrt(p["ratio"])
        b, a = [root / w, 1], [1 / (root * w), 1]
    return Filter(*bilinear(b, a, prewarped))


class Chain:
    def __init__(self, phase, T, dx, dx_velocity, integral, integral_range, before):
        self.p, self.T, self.dx, self.dx_velocity = phase, T, dx, dx_velocity
        self.before = before
        self.integral, self.range = integral, integral_range
        self.inside = False
        self.first = None
        self.window = phase.get("derivative_window", 1)
        self.last_counts = []  # of the last samples, at most the window, the oldest first
        self.last_e = self.last_w = self.added = self.estimate = 0.0
        self.d = before.rate  # the mean of a filter's past inputs
        self.command, self.bus = 0.0, [0.0] * phase["cascade"].get("latency", 0)
        self.fresh = True  # the next sample is the chain's first
        self.holding, self.hold_run, self.still_run, self.wanted = False, 0, 0, 0.0
        cutoff = phase["derivative_cutoff"]
        self.a = 0.0 if cutoff is None else math.exp(-2 * math.pi * cutoff * T)
        self.filters = [make_filter(element, T) for element in phase["filters"]]
        observer = phase["observer"]
        self.observes = observer["bandwidth"] > 0
        if self.observes:
            w = 2 * math.pi * observer["bandwidth"]
            q = [1, math.sqrt(2) * w, w**2]
            self.accelerates = Filter(*bilinear([observer["inertia"] * w**2, 0, 0], q, 1 / T))
            self.drives = Filter(*bilinear([w**2], q, 1 / T))

    def watch(self, count, e, in_force, velocity, acceleration):
        """`count` is that of the velocity loop. What goes on at every sample, whichever chain decides. Returns whether the integral may change."""
        if self.first is None:
            self.first = count
            self.last_counts = [self.before.of(count, j) for j in range(self.window, 0, -1)]
            if self.observes:
                past = [(self.before.of(count, j) - count) * self.dx_velocity for j in (1, 2)]
                self.accelerates.remember(past, [0.0, 0.0])
        self.d = self.a * self.d + (1 - self.a) * (count - self.last_counts[0]) / self.window
        self.pass_count(count)
        band = self.p["deadband"]
        enter = band["enter"]
        if enter is not None:
            leave = enter if band["leave"] is None else band["leave"]
            self.inside = abs(e) <= (leave if self.inside else enter)
        forward = self.p["feedforward"]
        self.added = (forward["velocity"] * velocity + forward["acceleration"] * acceleration +
                      forward["friction"] * np.sign(velocity))
        if self.observes:
            self.estimate = self.accelerates((count - self.first) * self.dx_velocity) - self.drives(in_force)
        zone = self.p["integrator_zone"]
        return not self.inside and (zone is None or abs(e) <= zone)

    def pass_count(self, count):
        self.last_counts = self.last_counts[1:] + [count]

    def run_position_loop(self, k, e, velocity):
        """The velocity command that acts at sample k, also while the torque is held."""
        c = self.p["cascade"]
        if k % c.get("divider", 1) == 0:
            wanted = c["kv"] * self.dx * self.acting(e) + c.get("feedforward", 0.0) * velocity
            step, limit = c.get("resolution"), c.get("limit")
            if step:
                wanted = step * np.rint(wanted / step)
            self.command = wanted if limit is None else min(max(wanted, -limit), limit)
        self.bus.append(self.command)
        self.acts = self.bus.pop(0)

    def acting(self, e):
        """The error with its dead zone."""
        zone = self.p["error_deadband"]
        if zone["band"] is None:
            return e
        if abs(e) <= zone["band"]:
            return 0.0
        return e - math.copysign(zone["band"], e) if zone["form"] == "subtract" else e

    def dwell(self, seconds):
        return max(1, math.floor(seconds / self.T + 0.5))

    def stands_still(self, e, new_target):
        rule = self.p["standstill"]
        if rule["band"] is None:
            return False
        before = 0 if new_target else self.still_run
        self.still_run = before + 1 if abs(e) <= rule["band"] else 0
        return self.still_run >= self.dwell(rule["dwell"]) and not new_target

    def holds(self, e, new_target):
        rule = self.p["hold"]
        fresh, self.fresh = new_target or self.fresh, False
        if rule["enter"] is None:
            return False
        before = 0 if fresh else self.hold_run
        self.hold_run = before + 1 if abs(e) <= rule["enter"] else 0
        goes_on = self.holding and abs(e) <= max(rule["enter"], -1 if rule["leave"] is None else rule["leave"])
        self.holding = not fresh and (goes_on or self.hold_run >= self.dwell(rule["dwell"]))
        return self.holding

    def velocity_error(self):
        return self.acts - self.d * self.dx_velocity / self.T

    def remember(self, e):
        self.last_e, self.last_w = e, self.velocity_error()

    def rest(self, k, count, e, in_force, velocity, acceleration):
        self.run_position_loop(k, e, velocity)
        self.watch(count, e, in_force, velocity, acceleration)
        self.remember(self.acting(e))
        self.fresh, self.still_run = True, 0

    def take_over(self, torque):
        torque = torque + self.estimate - self.added
        for each in reversed(self.filters):
            torque = each.settle(torque)
        self.integral = torque

    def decide(self, k, count, e, in_force, velocity, acceleration, new_target):
        self.run_position_loop(k, e, velocity)
        still = self.stands_still(e, new_target)
        if self.holds(e, new_target):
            self.pass_count(count)
            self.remember(self.acting(e))
            return self.wanted
        changes = self.watch(count, e, in_force, velocity, acceleration)
        p = self.p
        e = self.acting(e)
        gains = p["standstill"] if still else p
        kp, ki, kd = gains["kp"], gains["ki"], gains["kd"]
        cascade = p["structure"] == "cascade"
        w = self.velocity_error()
        increment = (p["cascade"]["ki"] * self.T / 2 * (w + self.last_w) if cascade else ki * (e + self.last_e))
        if changes:
            tau = p["integrator_leak"]
            left = 1.0 if tau is None else math.exp(-self.T / tau)
            self.integral = min(max(left * self.integral + increment, self.range[0]), self.range[1])
        u = self.integral + (p["cascade"]["kp"] * w if cascade else kp * e - kd * self.d)
        self.remember(e)
        for each in self.filters:
            u = each(u)
        self.wanted = u + self.added - self.estimate
        return self.wanted


class Controller:
    def __init__(self, parameters):
        self.p = parameters
        c = parameters["controller"]
        self.T = 1 / c["sample_rate"]
        self.dx = 2 * math.pi / parameters["encoder"]["fine"]
        # Of two encoders, the one that closes the position loop is "fine" here; "other" may be in the velocity loop.
        self.other = parameters["encoder"].get("other") if parameters["encoder"].get("velocity") == "other" else None
        dx_velocity = 2 * math.pi / self.other if self.other else self.dx
        self.fine_per_coarse = parameters["encoder"]["fine"] / parameters["encoder"]["coarse"]
        bits, self.du = parameters["dac"]["bits"], parameters["dac"]["resolution"]
        self.low, self.high = -2**(bits - 1), 2**(bits - 1) - 1
        self.limit = parameters.get("amplifier", {}).get("limit")
        most = math.inf if self.limit is None else self.limit
        limits = (max(self.low * self.du, -most), min(self.high * self.du, most)) if c["anti_windup"] == "clamp" else (-math.inf, math.inf)
        integral = parameters["initial"]["integral"]
        self.beyond = c["coarse"]["coarse_beyond"]
        fine = dict(c, kd=0.0) if self.beyond is not None else c
        start = parameters["initial"]
        v, place = start.get("velocity", 0.0), start.get("phase", 0.5)
        before = {"fine": Before(self.dx, place, v, self.T),
                  "coarse": Before(2 * math.pi / parameters["encoder"]["coarse"], place, v, self.T, self.fine_per_coarse)}
        of_fine = Before(dx_velocity, start.get("other_phase", 0.5), v, self.T) if self.other else before[c["encoder"]]
        self.coarse_before = before[c["coarse"]["encoder"]]
        self.chains = {"fine": Chain(fine, self.T, self.dx, dx_velocity, integral, limits, of_fine),
                       "coarse": Chain(c["coarse"], self.T, self.dx, self.dx, integral, limits, self.coarse_before)}
        self.phase, self.settled, self.last_coarse, self.in_force = "fine", 0, None, 0.0
        self.started = False
        self.last_target = None
        self.k = 0

    def change_phase(self, errors, counts):
        rule = self.p["controller"]["coarse"]
        last = self.coarse_before.of(counts["coarse"], 1) if self.last_coarse is None else self.last_coarse
        moved, self.last_coarse = abs(counts["coarse"] - last), counts["coarse"]
        quiet = abs(errors["coarse"]) <= rule["fine_within"] and moved <= rule["fine_rate"]
        before = self.settled if self.phase == "coarse" else 0
        self.settled = before + 1 if quiet else 0
        if self.phase == "fine":
            new = "coarse" if abs(errors["fine"]) > self.beyond else "fine"
        else:
            dwell = max(1, math.floor(rule["fine_dwell"] / self.T + 0.5))
            new = "fine" if self.settled >= dwell else "coarse"
        changed, self.phase = new != self.phase and self.started, new
        return changed

    def decide(self, reference, velocity, acceleration, fine_count, coarse_count, target, other_count=0):
        """The wanted torque."""
        c = self.p["controller"]
        of = {"fine": float(fine_count), "coarse": coarse_count * self.fine_per_coarse}
        counts = {"fine": of[c["encoder"]], "coarse": of[c["coarse"]["encoder"]]}
        errors = {phase: reference - count for phase, count in counts.items()}
        differs = dict(counts, fine=float(other_count)) if self.other else counts
        changed = self.beyond is not None and self.change_phase(errors, counts)
        if changed:
            self.chains[self.phase].take_over(self.in_force)
        self.started = True
        for phase, chain in self.chains.items():
            if phase != self.phase:
                chain.rest(self.k, differs[phase], errors[phase], self.in_force, velocity, acceleration)
        new_target = self.last_target is not None and self.last_target != target
        self.last_target = target
        wanted = self.chains[self.phase].decide(self.k, differs[self.phase], errors[self.phase], self.in_force,
                                                velocity, acceleration, new_target)
        self.k += 1
        return wanted if self.limit is None else min(max(wanted, -self.limit), self.limit)


def codes_of(parameters, samples):
    """For each (target, count, coarse count, count of the encoder of the other mass) of the samples: the code, whether the phase is coarse, and how far, in codes,
    the wanted torque is from where the code changes."""
    controller = Controller(parameters)
    command = parameters["command"]
    length = math.floor(command["hold"] * parameters["controller"]["sample_rate"] + 0.5)
    result = []
    motion = record = Record(command["reference"]["file"], controller.dx) if "reference" in command else None
    for k, (target, count, coarse_count, other_count) in enumerate(samples):
        if k % length == 0 and not record:
            start = 0 if k == 0 else command["targets"][k // length - 1]
            motion = Motion(command["profile"], start, target, controller.dx)
        t = (k % length) * controller.T
        position, velocity, acceleration = motion.at(t, 1e-6 * controller.T)
        # Half a count goes to the end of the move that is nearer in time.
        nearest = round(position)
        if record:  # what is judged is how it is followed; its target stays
            assert target == nearest, f"sample {k}: the reference {target}, judged {position}"
            target = 0
        elif abs(abs(position - math.floor(position)) - 0.5) < 1e-6:
            towards = start if t < motion.duration / 2 else target
            nearest = math.floor(position) if towards < position else math.ceil(position)
        wanted = controller.decide(nearest, velocity, acceleration, count, coarse_count, target,
                                   other_count) / controller.du
        code = int(min(max(np.rint(wanted), controller.low), controller.high))
        controller.in_force = code * controller.du
        margin = abs(wanted - math.floor(wanted) - 0.5) if controller.low < wanted < controller.high else 0.5
        result.append((code, controller.phase == "coarse", margin))
    return result
