"""The codes that trials with random controllers decide, against the controller written once more."""

import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from controller_judge import codes_of  # noqa: E402

answers = json.loads(subprocess.run(sys.argv[1], check=True, capture_output=True, text=True).stdout)
seen = Counter()
for number, trial in enumerate(answers):
    blocks = trial["blocks"]
    parameters = trial["parameters"]
    limits = [sign * 2**(parameters["dac"]["bits"] - 1) - (sign > 0) for sign in (-1, 1)]
    judged = codes_of(parameters, [(*row[:3], 0) for row in trial["samples"]])
    for k, ((code, coarse, margin), row) in enumerate(zip(judged, trial["samples"])):
        if code != row[3] or coarse != row[5]:
            sys.exit(f"trial {number} ({blocks}), sample {k}: code {row[3]}, phase {row[5]}; judged {code}, {coarse}, "
                     f"{margin:.2g} of a code from the next\n{json.dumps(parameters)}")
        if row[4] != code * parameters["dac"]["resolution"]:
            sys.exit(f"trial {number}, sample {k}: torque {row[4]} of code {code}")
        seen["samples"] += 1
        seen["clipped"] += code in limits
        seen["coarse"] += coarse
        seen["same code as before"] += k > 0 and judged[k - 1][0] == code
    seen["trials"] += 1
    seen["phase changes"] += sum(a[1] != b[1] for a, b in zip(judged, judged[1:]))
    seen[blocks] += 1
print(dict(seen))
if seen["clipped"] > 0.2 * seen["samples"] or seen["same code as before"] > 0.6 * seen["samples"]:
    sys.exit("too few of the codes say something")
if seen["coarse"] < 0.05 * seen["samples"] or seen["phase changes"] < 50:
    sys.exit("too little of the coarse phase")
