"""What decides trials calls no elementary function of the C library, and no installed library defines one for its users.

usage: c_functions.py BUILD

glibc chooses exp, log … by the processor. What draws parameters or computes trials calls those of
core/numerics/elementary_functions.hpp, in Boost.Math too (core/numerics/real.hpp).
"""

import pathlib
import re
import subprocess
import sys

FUNCTIONS = ("exp exp2 exp10 expm1 log log2 log10 log1p pow cbrt hypot sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh "
             "erf erfc tgamma lgamma sincos").split()
SYMBOL = re.compile(r" ([A-Za-z]) (" + "|".join(FUNCTIONS) + ")[fl]?$", re.MULTILINE)
# Except the theory: it predicts, and no value of a dataset comes from it.
REPRODUCIBLE = re.compile(r"libzerocount_(core_(?!theory)|experiments_|results_)")
# Linked to the program alone, and not installed: its statistics have the same bits on every processor too.
PROGRAM = "libzerocount_analysis_basis_statistics.a"


def problems(build):
    libraries = sorted(path for path in build.rglob("libzerocount_*.a"))
    if not any(REPRODUCIBLE.match(library.name) for library in libraries):
        yield f"{build} has no libraries of core"
    for library in libraries:
        listed = subprocess.run(["nm", library], check=True, capture_output=True, text=True).stdout
        for kind, name in sorted(set(SYMBOL.findall(listed))):
            if kind != "U" and library.name != PROGRAM:
                yield f"{library.name} defines {name} with C linkage: all code linked with it would call that"
            elif kind == "U" and REPRODUCIBLE.match(library.name):
                yield f"{library.name} calls {name} of the C library: call zerocount::numerics::{name}"


if __name__ == "__main__":
    sys.exit("\n".join(problems(pathlib.Path(sys.argv[1]))) or 0)
