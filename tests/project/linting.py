"""clang-tidy, with the checks of .clang-tidy, has nothing to say of the sources."""

import concurrent.futures
import os
import pathlib
import subprocess
import sys

FOLDERS = ["core", "experiments", "results", "analysis", "runners"]


def lint(root, build, path):
    command = ["clang-tidy", "--quiet", "-p", str(build), "--extra-arg=-Wno-unknown-warning-option", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=root, check=False)
    return done.returncode, done.stdout


if __name__ == "__main__":
    root, build = map(pathlib.Path, sys.argv[1:3])
    sources = [path for folder in FOLDERS for path in sorted((root / folder).rglob("*.cpp"))]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda path: lint(root, build, path), sources))
    for code, output in results:
        if code:
            print(output)
    sys.exit(any(code for code, _ in results))
