"""How often will a positioning axis with friction hold exactly zero encoder counts of error?

The package calls the program zerocount and reads its files. Single trials run in this process.

>>> r = zc.study("my-axis.yaml").run("my-axis.h5")
>>> r.judge().status
'met'
"""

import inspect as _inspect

from . import arguments as _arguments
from .answers import Answer
from .asking import ask
from .comparison import Comparison, compare
from .errors import (
    ArgumentError,
    DataError,
    Error,
    MachineError,
    ManifestError,
    Problem,
    TooLittleDataError,
    UnknownNameError,
)
from .figures import Figure
from .identification import Identification, LawIdentification, SlidingIdentification, identify
from .laws import trial
from .loop import ControlLaw, Setup
from .loop import Sample as LoopSample
from .monitoring import Monitor, monitor
from .planning import plan
from .results import Results, open_results
from .sampling import Sample, sample
from .studies import Study, shipped, study
from .traces import Trace
from .tuning import Tuning, tune
from .version import VERSION as __version__

__all__ = [
    "Answer",
    "ArgumentError",
    "Comparison",
    "ControlLaw",
    "DataError",
    "Error",
    "Figure",
    "Identification",
    "LawIdentification",
    "LoopSample",
    "MachineError",
    "ManifestError",
    "Monitor",
    "Problem",
    "Results",
    "Sample",
    "Setup",
    "SlidingIdentification",
    "Study",
    "TooLittleDataError",
    "Trace",
    "Tuning",
    "UnknownNameError",
    "__version__",
    "ask",
    "compare",
    "identify",
    "monitor",
    "open_results",
    "plan",
    "sample",
    "shipped",
    "study",
    "trial",
    "tune",
]

open = open_results  # as zc.open; `from zerocount import *` leaves that of Python

for _name in (*__all__, "open"):
    _item = globals()[_name]
    if isinstance(_item, type):
        _arguments.check_class(_item)
    elif _inspect.isfunction(_item):
        globals()[_name] = _arguments.checked(_item)
