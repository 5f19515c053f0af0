"""What the documentation of the Python package promises, where only the packages are installed.

usage: first_use.py FOLDER
FOLDER has my-axis.yaml, the study of the README.
"""

import os
import sys

import numpy as np
import zerocount as zc

os.chdir(sys.argv[1])
s = zc.study("my-axis.yaml").sweep("controller.ki", np.geomspace(5e3, 1e5, 8))
r = s.run("first-use.h5", force=True)
r = zc.open("first-use.h5")
print(r.table)
print(r.trials(point=3).shape, r.moves().shape, r.machines().shape, r.jerks().shape, r.dataset.sizes)
trace = r.trace(point=3, trial=17)
trace.plot().savefig("trace.png")
r.plot("settled").matplotlib().savefig("settled.png")
r.plot("settled").save("settled.html")


def law(setup):
    gain = r.table.loc[3, "ki"] * setup.resolution * setup.sample_time / 2
    integral = before = 0.0

    def torque(sample):
        nonlocal integral, before
        integral += gain * (sample.error + before)
        before = sample.error
        return integral

    return torque


assert all(np.array_equal(zc.trial(s, 3, 17, law).samples[name], trace.samples[name]) for name in trace.samples)
tuned = zc.tune("my-axis.yaml", "tuned.h5", free={"controller.ki": {"log": [5e3, 5e4]}}, margins={"gain": 1, "phase": 10},
                budget=2000, force=True)
print(tuned, tuned.room)
print(zc.compare("first-use.h5", points=(2, 3)).verdict, zc.plan(success=0.99)["plans"][0])
print(zc.sample(s, 2, outcome="arrival_time")([90, 600, 1e5, 0.5, 20, 0.5]))
try:
    zc.study("my-axis.yaml").set({"dac.bits": 99}).labels
except zc.ManifestError as error:
    print(error.key)
