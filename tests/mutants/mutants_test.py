#!/usr/bin/python3
"""The search for mutants on a small project: what tests see is noticed, what they do not see survives, and the checkout stays as it is."""

import pathlib
import random
import subprocess
import sys
import tempfile

import mutants

FILES = {
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.20)
project(sample LANGUAGES CXX)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests/core")
add_executable(sample_tests tests/core/sample_test.cpp core/part/sample.cpp)
target_include_directories(sample_tests PRIVATE "${CMAKE_SOURCE_DIR}")
""",
    "CMakePresets.json": """{"version": 3, "configurePresets": [
  {"name": "release", "generator": "Ninja", "binaryDir": "${sourceDir}/build/release"}]}
""",
    ".gitignore": "build/\n",
    "core/part/sample.cpp": """int sum(int a, int b) {
  return a + b;
}
bool never_called(int a) {
  return a == 1;
}
""",
    "tests/core/sample_test.cpp": """int sum(int a, int b);
int main() {
  return sum(1, 2) == 3 ? 0 : 1;
}
""",
}


def sample_project(root):
    for name, text in FILES.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    git = ["git", "-C", root, "-c", "user.name=A", "-c", "user.email=a@example.org"]
    subprocess.run([*git, "init", "--quiet"], check=True)
    subprocess.run([*git, "add", "."], check=True)
    subprocess.run([*git, "commit", "--quiet", "-m", "Begin"], check=True)


def test_mutants_of_a_line():
    made = set(mutants.mutations_of('  if (a < b && name == "x < y") return 0.5;  // a < b'))
    assert '  if (a <= b && name == "x < y") return 0.5;  // a < b' in made
    assert '  if (!(a < b && name == "x < y")) return 0.5;  // a < b' in made
    assert '  if (a < b && name == "x < y") return 0.6;  // a < b' in made
    assert len(made) == 5, made  # nothing inside the text or the comment


def test_each_layer_has_folders(project):
    for layer in mutants.LAYERS:
        assert len(mutants.folders_of(project, layer)) > 5, layer
    numbers = random.Random(1)
    drawn = {mutants.draw(project, mutants.LAYERS, numbers)[0].relative_to(project).parts[0] for _ in range(60)}
    assert drawn == set(mutants.LAYERS), drawn


def test_survivors_of_a_small_project():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        sample_project(root)
        command = [sys.executable, "-B", mutants.__file__, root, "--layer", "core", "--count", "2", "--seed", "3"]
        told = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        assert "core/part/sample.cpp:2: tests/core/sample_tests ends with 1" in told, told
        assert "core/part/sample.cpp:5: SURVIVES" in told, told
        listed = (root / "build/mutants/survivors.csv").read_text(encoding="utf-8").splitlines()
        assert listed[0] == ",".join(mutants.COLUMNS), listed
        assert all("core/part/sample.cpp:" in row for row in listed[1:]) and len(listed) == 1 + told.count("SURVIVES"), listed
        status = subprocess.run(["git", "-C", root, "status", "--porcelain"], capture_output=True, text=True, check=True).stdout
        assert status == "", status
        again = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        assert [line for line in again.splitlines() if "sample.cpp" in line and "SURVIVES" in line], again


if __name__ == "__main__":
    test_mutants_of_a_line()
    test_each_layer_has_folders(pathlib.Path(sys.argv[1]))
    test_survivors_of_a_small_project()
    print("mutants are noticed, or listed")
