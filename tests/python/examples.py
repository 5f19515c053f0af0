"""The examples of examples/python run, and find what they should.

usage: examples.py ROOT
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

import zerocount as zc
from support import first_study


def printed(script: pathlib.Path, argument: str) -> str:
    ended = subprocess.run([sys.executable, script, argument], capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        raise SystemExit(f"{script.name}: exit code {ended.returncode}\n{ended.stderr}")
    return ended.stdout


def numbers(pattern: str, text: str) -> list[float]:
    found = re.search(pattern, text)
    if found is None:
        raise SystemExit(f"{pattern!r} is not in\n{text}")
    return [float(number) for number in found.groups()]


def require(holds: bool, what: str) -> None:
    if not holds:
        raise SystemExit(f"not so: {what}")


def main(root: pathlib.Path) -> None:
    examples = root / "examples" / "python"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        first_study(root, pathlib.Path("my-axis.yaml"))
        results = zc.study("my-axis.yaml").run("my-axis.h5")
        trials = results.trials(2)
        late = (~(trials["band_settling_time[1]"] <= 0.05)).mean()

        text = printed(examples / "openturns_uncertainty.py", "my-axis.yaml")
        estimate, half = numbers(r"late in ([\d.]+)% ± ([\d.]+)%", text)
        # Three standard deviations of both: the study's 2000 trials are on 1000 machines, and count as 1000.
        spread = 3 * ((half / 196) ** 2 + late * (1 - late) / 1000) ** 0.5
        require(abs(estimate / 100 - late) < spread, f"OpenTURNS finds {estimate} %, the study {late:.2%}")

        text = printed(examples / "scipy_gains.py", "my-axis.yaml")
        tuned, others = numbers(r"within ([\d.]+) ms[^$]*within ([\d.]+) ms", text)
        untuned = 1e3 * results.statistics.loc[2, "band_settling_time_p95[1]"]
        require(tuned <= others < untuned / 2, f"the gains of SciPy are fast on other machines: {others} ms, untuned {untuned} ms")

        text = printed(examples / "sklearn_failures.py", "my-axis.h5")
        (accuracy,) = numbers(r"other machines: ([\d.]+)", text)
        require(accuracy > 0.65, f"the tree foresees failures: {accuracy}")
        os.chdir("/")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
