#!/usr/bin/env python3
"""One table of what a trial-sample costs, in ns per core, by each engine on each workload.

Runs the executable `benchmarks`. Every figure is the median of the repetitions,
which are interleaved: an engine is compared with others that were timed in the same minutes. With --scaling the cost of
runs follows, by threads and by the length of trials. With --program a whole run of a
million trials (experiments/bench-million.yaml), from the manifest to the finished file, is a fourth row of the table.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BENCHMARKS = ROOT / "build/release/tests/benchmarks/benchmarks"
MILLION = ROOT / "experiments/bench-million.yaml"
MILLION_SAMPLES = 1_000_000 * 300

WORKLOADS = {"W1": "W1 transient", "W2": "W2 creep", "W3": "W3 marginal"}
PEERS = {"odeint": "Boost.odeint", "cvode": "SUNDIALS CVODE"}  # of the rest of the engines, each is ours
REFERENCE = "reference"
SCALING = {
    "threads": "threads (W1), wall time",
    "length": "samples of a trial (W1)",
}


def run_benchmarks(program, repetitions, scaling):
    """What the benchmarks say, as their JSON."""
    if not program.exists():
        sys.exit(f"{program} is not there: build the target `benchmarks`, or say where it is with --benchmarks")
    groups = ["engine", *(SCALING if scaling else [])]
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "benchmarks.json"
        command = [
            str(program),
            f"--benchmark_filter=^({'|'.join(groups)})/",
            f"--benchmark_repetitions={repetitions}",
            "--benchmark_enable_random_interleaving=true",
            f"--benchmark_out={out}",
            "--benchmark_out_format=json",
        ]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
        if done.returncode != 0:
            sys.exit(f"the benchmarks failed with exit code {done.returncode}")
        return json.loads(out.read_text(encoding="utf-8"))


def medians(report):
    """Name of a benchmark → ns per trial-sample, the median of its repetitions."""
    values = {}
    for entry in report["benchmarks"]:
        if entry.get("error_occurred"):
            sys.exit(f"{entry['name']}: {entry.get('error_message')}")
        if entry.get("run_type") == "iteration" and "per_sample" in entry:
            name = entry["run_name"].removesuffix("/real_time")
            values.setdefault(name, []).append(1e9 * entry["per_sample"])
    if not values:
        sys.exit("nothing was measured")
    return {name: statistics.median(figures) for name, figures in values.items()}, max(map(len, values.values()))


def time_million(program):
    """ns of one core per trial-sample of a whole run on all cores, and its wall time in s."""
    with tempfile.TemporaryDirectory(dir=pathlib.Path.cwd()) as folder:
        command = [str(program), "run", str(MILLION), "-o", str(pathlib.Path(folder) / "million.h5")]
        start = time.monotonic()
        done = subprocess.run(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL, check=False)
        wall = time.monotonic() - start
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed with exit code {done.returncode}")
    return 1e9 * wall * os.cpu_count() / MILLION_SAMPLES, wall


def figure(value):
    if value is None:
        return "–"
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def print_rows(rows):
    """A Markdown table, its columns aligned: the first row is the heading."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for number, row in enumerate(rows):
        cells = [row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:]))]
        print(f"| {' | '.join(cells)} |")
        if number == 0:
            print("| " + " | ".join(["-" * widths[0], *("-" * (width - 1) + ":" for width in widths[1:])]) + " |")


def engines_of(figures):
    """All engines measured: ours, the reference last of them, and then the peers."""
    found = {name.split("/")[2] for name in figures if name.startswith("engine/")}
    ours = sorted(found - set(PEERS) - {REFERENCE})
    return ours + [name for name in (REFERENCE, *PEERS) if name in found]


def print_engines(figures, million):
    engines = engines_of(figures)
    ours = [name for name in engines if name not in PEERS]
    pairs = [(other, own) for i, own in enumerate(ours) for other in engines[i + 1 :]]
    rows = [["ns per trial-sample", *(PEERS.get(e, e) for e in engines), *(f"{a}/{b}" for a, b in pairs)]]
    for key, label in WORKLOADS.items():
        cost = {e: figures.get(f"engine/{key}/{e}") for e in engines}
        ratios = [figure(cost[a] / cost[b]) if cost[a] and cost[b] else "–" for a, b in pairs]
        rows.append([label, *(figure(cost[e]) for e in engines), *ratios])
    if million:
        empty = [""] * (len(engines) + len(pairs) - 1)
        rows.append(["W4 a whole run of a million", figure(million[0]), *empty])
    print_rows(rows)
    notes = []
    missing = [PEERS.get(name, name) for name in (REFERENCE, *PEERS) if name not in engines]
    if missing:
        notes.append(f"Not in this build, or not measured: {', '.join(missing)}.")
    absent = [label for key, label in WORKLOADS.items() if not any(n.startswith(f"engine/{key}/") for n in figures)]
    if absent:
        notes.append(f"Not measured: {', '.join(absent)}.")
    if million:
        kernel = figures.get(f"engine/W1/{ours[0]}") if ours else None
        ratio = f", {million[0] / kernel:.2f} × W1 by the engine {ours[0]} alone" if kernel else ""
        notes.append(f"W4: {million[1]:.1f} s on {os.cpu_count()} threads{ratio}.")
    if notes:
        print("\n" + "\n".join(notes))


def print_scaling(figures):
    rows = [["ns per trial-sample of a run", "at", "ns", "to the first"]]
    for key, label in SCALING.items():
        names = sorted((name for name in figures if name.startswith(key + "/")), key=lambda name: int(name.split("/")[1]))
        for name in names:
            rows.append([label, name.split("/")[1], figure(figures[name]), figure(figures[name] / figures[names[0]])])
    print()
    print_rows(rows)


def print_machine(report, repetitions):
    context = report["context"]
    load = context.get("load_avg") or ["?"]
    print()
    print(
        f"{context.get('cpu', '?')}, {context['num_cpus']} cores; {context.get('compiler', '?')}, "
        f"{context.get('instruction_set', '?')}; medians of {repetitions}; {context['date'][:10]}, load {load[0]} at the start."
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--benchmarks", type=pathlib.Path, default=BENCHMARKS, help="the executable (default: %(default)s)")
    parser.add_argument("--repetitions", type=int, default=5, help="of every benchmark (default: %(default)s)")
    parser.add_argument("--scaling", action="store_true", help="time runs too")
    parser.add_argument("--program", type=pathlib.Path, help="zerocount: time a whole run of a million trials with it")
    arguments = parser.parse_args()
    report = run_benchmarks(arguments.benchmarks, arguments.repetitions, arguments.scaling)
    figures, repetitions = medians(report)
    print_engines(figures, time_million(arguments.program) if arguments.program else None)
    if arguments.scaling:
        print_scaling(figures)
    print_machine(report, repetitions)


if __name__ == "__main__":
    main()
