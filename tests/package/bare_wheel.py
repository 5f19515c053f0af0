"""The wheel asks a system for no more than its name says, and its program runs from a bare environment.

usage: bare_wheel.py SOURCE BUILD
"""

import pathlib
import re
import sys
import tempfile
import venv
import zipfile

from installed_prefix import require, run

# What PEP 600 lets a wheel expect of a system, of what we use.
OF_SYSTEM = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1",
             "libstdc++.so.6", "libgcc_s.so.1"}
NEVER_CALLED = {"libssl", "libcrypto", "libcurl", "libcholmod", "libspqr", "liblapack", "libgfortran", "libgomp"}


def check_symbols(root, tag):
    programs = [path for path in root.rglob("*") if path.is_file() and path.read_bytes()[:4] == b"\x7fELF"]
    own = {path.name for path in programs}
    asked = "".join(run("readelf", "--version-info", "--wide", path) for path in programs)
    needs = asked.split("Version needs section")
    newest = max(int(minor) for minor in re.findall(r"Name: GLIBC_2\.(\d+)", "".join(needs[1:])))
    named = int(re.match(r"manylinux_2_(\d+)_", tag)[1])
    require(newest <= named <= newest + 1, f"the tag {tag} is that of the newest symbol, GLIBC_2.{newest}, or of its libstdc++")
    for path in programs:
        for name in re.findall(r"\(NEEDED\).*\[(.+)\]", run("readelf", "--dynamic", path)):
            require(name in own | OF_SYSTEM, f"{name}, which {path.name} needs, is in the wheel")
            require(re.split("[-.]", name)[0] not in NEVER_CALLED, f"{path.name} does without {name}")
            require(name in OF_SYSTEM or "-" in name, f"{name} has a name that no library of another package has")
    return own


def check_installed(wheel, folder, own):
    venv.create(folder / "bare", with_pip=True, system_site_packages=True)  # for numpy
    binaries = folder / "bare/bin"
    run(binaries / "python", "-m", "pip", "install", "--no-deps", "--no-index", wheel)
    other = folder / "other"
    other.mkdir()
    (other / "libhdf5_serial.so.103").write_text("not a library")
    environment = {"LD_LIBRARY_PATH": str(other)}
    run(binaries / "zerocount", "new", "paper-gains", "-o", "mine.yaml", cwd=folder, env=environment)
    run(binaries / "zerocount", "run", "mine.yaml", "--set", "machines=2", "--set", "trials=4", "-q", "-o", "mine.h5", cwd=folder, env=environment)
    require("ok" in run(binaries / "zerocount", "verify", "mine.h5", cwd=folder, env=environment), "the file is intact")
    in_process = ("from zerocount import checked, library; study = checked.recorded_study('mine.h5'); "
                  "assert study.trials == 4 and len(study.trace(0, 0)['samples']['t']) > 0; print(library.places()[0])")
    place = run(binaries / "python", "-c", in_process, cwd=folder, env=environment).strip()
    installed = pathlib.Path(place).parents[1] / "bin/zerocount"
    require("undefined symbol" not in run("ldd", "-r", installed), "every function that a library names is in the wheel")
    for program in (place, installed):
        for name, found in re.findall(r"^\s(\S+) => (\S+)", run("ldd", program), re.MULTILINE):
            require(name not in own or found.startswith(str(folder)), f"{name} is that of the wheel, not {found}")


def main():
    source, build = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    with tempfile.TemporaryDirectory(prefix="zerocount-wheel-") as temporary:
        folder = pathlib.Path(temporary).resolve()
        run(sys.executable, "-B", source / "cmake/bundle/make_wheel.py", build, folder)
        wheel = next(folder.glob("zerocount-*.whl"))
        zipfile.ZipFile(wheel).extractall(folder / "content")
        require("-py3-none-manylinux" in wheel.stem, "the wheel is for every Python 3")
        own = check_symbols(folder / "content", wheel.stem.split("-")[-1])
        check_installed(wheel, folder, own)
    print(wheel.name)


if __name__ == "__main__":
    main()
