"""docs/manifest/random_numbers.py reproduces the draws of studies, and prints one of the first manifest in that folder."""

import contextlib
import io
import json
import pathlib
import re
import subprocess
import sys


def main():
    answers, pages = sys.argv[1], pathlib.Path(sys.argv[2]).parents[1] / "docs" / "manifest"
    manifest = re.search(r"^```yaml\n(.*?)^```$", (pages / "README.md").read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)[1]
    code = (pages / "random_numbers.py").read_text(encoding="utf-8")

    printed = io.StringIO()
    shown = {}
    with contextlib.redirect_stdout(printed):
        exec(code, shown)
    assert shown["philox4x32_10"]([0, 0, 0, 0], [0, 0]) == [0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8]

    inputs = json.loads(subprocess.run([answers, "inputs"], input=manifest, stdout=subprocess.PIPE, text=True, check=True).stdout)
    if float(printed.getvalue()) != inputs["friction.k2"][17]:
        sys.exit(f"the code prints {printed.getvalue().strip()}, trial 17 has {inputs['friction.k2'][17]}")

    compared = 0
    for a in json.loads(subprocess.check_output([answers, "draws"])):
        stream = a["point"] + 1 if a["independent"] else 0
        for name in ("friction.k1", "initial.position"):
            if a["design"] == "monte_carlo":
                u = shown["monte_carlo"](a["seed"], name, a["trial"], stream)
            elif a["design"] == "latin_hypercube":
                u = shown["latin_hypercube"](a["seed"], name, a["trial"], a["trials"], stream)
            elif a["design"] == "saltelli":
                factor = ("friction.k1", "initial.position").index(name)
                u = shown["saltelli"](a["seed"], name, a["trial"], factor, 2, stream)
            else:
                continue
            # The study adds 1 to the uniform number and the answer takes it away again.
            if a[name] != (1.0 + u) - 1.0:
                sys.exit(f"{a}: {name} should be {u}")
            compared += 1
    if compared < 120:
        sys.exit(f"only {compared} draws were compared")
    print(f"{compared} draws agree")

    histories = json.loads(subprocess.check_output([answers, "histories"]))
    for a in histories:
        levels = shown["history"](a["seed"], a["trial"], a["reversals"], a["torque"], a["stream"])
        if levels != a["levels"] or len(levels) != a["reversals"]:
            sys.exit(f"{a}: the levels should be {levels}")
    if len(histories) < 8:
        sys.exit(f"only {len(histories)} histories were compared")
    print(f"{len(histories)} histories agree")


main()
