"""The controller written as a component of LinuxCNC: compiled by halcompile, its function decides on the recorded inputs of a
trial what the trial decided, and in single precision what the C code decides. Skipped (77) where halcompile is not installed."""

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

C_CODE_AT_THE_CONVERTER = f"""
#include "controller.c"
#include <math.h>
#include <stdio.h>
int main(void) {{
  controller_state state;
  double target, reference, count, last = NAN, given = 0.0;
  controller_start(&state);
  while (scanf("%lf %lf %lf", &target, &reference, &count) == 3) {{
    const controller_input in = {{.error = reference - count, .count = count, .torque = given, .new_target = !isnan(last) && target != last}};
    const double wanted = controller_step(&state, &in);
    given = fmin(fmax(rint(wanted / {RESOLUTION}), -2048), 2047) * {RESOLUTION};
    last = target;
    printf("%.17g\\n", wanted);
  }}
}}
"""

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

        def torques_of_component(precision):
            run(PROGRAM, "controller", "axis.yaml", "--language", "linuxcnc", "--precision", precision, "--force", "-o", "axis_x.comp")
            run("halcompile", "--preprocess", "axis_x.comp")
            run("cc", "-DRTAPI", "-I/usr/include/linuxcnc", "-O2", "-ffp-contract=off", "axis_x.c", str(HARNESS), "-o", "harness")
            return [float(line) for line in run("./harness", input=inputs).split()]

        def torques_of_c_code(precision):
            run(PROGRAM, "controller", "axis.yaml", "--precision", precision, "-o", "controller.c")
            (here / "main.c").write_text(C_CODE_AT_THE_CONVERTER)
            run("cc", "-O2", "-ffp-contract=off", "main.c", "-lm", "-o", "main")
            return [float(line) for line in run("./main", input=inputs).split()]

        samples = list(csv.DictReader(io.StringIO(run(PROGRAM, "trace", "axis.yaml"))))
        inputs = "".join(f"{s['target']} {s['target']} {s['count']}\n" for s in samples)
        torques = torques_of_component("double")
        assert len(torques) == len(samples)
        for sample, torque in zip(samples, torques):
            code = min(max(round(torque / RESOLUTION), -2048), 2047)
            if code != int(sample["code"]):
                sys.exit(f"{controller}, sample {sample['k']}: {code} of the component, {sample['code']} of the trial")
        if (component := torques_of_component("single")) != torques_of_c_code("single"):
            sys.exit(f"{controller}: in single precision the component decides otherwise than the C code")
        if "ki" in controller and component == torques:
            sys.exit(f"{controller}: nothing is in single precision")
        print(f"{controller}: {len(samples)} samples, codes {min(int(s['code']) for s in samples)} to "
              f"{max(int(s['code']) for s in samples)}")
