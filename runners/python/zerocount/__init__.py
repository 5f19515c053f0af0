"""How often will a positioning axis with friction hold exactly zero encoder counts of error?

The package calls the program zerocount and reads its files. Single trials run in this process.

>>> r = zc.study("my-axis.yaml").run("my-axis.h5")
>>> r.judge().status
'met'
"""

import inspect as _inspect

from _zerocount import __version__

from . import arguments as _arguments
from .answers import Answer
from .asking import ask
from .comparison import Comparison, compare
from .errors import ArgumentError, DataError, Error, MachineError, ManifestError, Problem, TooLittleDataError
from .figures import Figure
from .identification import Identification, LawIdentification, SlidingIdentification, identify
from .laws import ControlLaw, Setup, trial
from .laws import Sample as LoopSample
from .monitoring import Monitor, monitor
from .planning import plan
from .results import Results
from .results import open_results as open
from .sampling import Sample, sample
from .studies import Study, shipped, study
from .traces import Trace
from .tuning import Tuning, tune

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
    "__version__",
    "ask",
    "compare",
    "identify",
    "monitor",
    "open",
    "plan",
    "sample",
    "shipped",
    "study",
    "trial",
    "tune",
]

for _name in __all__:
    _item = globals()[_name]
    if isinstance(_item, type):
        _arguments.check_class(_item)
    elif _inspect.isfunction(_item):
        globals()[_name] = _arguments.checked(_item)
