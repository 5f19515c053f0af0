#!/usr/bin/python3
"""What `cmake --install` makes works from another place: the program, its manual and completions, and a program that uses the library.

usage: installed_prefix.py SOURCE BUILD
"""

import gzip
import pathlib
import shutil
import subprocess
import sys
import tempfile


def run(*words, **options):
    ended = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **options)
    if ended.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}: exit code {ended.returncode}\n{ended.stdout[-3000:]}{ended.stderr[-3000:]}")
    return ended.stdout


def require(holds, what):
    if not holds:
        raise SystemExit(f"not so: {what}")


def completions(script, line, cwd=None):
    """What bash offers for the last word of a command line."""
    lines = (f"PATH={script.parents[3]}/bin:$PATH; source {script}; COMP_LINE='{line}'; COMP_POINT=${{#COMP_LINE}}; _zerocount; "
             "printf '%s\\n' \"${COMPREPLY[@]}\"")
    return run("bash", "-c", lines, cwd=cwd).splitlines()


def check_program(prefix, folder):
    program = prefix / "bin/zerocount"
    run(program, "new", "paper-gains", "-o", "mine.yaml", cwd=folder)
    run(program, "run", "mine.yaml", "--set", "machines=2", "--set", "trials=4", "-q", "-o", "mine.h5", cwd=folder)
    run(program, "report", "mine.h5", "-o", "mine.html", cwd=folder)
    shipped = (prefix / "share/zerocount/manifests/paper-gains.yaml").read_text()
    require((folder / "mine.yaml").read_text() == shipped, "`new` copies the installed manifest")


def check_shell_files(prefix):
    manual = gzip.decompress((prefix / "share/man/man1/zerocount.1.gz").read_bytes()).decode()
    for command in ("run", "summary", "status"):
        require(f".SS {command}\n" in manual, f"the manual page has {command}")
    if shutil.which("groff"):
        checked = subprocess.run(["groff", "-k", "-man", "-Tutf8", "-ww", "-z"], input=manual,
                                 capture_output=True, text=True, check=True)
        require(not checked.stderr, f"groff warns of nothing: {checked.stderr}")
    script = prefix / "share/bash-completion/completions/zerocount"
    manifest = prefix / "share/zerocount/manifests/paper-gains.yaml"
    for line, offered, what in (
            ("zerocount summ", ["summary"], "a command"),
            ("zerocount run --th", ["--threads"], "an option"),
            ("zerocount help comp", ["compare", "completion"], "the operand of help"),
            ("zerocount completion z", ["zsh"], "an operand of a few words"),
            ("zerocount run --set plant.inert", ["plant.inertia="], "a key to set"),
            (f"{prefix}/bin/zerocount trace {manifest} --point b", ["b", "b-with-kp"], "the label of a design point"),
            ("zerocount new paper-g", ["paper-gains"], "a manifest that comes with it"),
            ("zerocount summary a.h5 --format js", ["json"], "a value"),
            ("zerocount summary a.h5 --format=js", ["json"], "a value after ="),
            ("zerocount summary --format=", ["text", "json", "markdown", "html", "csv"], "all formats")):
        require(completions(script, line) == offered, f"bash completes {what}")
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "my study.yaml").touch()
        for words in ("run", "history add", "history show --database", "new paper-gains -o"):
            require(completions(script, f"zerocount {words} my", cwd=folder) == ["my study.yaml"],
                    f"bash completes a name with a blank after {words}")
    if shutil.which("zsh"):
        run("zsh", "-n", prefix / "share/zsh/vendor-completions/_zerocount")
    if shutil.which("fish"):
        check_fish(prefix / "share/fish/vendor_completions.d/zerocount.fish", prefix / "bin", manifest)


def check_fish(script, folder, manifest):
    def completed(line):
        offered = run("fish", "--no-config", "-c", f"set -x PATH {folder} $PATH; source {script}; complete -C '{line}'")
        return [word.split("\t")[0] for word in offered.splitlines()]
    require(completed("zerocount summ") == ["summary"], "fish completes a command")
    require(completed("zerocount run --th") == ["--threads"], "fish completes an option")
    require(completed("zerocount summary a.h5 --format js") == ["json"], "fish completes a value")
    require(completed("zerocount run --set plant.inert") == ["plant.inertia="], "fish completes a key to set")
    require(completed(f"zerocount trace {manifest} --point b") == ["b", "b-with-kp"], "fish completes the label of a design point")


def check_consumer(source, prefix, folder):
    run("cmake", "-S", source / "examples/consumer", "-B", folder / "consumer", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", folder / "consumer")
    require("zero counts of error" in run(folder / "consumer/one_trial"), "one trial ends in zero counts")
    require(run(folder / "consumer/law_in_c") == "0 counts of error at the end\n", "so does one with a law in C")


def main():
    source, build = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    with tempfile.TemporaryDirectory(prefix="zerocount-prefix-") as temporary:
        folder = pathlib.Path(temporary)
        run("cmake", "--install", build, "--prefix", folder / "first")
        prefix = (folder / "first").rename(folder / "second")
        check_program(prefix, folder)
        check_shell_files(prefix)
        check_consumer(source, prefix, folder)


if __name__ == "__main__":
    main()
