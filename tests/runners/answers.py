"""Every command that answers gives the same answer in every format: JSON as the schema says, CSV and Markdown tables with equal
rows, HTML that is closed, one exit code.

usage: answers.py ZEROCOUNT
"""

import csv
import html.parser
import io
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from jsonschema import Draft202012Validator

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()

AXIS = """
zerocount: 1
name: axis <b>|x|</b>
seed: 7
trials: 240
machines: 24
goal: {band: 2, within: 0.3, moves: 0.9, machines: 0.7}
controller: {ki: 4.0e-5, sample_rate: 2000}
friction: {k1: {uniform: [70, 150]}, alpha: {log_uniform: [0.1, 4]}}
command: {targets: [{integers: [3, 9]}], hold: 0.5}
"""
SWEEP = "sweep: {grid: {controller.ki: [2.0e-5, 6.0e-5], controller.kp: [0, 2.0e-4]}}\n"
TUNE = "tune: {free: {controller.ki: {log: [1.0e-5, 1.0e-4]}}, margins: {gain: 2, phase: 15}}\n"
WORLDS = """
zerocount: 1
name: worlds
seed: 8
trials: 400
worlds: 20
goal: {band: 0, within: 0.2, moves: 0.8}
friction: {alpha: {interval: [0.1, 8]}, k1: {interval: [40, 200]}}
command: {targets: [5, 12], hold: 0.4}
"""
CLAIMS = """
zerocount: 1
name: claims
seed: 9
trials: 240
machines: 20
worlds: 4
goals:
  large: {"on": [0], band: 1, within: 0.05, moves: 0.9}
  small: {"on": [1], band: 1, within: 0.02, moves: 0.6, machines: 0.5, limits: {overshoot: 30}}
friction: {alpha: {interval: [0.1, 2]}, k1: {uniform: [70, 150]}}
command: {targets: [20, 25], hold: 0.1}
conditions: {empty: {}, loaded: {plant.inertia: 8.0e-4}}
"""
SLIDE = """
zerocount: 1
name: slide
trials: 1
seed: 3
friction: {model: coulomb, breakaway: 0.2, coulomb_ratio: 0.8}
command: {torque: {levels: [0, 0.5, -0.5, 0.5, -0.5], rate: 10}, hold: 0.3}
"""
FILES = {
    "slide.yaml": SLIDE,
    "axis.yaml": AXIS,
    "sweep.yaml": AXIS + SWEEP,
    "tune.yaml": AXIS + TUNE,
    "worlds.yaml": WORLDS,
    "claims.yaml": CLAIMS,
    "no-goal.yaml": re.sub("goal:.*\n", "", AXIS),
}
PREPARATIONS = [
    "run axis.yaml -o axis.h5",
    "run axis.yaml -o again.h5 --set seed=9",
    "run sweep.yaml -o sweep.h5",
    "run worlds.yaml -o worlds.h5",
    "run no-goal.yaml -o no-goal.h5",
    "run claims.yaml -o claims.h5",
    "run claims.yaml -o claims-again.h5 --set seed=10",
    "history add claims.h5 --database claims.sqlite",
    "new material-test -o material.yaml",
    "run material.yaml -o material.h5 --set trials=1",
    "new identification -o identification.yaml",
    "run identification.yaml -o identification.h5",
    "trace slide.yaml --format csv -o slide.csv",
    "history add axis.h5 --database history.sqlite",
    "history add again.h5 --database history.sqlite",
    "export axis.h5 -o tables",
]
QUESTIONS = [
    "check sweep.yaml",
    "check no-goal.yaml",
    "judge sweep.h5",
    "judge worlds.h5",
    "summary sweep.h5",
    "summary sweep.h5 --point 1 --confirm 50 --legend",
    "summary worlds.h5",
    "summary no-goal.h5 --confidence 0.9",
    "summary material.h5",
    "status sweep.h5",
    "verify axis.h5 --trials 20",
    "parameters",
    "parameters --guides",
    "parameters --manifest axis.yaml",
    "experiment axis.yaml --duration 1.2 --budget 1 --machines 1",
    "identify identification.h5 --point steps --fix friction.n=2",
    "identify identification.h5 --point steps --model spring",
    "identify slide.csv --sliding",
    "learn worlds.h5",
    "tune tune.yaml -o tuned.h5 --budget 4700 --force",
    "tune tuned.h5 --extras margins,limits --budget 3000",
    "limits axis.yaml",
    "worst axis.yaml",
    "worst claims.yaml",
    "rare axis.yaml -o rare.h5 --force --budget 20000",
    "jerks no-goal.h5",
    "compare axis.h5 again.h5",
    "compare sweep.h5 sweep.h5",
    "history show --database history.sqlite",
    "monitor axis.h5 tables/outcomes.csv --measure arrival_time --measure outcome",
    "monitor axis.h5 tables/outcomes.csv --machine 3",
    "accept axis.h5 tables/outcomes.csv",
    "plan axis.yaml",
    "plan axis.h5",
    "plan --success 0.999",
    "plan --halfwidth 0.005",
    "plan --halfwidth 0.02 --machine-sd 0.1 --true-success 0.9",
    "plan --success 0.97 --machines-share 0.9",
    "plan --margin success_rate=0.1 axis.yaml",
    "sensitivity axis.h5",
    "judge claims.h5",
    "summary claims.h5",
    "summary claims.h5 --confirm 48",
    "check claims.yaml",
    "plan claims.yaml",
    "limits claims.yaml",
    "sensitivity claims.h5",
    "jerks claims.h5",
    "learn claims.h5",
    "compare claims.h5 claims-again.h5",
    "history show --database claims.sqlite",
    "experiment claims.yaml --condition loaded --duration 1.6 --budget 1 --machines 1",
]
SLOW = {"tune", "limits", "worst", "rare", "experiment", "identify"}
"""Their answers are made as all others are: from one run each, as a notebook gets them."""
EMPTY_ELEMENTS = {"meta", "link", "br", "img", "hr", "input"}


class Elements(html.parser.HTMLParser):
    """Finds elements of HTML that are not closed in their order."""

    def __init__(self):
        super().__init__()
        self.open = []
        self.faults = []

    def handle_starttag(self, tag, attributes):
        if tag not in EMPTY_ELEMENTS:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(tag)


def without_times(answer):
    """The answer without what two runs may differ in: seconds, and names of files that are written."""
    if isinstance(answer, dict):
        return {key: without_times(value) for key, value in answer.items() if "second" not in key}
    return [without_times(value) for value in answer] if isinstance(answer, list) else answer


class Answers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        for name, text in FILES.items():
            pathlib.Path(cls.temporary.name, name).write_text(text, encoding="utf-8")
        for words in PREPARATIONS:
            done = cls.ask(words)
            assert done.returncode == 0, (words, done.stderr)
        cls.schema = json.loads(cls.ask("schema --answers").stdout)
        Draft202012Validator.check_schema(cls.schema)

    @classmethod
    def ask(cls, words):
        return subprocess.run([PROGRAM, *words.split()], cwd=cls.temporary.name, capture_output=True, text=True, timeout=300)

    @classmethod
    def formats(cls, command):
        """The formats that the help of the command names."""
        found = re.search(r"--format FORMAT +([\w, ()]+)", cls.ask(f"{command} --help").stdout)
        return re.findall(r"\w+", found[1].replace("(default)", "").replace(" or ", ", ")) if found else []

    def check_json(self, text):
        answer = json.loads(text)
        name = answer["answer"]
        schema = {"$ref": f"#/$defs/{name}", "$defs": self.schema["$defs"]}
        for error in Draft202012Validator(schema).iter_errors(answer):
            self.fail(f"{name}: {error.json_path}: {error.message[:300]}")
        self.assertTrue(answer["headline"], name)
        return answer

    def check_csv(self, text):
        rows = list(csv.reader(io.StringIO(text)))
        self.assertEqual({len(row) for row in rows}, {len(rows[0])})
        self.assertEqual(len(set(rows[0])), len(rows[0]), rows[0])

    def check_markdown(self, text):
        for table in re.findall(r"(?:^\|.*\|\n)+", text, re.MULTILINE):
            cells = {len(re.findall(r"(?<!\\)\|", line)) for line in table.splitlines()}
            self.assertEqual(len(cells), 1, table)
        self.assertNotIn("<b>", text.replace("\\<b>", ""))

    def check_html(self, text):
        elements = Elements()
        elements.feed(text)
        self.assertEqual((elements.faults, elements.open), ([], []))
        self.assertNotIn("<b>", text)

    def test_every_answer_is_the_same_in_every_format(self):
        """JSON and text as a notebook gets them, from one run."""
        answered = set()
        for question in QUESTIONS:
            with self.subTest(question=question):
                formats = set(self.formats(question.split()[0]))
                self.assertLessEqual({"text", "json", "markdown", "html"}, formats)
                if "--confirm" in question:
                    formats.discard("csv")  # new trials have no row of the table
                codes = {}
                # The HTML is in the notebook's.
                others = set() if question.split()[0] in SLOW else formats - {"text", "json", "html"}
                for form in [*sorted(others), "notebook"]:
                    done = self.ask(f"{question} --format {form}")
                    self.assertIn(done.returncode, (0, 1, 3), done.stderr)
                    self.assertTrue(done.stdout, form)
                    codes[form] = done.returncode
                    if form != "notebook":
                        check = getattr(self, f"check_{form}", None)
                        if check:
                            check(done.stdout)
                        continue
                    given = json.loads(done.stdout)
                    self.assertTrue(given["text"])
                    self.check_html(given["html"])
                    name = self.check_json(json.dumps(given["answer"]))["answer"]
                    self.assertEqual(name.partition("-")[0], question.split()[0])
                    answered.add(name)
                self.assertEqual(len(set(codes.values())), 1, codes)
        self.assertEqual(set(self.schema["$defs"]) - answered, set(), "answers that no question asks for")

    def test_a_notebook_gets_the_json_with_schema_text_and_html(self):
        for question in ("judge sweep.h5", "summary sweep.h5", "plan axis.h5", "jerks no-goal.h5"):
            with self.subTest(question=question):
                given = json.loads(self.ask(f"{question} --format notebook").stdout)
                self.assertEqual(given.pop("text"), self.ask(question).stdout)
                self.check_html(given.pop("html"))
                plain = json.loads(self.ask(f"{question} --format json").stdout)
                answer = given.pop("answer")
                Draft202012Validator(given.pop("schema")).validate(answer)
                self.assertEqual(without_times(answer), without_times(plain))
                self.assertEqual(given, {})

    def test_table_is_an_alias_of_text(self):
        self.assertEqual(self.ask("judge sweep.h5 --format table").stdout, self.ask("judge sweep.h5").stdout)


if __name__ == "__main__":
    unittest.main()
