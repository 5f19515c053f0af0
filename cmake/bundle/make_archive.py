#!/usr/bin/python3
"""Makes the archive that runs on any Linux of this architecture: program, libraries, C library, manifests, manual, completions.

usage: make_archive.py BUILD

BUILD is a build for any machine of the architecture, such as build/portable. The archive is put there.
"""

import pathlib
import platform
import shutil
import subprocess
import sys

import bundle

C_LIBRARY = pathlib.Path(f"/lib/{platform.machine()}-linux-gnu")

def place_c_library(folder):
    """The C library, for systems with an older one; its loader finds it there."""
    folder.mkdir(parents=True)
    for name in sorted(bundle.OF_C_LIBRARY):
        if (C_LIBRARY / name).exists():
            shutil.copy2((C_LIBRARY / name).resolve(), folder / name)


def main(build):
    name = f"zerocount-{bundle.version()}-linux-{platform.machine()}"
    root = build / name
    shutil.rmtree(root, ignore_errors=True)
    subprocess.run(["cmake", "--install", build, "--prefix", root, "--component", "program"], check=True, stdout=subprocess.DEVNULL)
    program = root / "bin/zerocount"
    libraries, unused = bundle.libraries_of([program], bundle.OF_C_LIBRARY)
    bundle.place(program, root / "lib/zerocount", "$ORIGIN")
    bundle.place_libraries(libraries, unused, root / "lib")
    place_c_library(root / "lib/libc")
    shutil.copyfile(bundle.HERE / "launcher", program)
    c_library = {"libc.so.6": (C_LIBRARY / "libc.so.6").resolve()}
    bundle.place_licences(libraries | c_library, root / "share/doc/zerocount/licences")
    archive = build / f"{name}.tar.xz"
    subprocess.run(["tar", "--create", "--sort=name", "--owner=0", "--group=0", "--numeric-owner", "--mtime=@0", "-C", build,
                    "--use-compress-program=xz -T0 -9", "--file", archive, name], check=True)
    size = sum(file.stat().st_size for file in root.rglob("*") if file.is_file())
    print(f"{archive}: {archive.stat().st_size / 1e6:.1f} MB, unpacked {size / 1e6:.0f} MB, {len(libraries)} libraries")
    shutil.rmtree(root)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve())
