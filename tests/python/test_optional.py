"""The package without the packages that only some of its functions need."""

from __future__ import annotations

import json
import pathlib
import subprocess
import sys

import numpy as np
import pytest
import zerocount as zc

BLOCKED = ["pandas", "xarray", "matplotlib", "openturns", "IPython", "distributed"]

WITHOUT = """
import json, sys

class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {blocked!r}:
            raise ImportError(f"{{name}} is not here")

sys.meta_path.insert(0, Blocked())
import numpy as np
import zerocount as zc

s = zc.study("my-axis.yaml").set(machines=20, trials=40).sweep("controller.ki", [5e3, 1.2e4])
r = s.run("without.h5")
f = zc.sample(r, 1, outcome="arrival_time")
answers = {{
    "judge": r.judge().status,
    "trace": r.trace(1, 3).error[-1].item(),
    "trial": zc.trial(s, 1, 3, lambda setup: lambda sample: 0.0).torque.tolist()[:2],
    "sample": f(f.draw(5)).tolist(),
    "compare": zc.compare(r, points=(0, 1)).verdict,
    "plan": zc.plan(success=0.99)["plans"][0],
    "figures": r.figures,
    "figure": len(r.plot("success").svg) > 0,
    "summary": len(r.summary["points"]),
    "report": r.report("without.html").name,
    "shown": [repr(r), repr(s), repr(f.names)],
}}
refused = {{}}
for name, ask in {{
    "table": lambda: r.table,
    "statistics": lambda: r.statistics,
    "trials": r.trials,
    "moves": r.moves,
    "jerks": r.jerks,
    "machines": r.machines,
    "levels": r.levels,
    "dataset": lambda: r.dataset,
    "matplotlib": lambda: r.plot("success").matplotlib(),
    "plot": lambda: r.trace(1, 3).plot(),
    "frame": lambda: r.trace(1, 3).frame,
    "of a comparison": lambda: zc.compare(r, points=(0, 1)).table,
    "of a plan": lambda: zc.plan(success=0.99).plans,
    "distribution": lambda: f.distribution,
    "function": lambda: f.function,
    "html": r._repr_html_,
    "workers": lambda: s.run("workers.h5", client=object()),
}}.items():
    try:
        refused[name] = f"no error: {{ask()!r}}"
    except Exception as error:
        refused[name] = f"{{type(error).__name__}}: {{error}}"
print(json.dumps({{"answers": answers, "refused": refused, "loaded": sorted(set(sys.modules) & set({blocked!r}))}}))
"""

NEEDED = {"dataset": "xarray", "matplotlib": "matplotlib", "plot": "matplotlib", "distribution": "openturns", "function": "openturns",
          "workers": "distributed"}  # fmt: skip


@pytest.fixture(scope="module")
def without(axis: zc.Study, folder: pathlib.Path) -> dict[str, dict[str, object]]:
    """What calls give where the packages cannot be imported."""
    script = WITHOUT.format(blocked=BLOCKED)
    done = subprocess.run([sys.executable, "-c", script], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    result: dict[str, dict[str, object]] = json.loads(done.stdout)
    return result


def test_without_h5py_trials_still_run(axis: zc.Study, folder: pathlib.Path) -> None:
    """Where h5py cannot be imported, trials and samples run, and opening results says what to install."""
    script = """
import sys
sys.modules["h5py"] = None
import zerocount as zc
s = zc.study("my-axis.yaml")
f = zc.sample(s, 2)
print(len(zc.trial(s).t), f(f.draw(3)).shape, zc.plan(success=0.9)["plans"][0]["trials"])
zc.open("my-axis.h5")
"""
    done = subprocess.run([sys.executable, "-c", script], cwd=folder, capture_output=True, text=True, check=False)
    assert done.stdout == "4000 (3,) 29\n"
    assert "ImportError: a results file needs h5py" in done.stderr and "python3-h5py" in done.stderr


def test_everything_else_works_without_optional_packages(axis: zc.Study, folder: pathlib.Path, without: dict[str, dict[str, object]]) -> None:
    """Runs, judgements, traces, samples and answers are as with the packages, and none of these is imported."""
    answers = without["answers"]
    r = zc.open(folder / "without.h5")
    f = zc.sample(r, 1, outcome="arrival_time")
    assert without["loaded"] == []
    assert answers["judge"] == r.judge().status and answers["trace"] == r.trace(1, 3).error[-1]
    assert answers["trial"] == [0.0, 0.0]
    np.testing.assert_array_equal(answers["sample"], f(f.draw(5)))  # of moves that do not settle the time is NaN
    assert answers["compare"] == zc.compare(r, points=(0, 1)).verdict and answers["plan"]["trials"] == 299
    assert answers["figures"] == r.figures and answers["figure"] and answers["summary"] == 2
    assert answers["report"] == "without.html" and answers["shown"][0] == repr(r)


def test_an_error_says_what_to_install(without: dict[str, dict[str, object]]) -> None:
    """What needs a package raises ImportError with its name and how to install it."""
    assert len(without["refused"]) == 17
    for name, message in without["refused"].items():
        package = NEEDED.get(name, "pandas")
        assert str(message).startswith("ImportError: "), (name, message)
        assert f"needs {package}, which is not installed" in str(message), (name, message)
        assert f"apt-get install python3-{package}" in str(message) and f"pip install {package}" in str(message)
