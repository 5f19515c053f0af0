"""What `zerocount trace` prints of controllers with blocks: code and torque recomputed from the counts it prints, the parameters
from the manifest. Each block alone, and all of them; in one phase and in two."""

import copy
import csv
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from controller_judge import codes_of  # noqa: E402

PROGRAM = sys.argv[1]
OFF = {"structure": "pid", "cascade": {"kv": 150, "kp": 0.4, "ki": 60}, "deadband": {"enter": None, "leave": None},
       "integrator_zone": None, "integrator_leak": None, "derivative_cutoff": None, "filters": [],
       "feedforward": {"velocity": 0, "acceleration": 0, "friction": 0}, "observer": {"bandwidth": 0, "inertia": 5.54e-4},
       "error_deadband": {"band": None, "form": "zero"}, "hold": {"enter": None, "leave": None, "dwell": 0},
       "standstill": {"band": None, "dwell": 0, "kp": 0, "ki": 0, "kd": 0}}
DEFAULTS = {
    "encoder": {"fine": 1620000, "coarse": 86400},
    "dac": {"bits": 12, "resolution": 2.4e-4},
    "controller": {"sample_rate": 2000, "kp": 0, "ki": 3.85e-5, "kd": 0, "anti_windup": "clamp", "encoder": "fine", **OFF,
                   "coarse": {"kp": 5.0e-4, "ki": 2.0e-6, "kd": 6.0e-3, "encoder": "fine", "fine_within": 100, "fine_rate": 1,
                              "fine_dwell": 0.01, "coarse_beyond": None, **OFF}},
    "command": {"profile": {"shape": "step", "velocity_limit": 2.0, "acceleration_limit": 100.0, "jerk_limit": 1e4}},
    "initial": {"integral": 0},
    "amplifier": {"limit": None},
}
draw = random.Random(15)
record_draw = random.Random(5)  # apart: other manifests stay as they are
start_draw = random.Random(8)  # likewise


def log_uniform(low, high):
    return low * (high / low)**draw.random()


def filter_of(kind):
    """With which the loop often stays within the converter's range."""
    frequency, damping = log_uniform(40, 900), log_uniform(0.3, 1.5)
    if kind == "biquad":
        a2 = draw.uniform(-0.5, 0.5)
        a1 = draw.uniform(-0.7, 0.7) * (1 + a2)
        b = [draw.uniform(0, most) * (1 + a1 + a2) for most in (0.5, 0.3, 0.3)]
        return {"biquad": {"b": b, "a": [a1, a2]}}
    return {kind: {"lowpass": {"frequency": frequency, "damping": damping},
                   "notch": {"frequency": frequency, "damping": damping, "depth": draw.uniform(0, 1)},
                   "lead": {"frequency": frequency, "ratio": log_uniform(0.5, 4)}}[kind]}


def block(kind):
    """The keys of one block."""
    return {
        "deadband": lambda: {"deadband": draw.choice([0, 1, 2.5, {"enter": 1, "leave": 2}, {"enter": 0.5}])},
        "zone": lambda: {"integrator_zone": draw.uniform(2, 30)},
        "leak": lambda: {"integrator_leak": log_uniform(0.01, 10)},
        "derivative": lambda: {"derivative_cutoff": log_uniform(10, 800), "kd": log_uniform(1e-4, 2e-3)},
        "filters": lambda: {"filters": [filter_of(draw.choice(FILTERS)) for _ in range(draw.randint(1, 3))]},
        "feedforward": lambda: {"feedforward": {"velocity": draw.uniform(0, 0.5), "acceleration": log_uniform(1e-4, 1e-2),
                                                "friction": draw.uniform(0, 0.1)}},
        "observer": lambda: {"observer": {"bandwidth": log_uniform(2, 40), "inertia": log_uniform(3e-4, 1e-3)}},
        "cascade": lambda: {"structure": "cascade", "cascade": {"kv": log_uniform(10, 200), "kp": log_uniform(0.02, 0.3),
                                                               "ki": log_uniform(0.5, 20)}},
    }[kind]()


def drive():
    """A host that commands a velocity over a bus."""
    return {"structure": "cascade", "derivative_window": draw.randint(1, 6),
            "cascade": {"kv": log_uniform(10, 200), "kp": log_uniform(0.02, 0.3), "ki": log_uniform(0.5, 20),
                        "feedforward": draw.uniform(0, 1.2), "divider": draw.randint(1, 5), "latency": draw.randint(0, 7),
                        "resolution": log_uniform(1e-5, 1e-2), "limit": log_uniform(1e-3, 1.0)}}


def second_encoder(manifest):
    """Puts a load with an encoder of its own behind the rotor, lets either close each loop, and returns what the judge has to know."""
    fine, load = draw.randint(200_000, 2_000_000), draw.randint(200_000, 2_000_000)
    position, velocity = draw.choice(["motor", "load"]), draw.choice(["motor", "load"])
    plant_load = {"inertia": log_uniform(1e-4, 1e-3), "stiffness": log_uniform(300, 3000), "damping": 0.05}
    manifest["plant"] = {"load": plant_load}
    manifest["encoder"] = {"fine": fine, "load": {"counts_per_revolution": load}}
    manifest["initial"] = {"encoder_phase": draw.random(), "load_encoder_phase": draw.random()}
    plant_load["encoder"] = draw.choice(["motor", "load"])
    if manifest["controller"].get("structure") == "cascade":
        choices = manifest["controller"]["cascade"]
        for loop, mass in (("position", position), ("velocity", velocity)):
            if mass != plant_load["encoder"] or draw.random() < 0.5:
                choices[loop] = mass
    else:
        position = velocity = plant_load["encoder"]
    counts = {"motor": fine, "load": load}
    other = "load" if position == "motor" else "motor"
    return {"fine": counts[position], "coarse": 86400, "other": counts[other],
            "velocity": "fine" if velocity == position else "other"}, position, other


def counts_are_right(row, manifest, position, other):
    """Whether each count is that of its mass."""
    encoder, start = manifest["encoder"], manifest["initial"]
    of = {"motor": (encoder["fine"], start["encoder_phase"], "theta"),
          "load": (encoder["load"]["counts_per_revolution"], start["load_encoder_phase"], "load_theta")}
    for mass, column in ((position, "count"), (other, f"{other}_count")):
        counts, phase, angle = of[mass]
        exact = float(row[angle]) / (2 * math.pi / counts) + phase
        if int(row[column]) != math.floor(exact) and abs(exact - round(exact)) > 1e-6:
            return False
    return True


FILTERS = ["lowpass", "notch", "lead", "biquad"]
KINDS = ["deadband", "zone", "leak", "derivative", "filters", "feedforward", "observer", "cascade"]


def phase(kinds):
    keys = {}
    for kind in kinds:
        keys.update(block(kind))
    if "cascade" in kinds:
        keys.pop("kd", None)
    return keys


def merged(base, keys):
    result = copy.deepcopy(base)
    for key, value in keys.items():
        if key == "deadband" and not isinstance(value, dict):
            value = {"enter": value}
        result[key] = merged(result.get(key, {}), value) if isinstance(value, dict) else value
    return result


def recorded_reference(hold):
    """A command that follows a path of some hundred counts, whose rows are no samples."""
    times = [0.0]
    while times[-1] < hold:
        times.append(times[-1] + record_draw.uniform(1e-3, 3e-2))
    rows = [[t, 4e-4 * math.sin(9.0 * t) + record_draw.gauss(0.0, 2e-5)] for t in times]
    return {"reference": {"file": rows}, "hold": hold}


def manifest_of(kinds, two_phases):
    controller = {**phase(kinds), **(drive() if "cascade" in kinds else {})}
    if "cascade" in kinds:
        controller.pop("kd", None)
    if "cascade" not in kinds:
        controller.setdefault("ki", log_uniform(1e-5, 1e-4))
    command = {"targets": [draw.randint(-60, 60) for _ in range(2)], "hold": 0.2}
    if two_phases:
        controller.pop("kd", None)
        if "cascade" not in kinds:
            controller.pop("derivative_cutoff", None)
        coarse = phase(kinds)
        controller["coarse"] = {**coarse, "coarse_beyond": 80, "fine_within": 40, "fine_rate": 5, "fine_dwell": 0.002}
        command["targets"] = [draw.randint(-400, 400) for _ in range(2)]
    if "feedforward" in kinds or "cascade" in kinds:
        command["hold"] = 0.6
        command["profile"] = {"shape": draw.choice(["trapezoidal", "s_curve"]), "velocity_limit": log_uniform(1e-2, 5e-2),
                              "acceleration_limit": log_uniform(0.5, 10.0)}
        if command["profile"]["shape"] == "s_curve":
            command["profile"]["jerk_limit"] = log_uniform(50, 1000)
        if not two_phases and record_draw.random() < 0.5:
            command = recorded_reference(command["hold"])
    return {"zerocount": 1, "name": "judged", "seed": draw.randrange(2**32), "trials": 1, "controller": controller,
            "amplifier": {"limit": log_uniform(1e-2, 1.0)}, "command": command, "verdict": {"dwell": 0.01, "window": 0.01}}


def judge(manifest, folder, two_encoders):
    encoder, position, other = second_encoder(manifest) if two_encoders else (DEFAULTS["encoder"], None, None)
    start = manifest.setdefault("initial", {})
    if start_draw.random() < 0.5:
        start["velocity"] = start_draw.uniform(-0.1, 0.1)
    phases = {mass: start.get(key, 0.5) for mass, key in (("motor", "encoder_phase"), ("load", "load_encoder_phase"))}
    path = Path(folder) / "judged.yaml"
    path.write_text(json.dumps(manifest), encoding="utf-8")
    ran = subprocess.run([PROGRAM, "trace", str(path), "--point", "0", "--trial", "0", "--format", "csv"],
                         capture_output=True, text=True, check=False)
    if ran.returncode != 0:
        sys.exit(f"{json.dumps(manifest)}\n{ran.stderr}")
    rows = list(csv.DictReader(ran.stdout.splitlines()))
    columns = ("target", "count", "coarse_count", f"{other}_count" if other else "coarse_count")
    samples = [tuple(int(row[key]) for key in columns) for row in rows]
    if two_encoders and not all(counts_are_right(row, manifest, position, other) for row in rows):
        sys.exit(f"a count is not that of its mass\n{json.dumps(manifest)}")
    given = {key: manifest[key] for key in ("controller", "command", "amplifier")}
    given["initial"] = {"velocity": start.get("velocity", 0.0), "phase": phases[position or "motor"],
                        "other_phase": phases[other or "load"]}
    judged = codes_of({**merged(DEFAULTS, given), "encoder": encoder}, samples)
    for row, (code, _, margin) in zip(rows, judged):
        if int(row["code"]) != code or float(row["torque"]) != code * DEFAULTS["dac"]["resolution"]:
            sys.exit(f"sample {row['k']}: code {row['code']}, torque {row['torque']}; judged {code}, {margin:.2g} of a code "
                     f"from the next\n{json.dumps(manifest)}")
    return len(rows), len(set(code for code, *_ in judged))


compared = codes = 0
with tempfile.TemporaryDirectory() as folder:
    for two_phases in (False, True):
        for kinds in [[kind] for kind in KINDS] + [KINDS, KINDS[:-1], *(draw.sample(KINDS, 3) for _ in range(6))]:
            for two_encoders in (False, True):
                rows, different = judge(manifest_of(kinds, two_phases), folder, two_encoders)
                compared, codes = compared + rows, codes + different
print(f"{compared} samples, {codes} different codes")
if codes < 1000:
    sys.exit("too few of the codes say something")
