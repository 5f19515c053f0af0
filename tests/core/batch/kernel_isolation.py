"""Functions that the linker may share between units must not come from one compiled for another instruction set.

Usage: kernel_isolation.py LIBRARY. Of the inline functions in each unit of kernels, every one must belong to the batch
engine and stand in that unit alone: the linker keeps one copy, perhaps one that not every processor can run.
"""

import re
import subprocess
import sys
from collections import defaultdict


def weak_functions(library):
    """Object file -> names of its functions that other files may have too."""
    functions = defaultdict(set)
    unit = ""
    for line in subprocess.run(["nm", "-C", library], check=True, capture_output=True, text=True).stdout.splitlines():
        if line.endswith(":"):
            unit = line[:-1]
        elif found := re.match(r"[0-9a-f]+ [Wi] (.*)", line):
            functions[unit].add(found[1])
    return functions


def main():
    functions = weak_functions(sys.argv[1])
    kernels = [unit for unit in functions if unit.startswith("kernels_")]
    if not kernels:
        sys.exit("no kernels with inline functions: has the library changed?")
    faults = []
    for unit in kernels:
        others = set().union(*(names for other, names in functions.items() if other != unit))
        for name in sorted(functions[unit]):
            if "zerocount::batch::" not in name:
                faults.append(f"{unit}: {name} is not of the batch engine")
            elif name in others:
                faults.append(f"{unit}: {name} stands in another unit too")
    sys.exit("\n".join(faults) or 0)


main()
