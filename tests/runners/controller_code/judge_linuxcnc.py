"""The controller written as a component of LinuxCNC: compiled by halcompile, its function decides on the recorded inputs of a
trial what the trial decided. Skipped (77) where halcompile is not installed."""

import csv
import io
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM, HARNESS = sys.argv[1], Path(sys.argv[2])
RESOLUTION = 2.4e-4
CONTROLLERS = [
    "{ki: 3.85e-5}",
    "{ki: 3.0e-5, kp: 4.0e-4, kd: 2.0e-4, derivative_cutoff: 300, hold: {enter: 0, leave: 1, dwell: 0.01}}",
    "{ki: 5.0e-5, error_deadband: {band: 1, form: subtract}, integrator_zone: 15, filters: [{lowpass: {frequency: 400, damping: 1}}]}",
    "{ki: 5.0e-5, standstill: {band: 1, dwell: 0.02, ki: 1.0e-6}, dither: {amplitude: 1.0e-4, frequency: 300}}",
    "{structure: cascade, cascade: {kv: 100, kp: 0.1, ki: 10}, observer: {bandwidth: 20}}",
]

if shutil.which("halcompile") is None:
    print("halcompile is not installed")
    sys.exit(77)

for number, controller in enumerate(CONTROLLERS):
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        (here / "axis.yaml").write_text(
            f"zerocount: 1\nname: axis\nseed: {number}\ntrials: 2\ncontroller: {controller}\n"
            "command: {targets: [25, 10, -30], hold: 0.3}\ninitial: {encoder_phase: 0.3}\n")

        def run(*words, **options):
            return subprocess.run(words, check=True, capture_output=True, text=True, cwd=here, **options).stdout

        run(PROGRAM, "controller", "axis.yaml", "--language", "linuxcnc", "-o", "axis_x.comp")
        run("halcompile", "--preprocess", "axis_x.comp")
        run("cc", "-DRTAPI", "-I/usr/include/linuxcnc", "-O2", "-ffp-contract=off", "axis_x.c", str(HARNESS), "-o", "harness")
        samples = list(csv.DictReader(io.StringIO(run(PROGRAM, "trace", "axis.yaml"))))
        inputs = "".join(f"{s['target']} {s['target']} {s['count']}\n" for s in samples)
        torques = [float(line) for line in run("./harness", input=inputs).split()]
        assert len(torques) == len(samples)
        for sample, torque in zip(samples, torques):
            code = min(max(round(torque / RESOLUTION), -2048), 2047)
            if code != int(sample["code"]):
                sys.exit(f"{controller}, sample {sample['k']}: {code} of the component, {sample['code']} of the trial")
        print(f"{controller}: {len(samples)} samples, codes {min(int(s['code']) for s in samples)} to "
              f"{max(int(s['code']) for s in samples)}")
