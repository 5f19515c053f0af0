"""Heavy headers of libraries are included only where they are reserved; prints what the heavy headers cost the build.

usage: build_weight.py ROOT BUILD

Weights are seconds that g++ 12 takes for a source with nothing but that header, beyond what precompiled.hpp has anyway. Where the sum
grows, first look whether the library can stay behind a plain function or a forward declaration (core/numerics/dense.hpp;
nlohmann/json_fwd.hpp).
"""

import json
import pathlib
import re
import sys

LAYERS = ("core", "experiments", "results", "analysis", "runners")
INCLUDE = re.compile(r'^\s*#\s*include\s+["<]([^">]+)[">]', re.MULTILINE)

WEIGHTS = {  # by the start of the header's name
    "Eigen/Core": 0.9,
    "boost/math/": 0.9,
    "boost/program_options": 0.7,
    "ceres/": 1.4,
    "nlohmann/json.hpp": 1.0,
    "oneapi/tbb/": 0.6,
    "yaml-cpp/": 0.5,
}
PARTS = ("product", "tests")  # of the tree

# Headers that only these files may include.
RESERVED = {
    r"Eigen/(?!Core$)|unsupported/Eigen/(?!FFT$)": {"core/numerics/dense.cpp"},
    r"unsupported/Eigen/FFT$": {"analysis/record/fit/residuals.cpp"},
    r"boost/math/distributions/": r"^(core|experiments)/.*\.cpp$|^analysis/basis/statistics/distributions\.cpp$",
    r"(ceres|boost/math|boost/program_options|yaml-cpp)/": r"\.cpp$",
    r"nlohmann/json\.hpp": r"\.cpp$|^analysis/basis/(text/report_json|document/figure)\.hpp$",
}


def includes_of(path, known):
    if path not in known:
        known[path] = INCLUDE.findall(path.read_text(encoding="utf-8")) if path.exists() else []
    return known[path]


def heavy_headers_of(root, unit, known):
    """The heavy headers that a unit includes, directly or not."""
    seen, todo, heavy = set(), [unit], set()
    while todo:
        for name in includes_of(todo.pop(), known):
            heavy.update(start for start in WEIGHTS if name.startswith(start))
            path = root / name
            if path not in seen:
                seen.add(path)
                todo.append(path)
    return heavy


def reserved_headers(root, known):
    for path in sorted(path for layer in LAYERS for path in (root / layer).rglob("*.[ch]pp")):
        name = str(path.relative_to(root))
        for header in includes_of(path, known):
            for pattern, allowed in RESERVED.items():
                where = name in allowed if isinstance(allowed, set) else re.search(allowed, name)
                if re.match(pattern, header) and not where:
                    yield f"{name} includes <{header}>, which costs all that include it seconds"


def main(root, build):
    known, sums, heaviest = {}, dict.fromkeys(PARTS, 0.0), []
    for command in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        unit = pathlib.Path(command["file"])
        home = build if unit.is_relative_to(build) else root
        layer = unit.relative_to(home).parts[0]
        part = "product" if layer in LAYERS else layer
        if part not in sums:
            continue
        weight = sum(WEIGHTS[start] for start in heavy_headers_of(root, unit, known))
        sums[part] += weight
        heaviest.append((weight, unit.stem))
    problems = list(reserved_headers(root, known))
    for part, weight in sums.items():
        print(f"{part}: {weight:.1f} s")
    print("the heaviest units:")
    for weight, unit in sorted(heaviest, reverse=True)[:10]:
        print(f"  {unit}: {weight:.1f} s")
    print("\n".join(problems))
    return 1 if problems or not heaviest else 0


if __name__ == "__main__":
    sys.exit(main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:3])))
