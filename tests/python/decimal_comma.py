"""Runs tests of the package in a process with a decimal comma: in German, as an application with Qt may be.

usage: decimal_comma.py FOLDER TESTS...

The locale is made in FOLDER from the sources of the C library (Debian: locales), so that none need be installed.
"""

import os
import pathlib
import subprocess
import sys

if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "de_DE.UTF-8").exists():
        subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", folder / "de_DE.UTF-8"], check=True)
    environment = {**os.environ, "LOCPATH": str(folder), "LC_ALL": "de_DE.UTF-8", "ZEROCOUNT_DECIMAL_POINT": ","}
    sys.exit(subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *sys.argv[2:]], env=environment).returncode)
