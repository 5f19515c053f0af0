#!/usr/bin/env python3
"""The page of the stage with two requirements: each of its commands, and what the verdict rests on, on fewer machines.

    two_step_stage.py PROGRAM MANIFEST
"""
import json
import pathlib
import subprocess
import sys
import tempfile

SMALLER = ["--set", "machines=100", "--set", "trials=800"]


def ask(program, *arguments):
    """The exit code and the answer of a command."""
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def expect(found, expected, what):
    if found != expected:
        sys.exit(f"{what}: {found}; expected {expected}")


def run(program, manifest, file, *settings):
    code, text = ask(program, "run", manifest, "-o", file, "--quiet", *SMALLER, *settings)
    expect(code, 0, f"run {' '.join(settings)}: {text}")


def claims_of(program, file):
    """(goal, condition) → proportion of moves, by judge."""
    judged = subprocess.run([program, "judge", file, "--format", "json"], capture_output=True, text=True, check=False)
    answer = json.loads(judged.stdout)  # a slow machine may have messages beside it
    return {(claim["goal"], claim["condition"]): claim["rate"] for claim in answer["claims"]}


def main():
    program, manifest = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        stage, tonight = pathlib.Path(folder) / "stage.h5", pathlib.Path(folder) / "tonight.h5"
        run(program, manifest, stage)
        claims = claims_of(program, stage)
        expect(sorted(claims), [(g, c) for g in ("large", "small") for c in ("empty", "loaded")], "claims")
        expect(set(claims.values()), {1.0}, "moves in the goals")
        for delay in ("0.5", "2", "3"):
            run(program, manifest, tonight, "--force", "--set", f"controller.delay={delay}", "--set", "seed=2")
            expect(set(claims_of(program, tonight).values()), {1.0}, f"moves in the goals with a delay of {delay}")
        expect(ask(program, "compare", stage, tonight)[0] in (0, 3), True, "compare with more delay does not fail")
        for command in (("sensitivity", stage), ("report", stage, "-o", pathlib.Path(folder) / "stage.html"), ("plan", manifest),
                        ("limits", manifest, "--set", "machines=20", "--set", "trials=40")):
            code, text = ask(program, *command)
            expect(code, 0, f"{command[0]}: {text}")
        run(program, manifest, tonight, "--force", "--set", "controller.feedforward.friction=0")
        expect(claims_of(program, tonight)["large", "empty"], 0.0, "20 um steps without friction feed-forward")
        expect(ask(program, "compare", stage, tonight)[0], 1, "compare without friction feed-forward")


if __name__ == "__main__":
    main()
