"""Copies programs with the libraries that they need, so that they run where no package of those is installed.

The C library is not among them: no process can have two, and Python brings its own.
"""

import pathlib
import re
import shutil
import subprocess

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parent.parent
OF_C_LIBRARY = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
OF_COMPILER = {"libstdc++.so.6", "libgcc_s.so.1"}
# What the libraries can call and zerocount never does: HDF5's driver for files on remote servers, Ceres Solver's sparse and LAPACK solvers.
UNUSED = ("libcurl.so.4", "libcrypto.so.3", "libcholmod.so.3", "libspqr.so.2", "libcxsparse.so.3", "liblapack.so.3", "libf77blas.so.3")
STAND_IN = "libzerocount-unused.so"  # has their functions, which end the program
# Packages whose code is compiled into the program.
COMPILED_IN = ("libboost1.74-dev", "libeigen3-dev", "libsqlitecpp-dev", "nlohmann-json3-dev", "librandom123-dev")


def output_of(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=True).stdout


def needed_by(file):
    return re.findall(r"\(NEEDED\).*\[(.+)\]", output_of("readelf", "--dynamic", file))


def libraries_of(files, without):
    """The paths of all libraries that files load, by their names, except some with all that only those load; then those of UNUSED."""
    places = {}
    for file in files:
        places.update(re.findall(r"^\s(\S+) => (/\S+)", output_of("ldd", file), re.MULTILINE))
    found, waiting = {}, [name for file in files for name in needed_by(file)]
    if used := set(waiting).intersection(UNUSED):
        raise SystemExit(f"zerocount itself uses {', '.join(sorted(used))}, of which a bundle has no more than a stand-in")
    while waiting:
        name = waiting.pop()
        if name not in found and name not in without and name not in UNUSED:
            found[name] = pathlib.Path(places[name]).resolve()
            waiting.extend(needed_by(found[name]))
    return found, [places[name] for name in UNUSED if name in places]


def place(file, target, libraries, names=()):
    """Copies a program or library, which then loads what it needs from the folder of libraries (as seen from itself).

    names: of libraries that have another name there.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy2(file, target)
    target.chmod(0o755)
    subprocess.run(["strip", "--strip-unneeded", target], check=True)
    others = dict(names) | dict.fromkeys(UNUSED, STAND_IN)
    for name in needed_by(target):
        if name in others:
            subprocess.run(["patchelf", "--replace-needed", name, others[name], target], check=True)
    # Not the newer RUNPATH: LD_LIBRARY_PATH, which modules of clusters set, comes before that.
    subprocess.run(["patchelf", "--force-rpath", "--set-rpath", libraries, target], check=True)


def functions(file, which):
    """The functions that a library defines or leaves undefined, as name@version or name."""
    lines = output_of("nm", "--dynamic", f"--{which}-only", "--with-symbol-versions", file)
    return set(re.findall(r"^[0-9a-f]* +[UTWi] (\S+)$", lines.replace("@@", "@"), re.MULTILINE))


def place_stand_in(libraries, unused, folder):
    """The library of those functions of the unused libraries that the others name."""
    named = set().union(*(functions(path, "undefined") for path in libraries))
    offered = set().union(*(functions(path, "defined") for path in unused))
    words = [name.partition("@") for name in sorted(named & offered)]
    versions = {version: [name for name, _, its in words if its == version] for _, _, version in words if version}
    source, script = folder / "unused.c", folder / "unused.map"
    source.write_text("#include <stdio.h>\n#include <stdlib.h>\n"
                      "static void fail(const char* name) { fprintf(stderr, \"zerocount: no %s here\\n\", name); abort(); }\n"
                      + "".join(f'void {name}(void) {{ fail("{name}"); }}\n' for name, _, _ in words))
    script.write_text("".join(f"{version} {{ {'; '.join(names)}; }};\n" for version, names in versions.items()))
    subprocess.run(["cc", "-O2", "-s", "-shared", "-fPIC", f"-Wl,-soname,{STAND_IN}", f"-Wl,--version-script={script}", source,
                    "-o", folder / STAND_IN], check=True)
    source.unlink()
    script.unlink()


def place_libraries(libraries, unused, folder, names=()):
    folder.mkdir(parents=True, exist_ok=True)
    for name, path in libraries.items():
        target = folder / dict(names).get(name, name)
        place(path, target, "$ORIGIN", names)
        subprocess.run(["patchelf", "--set-soname", target.name, target], check=True)
    place_stand_in(libraries.values(), unused, folder)


def package_of(path):
    """The package of Debian that a file is of; files of /usr/lib may be known by their older place, /lib."""
    for known in (path, pathlib.Path("/", *path.parts[2:])):
        found = subprocess.run(["dpkg", "-S", known], capture_output=True, text=True, check=False)
        if found.returncode == 0:
            return found.stdout.partition(":")[0]
    raise SystemExit(f"{path} is of no package")


def place_licences(libraries, folder):
    """The licence of each library, of code that is compiled in, and of what draws the reports."""
    folder.mkdir(parents=True, exist_ok=True)
    packages = {package_of(path) for path in libraries.values()}
    for package in sorted(packages.union(COMPILED_IN)):
        shutil.copyfile(f"/usr/share/doc/{package}/copyright", folder / package)
    shutil.copytree("/usr/share/common-licenses", folder / "common-licenses", dirs_exist_ok=True)  # which those name
    for licence in sorted((ROOT / "analysis/report/node_modules").glob("*/LICENSE*")):
        shutil.copyfile(licence, folder / f"npm-{licence.parent.name}")


def version():
    return re.search(r"^project\(zerocount VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)[1]


def symbol_versions(files, family):
    """The newest version of a family such as GLIBC that files ask the system for."""
    words = set(re.findall(rf"\({family}_(\d[\d.]*)\)|\b{family}_(\d[\d.]*)\b", "".join(output_of("objdump", "-T", file) for file in files)))
    return max((tuple(map(int, (one or other).split("."))) for one, other in words), default=())
