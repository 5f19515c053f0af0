"""The source distribution has all that CMake needs to build it.

usage: source_distribution.py SOURCE
"""

import pathlib
import shutil
import sys
import tarfile
import tempfile

from installed_prefix import require, run


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="zerocount-source-") as temporary:
        folder = pathlib.Path(temporary)
        # setuptools leaves its notes beside the sources.
        ignored = shutil.ignore_patterns("build", "out", "node_modules", ".git", "tests", "docs")
        shutil.copytree(source, folder / "copy", ignore=ignored, symlinks=True)
        build = "import setuptools.build_meta as backend; print(backend.build_sdist('..'))"
        name = run(sys.executable, "-c", build, cwd=folder / "copy").splitlines()[-1]
        tarfile.open(folder / name).extractall(folder)
        unpacked = folder / name.removesuffix(".tar.gz")
        listed = run("git", "-C", source, "ls-files", "core", "experiments", "results", "analysis", "runners", "cmake").splitlines()
        missing = [path for path in listed if not (unpacked / path).exists()]
        require(not missing, f"it has all sources: {missing[:5]}")
        run("cmake", "-G", "Ninja", "-S", unpacked, "-B", folder / "build", "-DBUILD_TESTING=OFF")
    print(name)


if __name__ == "__main__":
    main()
