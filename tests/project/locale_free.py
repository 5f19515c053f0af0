"""No number is read or written by a function that takes the decimal separator of the process's locale.

usage: locale_free.py SOURCES BUILD

An application that loads the Python extension may have called setlocale, as Qt does. Numbers go through std::from_chars and
fmt (core/text/text.hpp). nlohmann::json asks the locale for its separator, so that it does not depend on it.
"""

import pathlib
import re
import subprocess
import sys

LAYERS = ["core", "experiments", "results", "analysis", "runners"]
# Comments, texts and characters, in which a name is no call.
NO_CODE = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|//[^\n]*|/\*.*?\*/', re.DOTALL)
CALL = re.compile(r"\b(sto(?:f|d|ld)|strto(?:f|d|ld)|ato[fl]|\w*scanf|v?s?n?printf|v?asprintf|lexical_cast|setprecision|setlocale|imbue"
                  r"|boost::format|(?:o|i)?stringstream\s*>>)\s*[(<]|\bas<\s*(?:double|float)\b|\bstd::(?:cin|cout|cerr|clog)\b")
# What the compiler makes of them where the text does not show it: a stream that reads a real number (YAML's as<double>, too),
# and std::to_string of one.
HIDDEN = {re.compile(r" U _ZNSi10_M_extractI[dfe]E"): "reads a real number from a stream",
          re.compile(r" [UWV] _ZN9__gnu_cxx12__to_xstring"): "calls std::to_string of a real number: call fmt::to_string"}


def of_sources(sources):
    for layer in LAYERS:
        for path in sorted((sources / layer).rglob("*.[ch]pp")):
            text = NO_CODE.sub(lambda left_out: re.sub(r"[^\n]", " ", left_out.group()), path.read_text(encoding="utf-8"))
            for call in CALL.finditer(text):
                yield f"{path.relative_to(sources)}:{text.count(chr(10), 0, call.start()) + 1}: {call.group().strip('( ')} depends on the locale"


def of_libraries(build):
    libraries = [path for path in sorted(build.rglob("libzerocount_*.a")) if not path.name.startswith("libzerocount_test")]
    if not libraries:
        yield f"{build} has no libraries"
    for library in libraries:
        listed = subprocess.run(["nm", library], check=True, capture_output=True, text=True).stdout
        yield from (f"{library.name} {what}" for symbol, what in HIDDEN.items() if symbol.search(listed))


if __name__ == "__main__":
    SOURCES, BUILD = map(pathlib.Path, sys.argv[1:])
    sys.exit("\n".join([*of_sources(SOURCES), *of_libraries(BUILD)]) or 0)
