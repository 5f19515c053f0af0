"""Gain and phase margins and the peak of the sensitivity of random loops, by the blocks' continuous transfer functions at the frequencies that the bilinear
transform takes z to, the plant by SciPy's zero-order hold, and a search on a grid of frequencies."""

import json
import math
import subprocess
import sys

import numpy as np
from scipy.optimize import brentq, minimize_scalar
from scipy.signal import cont2discrete

worst = {"gain": 0.0, "phase": 0.0, "sensitivity": 0.0, "frequency": 0.0}
found = {"gain": 0, "phase": 0, "no gain": 0, "no phase": 0}


def element_response(element, z, T):
    (kind, p), = element.items()
    if kind == "biquad":
        return np.polyval(p["b"], z) / np.polyval([1, *p["a"]], z)
    w = 2 * math.pi * p["frequency"]
    s = 1 / math.tan(w * T / 2) * (z - 1) / (z + 1)  # over w
    if kind == "lead":
        root = math.sqrt(p["ratio"])
        return (1 + root * s) / (1 + s / root)
    numerator = 1 if kind == "lowpass" else s**2 + 2 * p["damping"] * p["depth"] * s + 1
    return numerator / (s**2 + 2 * p["damping"] * s + 1)


def open_loop(case):
    c = case["controller"]
    T, dx, J = 1 / c["sample_rate"], 2 * math.pi / case["fine"], case["inertia"]
    load = case["load"]
    masses = 2 if load["inertia"] else 1
    A = np.zeros((2 * masses + 1, 2 * masses + 1))  # angle and velocity of the motor, of the load, and the motor's torque
    A[0, 1] = 1
    A[1, :2] = -case["stiffness"] / J, -case["damping"] / J
    A[1, -1] = 1 / J
    if masses == 2:
        twist = np.array([load["stiffness"], load["damping"], -load["stiffness"], -load["damping"], 0])
        A[1] -= twist / J
        A[2, 3] = 1
        A[3] = twist / load["inertia"]
    rate = 2 * math.pi * case["bandwidth"]
    A[-1, -1] = -rate
    B = np.zeros((len(A), 1))
    B[-1] = rate
    if not rate:
        A, B = A[:-1, :-1], A[:-1, -1:]
    motor, of_load = np.eye(1, len(A))[0], np.eye(1, len(A), 2 * (masses - 1))[0]
    position, other = (of_load, motor) if case["position_at_load"] else (motor, of_load)
    outputs = np.array([position, other if case["velocity_by_other"] else position])
    held = lambda t: cont2discrete((A, B, outputs[:1], np.zeros((1, 1))), t, "zoh")[:2]
    whole = math.floor(case["delay"])
    flow, total = held(T)
    now = held(T * (1 + whole - case["delay"]))[1]  # of the torque that acts from within the sample to its end
    poles, modes = np.linalg.eig(flow)

    def plant(z, output):  # rad per N m
        if np.min(np.abs(poles[:, None] - poles[None, :]) + np.eye(len(poles))) > 1e-6:
            residues = [(output @ modes) * np.linalg.solve(modes, b[:, 0]) for b in (now, total - now)]
            return sum((r + before / z) / (z - p) for r, before, p in zip(*residues, poles))
        eye = np.eye(len(flow))
        return np.array([output @ np.linalg.solve(x * eye - flow, now + (total - now) / x)[:, 0] for x in np.atleast_1d(z)])

    tau, cutoff = c["integrator_leak"], c["derivative_cutoff"]
    left = 1.0 if tau is None else math.exp(-T / tau)
    a = 0.0 if cutoff is None else math.exp(-2 * math.pi * cutoff * T)

    def response(z):
        trapezoid = (z + 1) / (z - left)
        angle, of_velocity = (plant(z, output) for output in outputs)  # of the position and of the velocity loop
        window = c["derivative_window"]
        difference = (1 - a) * (1 - z**-float(window)) / window / (1 - a / z)
        if c["structure"] == "cascade":
            g = c["cascade"]
            held = sum(z**-float(j) for j in range(g["divider"])) / g["divider"]
            command = g["kv"] * held * z**-float(g["latency"])
            u = -(g["kp"] + g["ki"] * T / 2 * trapezoid) * (command * angle + difference / T * of_velocity)
        else:
            u = -(c["kp"] + c["ki"] * trapezoid + c["kd"] * difference) * angle / dx
        for element in c["filters"]:
            u = u * element_response(element, z, T)
        w = 2 * math.pi * c["observer"]["bandwidth"]
        if w:
            s = 2 / T * (z - 1) / (z + 1)
            q = w**2 / (s**2 + math.sqrt(2) * w * s + w**2)
            u = (u - c["observer"]["inertia"] * s**2 * q * of_velocity) / (1 - q / z)
        return -u * z**-whole * case["gain"]

    return lambda angle: response(np.exp(1j * np.asarray(angle)))


ANGLES = np.concatenate([np.geomspace(1e-6 * math.pi, 0.01, 5000), np.linspace(0.01, math.pi * (1 - 1e-9), 15000)[1:]])


def margins(L, T, values):  # of the open loop at ANGLES
    def crossings(signal):
        at = np.nonzero(np.diff(np.sign(signal(values))))[0]
        return [brentq(lambda x: float(signal(L([x]))[0]), ANGLES[i], ANGLES[i + 1], xtol=1e-15, rtol=1e-14) for i in at]

    gains = [(x, L([x])[0]) for x in crossings(np.imag)] + [(math.pi, L([math.pi * (1 - 1e-12)])[0])]
    gains = [(1 / abs(value), x / (2 * math.pi * T)) for x, value in gains if value.real < -1e-12]
    phases = [(math.degrees(np.angle(-L([x])[0])), x / (2 * math.pi * T)) for x in crossings(lambda v: np.abs(v) - 1)]
    return gains, phases


def nearest(case, kind, all_margins):
    """The one to judge: nearest to instability. An unstable loop has its gain margin where a stable range of the gain begins, so that the
    nearest crossing need not be it: then the crossing that is told, or none."""
    told = case[kind + "_margin"]
    if kind == "phase":
        return min(all_margins, key=lambda p: abs(p[0]), default=None)
    if case["stable"]:
        return min(all_margins, key=lambda g: abs(math.log(g[0])), default=None)
    return told and min(all_margins, key=lambda g: abs(math.log(g[0] / told[0])), default=None)


def peak_sensitivity(L, values):
    distances = np.abs(1 + values)
    i = min(max(int(np.argmin(distances)), 1), len(ANGLES) - 2)
    found = minimize_scalar(lambda x: abs(1 + L([x])[0]), bounds=(ANGLES[i - 1], ANGLES[i + 1]), method="bounded",
                            options={"xatol": 1e-9 * ANGLES[i]})
    return 1 / min(found.fun, distances[i])


for number, case in enumerate(json.loads(subprocess.run(sys.argv[1], check=True, capture_output=True, text=True).stdout)):
    loop = open_loop(case)
    values = loop(ANGLES)
    for kind, judged in zip(("gain", "phase"), margins(loop, 1 / case["controller"]["sample_rate"], values)):
        judged = nearest(case, kind, judged)
        told = case[kind + "_margin"]
        if (told is None) != (judged is None):
            sys.exit(f"loop {number} ({case['blocks']}): {kind} margin {told}, judged {judged}\n{json.dumps(case)}")
        if told is None:
            found["no " + kind] += 1
            continue
        found[kind] += 1
        value = abs(told[0] / judged[0] - 1) if kind == "gain" else abs(told[0] - judged[0])
        frequency = abs(told[1] / judged[1] - 1)
        if value > 1e-5 or frequency > 1e-5:
            sys.exit(f"loop {number} ({case['blocks']}): {kind} margin {told}, judged {judged}\n{json.dumps(case)}")
        worst[kind] = max(worst[kind], value)
        worst["frequency"] = max(worst["frequency"], frequency)
    value = abs(case["peak_sensitivity"][0] / peak_sensitivity(loop, values) - 1)
    if value > 1e-5:
        sys.exit(f"loop {number} ({case['blocks']}): peak sensitivity differs by {value}\n{json.dumps(case)}")
    worst["sensitivity"] = max(worst["sensitivity"], value)
print(found, worst)
if min(found["gain"], found["phase"]) < 100:
    sys.exit("too few margins")
