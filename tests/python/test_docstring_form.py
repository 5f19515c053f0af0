"""Every public function, class, method and property has a docstring in the form of numpydoc."""

import inspect

import pytest
import zerocount
from numpydoc.validate import validate

# There is one; with a summary; its parameters are those of the signature, in their order, with types and descriptions; it tells what it
# returns or yields.
CHECKED = {"GL08", "SS01", "PR01", "PR02", "PR03", "PR04", "PR06", "PR07", "PR08", "PR09", "RT01", "YD01"}
# Users get these from the package, and do not make them.
MADE_BY_THE_PACKAGE = {"Error", "ArgumentError", "ManifestError", "DataError", "MachineError", "TooLittleDataError", "UnknownNameError", "Comparison", "Identification",
                       "LawIdentification", "SlidingIdentification", "Tuning", "Results", "Study", "Figure", "Sample",
                       "Setup", "LoopSample"}  # fmt: skip


def public_names():
    for name in zerocount.__all__:
        item = getattr(zerocount, name)
        if inspect.isfunction(item) or inspect.isclass(item):
            yield name
        if inspect.isclass(item):
            yield from (f"{name}.{member}" for member in vars(item) if not member.startswith("_") and is_documented(item, member))


def is_documented(item, member):
    value = inspect.getattr_static(item, member)
    return inspect.isfunction(value) or isinstance(value, property) or type(value).__name__ == "cached_property"


@pytest.mark.parametrize("name", public_names())
def test_the_docstring_has_the_form_of_numpydoc(name):
    ignored = {"PR01"} if name in MADE_BY_THE_PACKAGE else set()
    found = [error for error in validate(f"zerocount.{name}")["errors"] if error[0] in CHECKED - ignored]
    assert found == []


def test_there_are_docstrings_to_check():
    assert len(list(public_names())) > 80
