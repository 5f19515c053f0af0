"""Tests of the marks: words around a marked number do not matter, another number and a lost mark are found."""
import re
import unittest

import claims
from marks import Numbers, marks_in, misspelled_marks, problems

TEXT = """# A page

With half a sample the moves end in zero counts in **97.8
[97.6, 98.1]**<!-- claim: half --> %, in 33 to 39<!-- claim: range --> % of the trials.

Write `<!-- claim: example -->` behind a number:

```
12<!-- claim: block --> %
```

| gains | 0 | 1 |
| --- | --: | --: |
| with kp 160 | 99.1 [98.7, 99.4] | 72.4 [71.0, 73.6]<!-- claim: row --> |
| alone | 12 | 0.51<!-- claim: cell --> ± 0.01 |

The second is 72.4<!-- claim: row.2 --> %.

<!-- claim: table -->
| moves | alarms |
| --- | --- |
| 100 | 7 |
"""
CLAIMS = {
    "half": Numbers([["97.8 [97.6, 98.1]", "97.8"]]),
    "range": Numbers([["33 to 39"]]),
    "row": Numbers([["99.1 [98.7, 99.4]", "99.1"], ["72.4 [71.0, 73.6]", "72.4"]], is_row=True),
    "cell": Numbers([["0.51"]]),
    "table": Numbers([]),
}


def found(text):
    """The names of the marks with a problem."""
    messages = problems(marks_in(text, "page.md"), CLAIMS)
    return [re.match(r"(?:page\.md:\d+: )?([\w.]+): ", message)[1] for message in messages]


class Marks(unittest.TestCase):
    def changed(self, old, new):
        self.assertIn(old, TEXT)
        return found(TEXT.replace(old, new))

    def test_page_that_agrees_has_no_problem(self):
        self.assertEqual(found(TEXT), [])

    def test_reworded_sentences_and_cells_pass(self):
        self.assertEqual(self.changed("With half a sample the moves end in zero counts in", "Zero counts, half a sample of delay:"), [])
        self.assertEqual(self.changed("% of the trials", "percent of all axes"), [])
        self.assertEqual(self.changed("with kp 160", "a stiffer loop, 170 N m/rad"), [])
        self.assertEqual(self.changed("The second is", "With one sample it is"), [])

    def test_other_line_breaks_and_emphasis_pass(self):
        self.assertEqual(self.changed("97.8\n[97.6, 98.1]**", "97.8 [97.6,\n98.1]**"), [])
        self.assertEqual(self.changed("in **97.8\n[97.6, 98.1]**", "in 97.8 [97.6, 98.1]"), [])

    def test_changed_numbers_are_found(self):
        self.assertEqual(self.changed("97.8\n", "97.9\n"), ["half"])
        self.assertEqual(self.changed("97.6,", "97.5,"), ["half"])
        self.assertEqual(self.changed("33 to 39", "33 to 38"), ["range"])
        self.assertEqual(self.changed("33 to 39", "3 to 39"), ["range"])
        self.assertEqual(self.changed("0.51", "0.52"), ["cell"])
        self.assertEqual(self.changed("| 99.1 [", "| 99.2 ["), ["row"])
        self.assertEqual(self.changed("72.4 [71.0", "72.5 [71.0"), ["row"])
        self.assertEqual(self.changed("is 72.4", "is 99.1"), ["row.2"])

    def test_longer_number_with_the_same_end_is_found(self):
        for longer in ("133 to 39", "0.33 to 39", "1 33 to 39", "-33 to 39", "−33 to 39", "1,33 to 39", "12 to 33 to 39", "12–33 to 39", "±33 to 39"):
            self.assertEqual(self.changed("33 to 39", longer), ["range"], longer)

    def test_number_that_goes_on_behind_its_mark_is_found(self):
        for rest in (".9", "0", " [30, 40]", "–50", " to 50"):
            self.assertEqual(self.changed("39<!-- claim: range -->", f"39<!-- claim: range -->{rest}"), ["range"], rest)

    def test_page_of_a_claim_must_state_its_bounds(self):
        claimed = {"half": Numbers([["97.8 [97.6, 98.1]", "97.8"]], pages=["page.md"])}
        text = "97.8<!-- claim: half --> %"
        self.assertEqual(len(list(problems(marks_in(text, "page.md"), claimed))), 1)
        with_bounds = "97.8 [97.6, 98.1]<!-- claim: half --> %"
        both = [*marks_in(with_bounds, "page.md"), *marks_in(text, "other.md")]
        self.assertEqual(list(problems(both, claimed)), [])

    def test_misspelled_marks_are_found(self):
        for comment in ("<!-- claim:half -->", "<!--claim: half-->", "<!-- Claim: half -->"):
            self.assertEqual(misspelled_marks(f"1{comment} %"), [comment])
        self.assertEqual(misspelled_marks(TEXT), [])

    def test_mark_of_a_row_stands_behind_its_last_number(self):
        moved = TEXT.replace("<!-- claim: row -->", "").replace("99.1 [98.7, 99.4]", "99.1 [98.7, 99.4]<!-- claim: row -->")
        self.assertEqual(found(moved), ["row"])

    def test_mark_apart_from_its_number_is_found(self):
        self.assertEqual(self.changed("33 to 39<!-- claim: range --> %", "33 to 39 % of them<!-- claim: range -->"), ["range"])

    def test_mark_that_begins_a_line_is_found(self):
        self.assertEqual(self.changed("39<!-- claim: range -->", "39\n<!-- claim: range -->"), ["range"])

    def test_mark_without_a_claim_is_found(self):
        self.assertEqual(self.changed("claim: cell", "claim: other")[0], "other")
        self.assertEqual(self.changed("claim: row.2", "claim: row.3"), ["row.3"])

    def test_claim_without_a_mark_is_found(self):
        for mark in ("half", "range", "row", "cell", "table"):
            self.assertEqual(self.changed(f"<!-- claim: {mark} -->", ""), [mark])

    def test_marks_in_code_are_examples(self):
        self.assertNotIn("example", [mark.name for mark in marks_in(TEXT)])
        self.assertNotIn("block", [mark.name for mark in marks_in(TEXT)])

    def test_page_that_must_have_a_mark_is_named(self):
        expected = CLAIMS | {"range": Numbers([["33 to 39"]], pages=["page.md", "README.md"])}
        self.assertEqual(list(problems(marks_in(TEXT, "page.md"), expected)), ["range: README.md lacks this mark"])

    def test_mark_of_a_table_has_its_rows(self):
        rows = [mark.rows for mark in marks_in(TEXT) if mark.name == "table"]
        self.assertEqual(rows, [[["moves", "alarms"], ["---", "---"], ["100", "7"]]])


class Values(unittest.TestCase):
    def agrees(self, value, *found_values):
        return claims.judged_range([(number, 100) for number in found_values], {"of": "x"} | value)[0]

    def test_value_is_rounded_to_the_digits_of_the_page(self):
        percent = {"unit": "%", "is": "96.5 to 97.7"}
        self.assertTrue(self.agrees(percent, 0.9646, 0.9774))
        self.assertFalse(self.agrees(percent, 0.97, 0.9644))
        self.assertFalse(self.agrees(percent, 0.9776))
        self.assertTrue(self.agrees({"is": 0.9}, 0.86, 0.94))
        self.assertFalse(self.agrees({"is": 0.9}, 0.96))

    def test_limits_of_their_own_replace_the_rounding(self):
        value = {"unit": "ms", "is": 23, "within": [21, 24]}
        self.assertTrue(self.agrees(value, 0.0211, 0.0239))
        self.assertFalse(self.agrees(value, 0.0241))
        self.assertFalse(self.agrees(value, None), "never is later than any time")

    def test_number_outside_its_limits_is_found(self):
        claim = {"checks": [{"values": [{"of": "x", "mark": "x", "is": 25, "within": [21, 24]}]}]}
        self.assertEqual(list(claims.unclear_values("late", claim)), ["late: 25 is not within 21 to 24"])

    def test_number_without_a_mark_needs_words(self):
        def messages(**more):
            return list(claims.unclear_values("x", {"checks": [{"values": [{"of": "x", "is": 1} | more]}]}))
        self.assertEqual(len(messages()), 1)
        self.assertEqual(messages(in_words="all succeed"), [])
        self.assertEqual(messages(**{"is": "met"}), [])

    def test_unclear_values_are_found(self):
        def messages(**value):
            return list(claims.unclear_values("x", {"checks": [{"values": [{"mark": "x"} | value]}]}))
        self.assertEqual(messages(of="goal.rate", unit="%", **{"is": 98}), [])
        self.assertEqual(messages(of="goal.rate", **{"is": 1}), ['x: goal.rate is a proportion; state it with unit: "%"'])
        self.assertEqual(messages(of="y", withn=[1, 2], **{"is": 1}), ["x: y has unknown keys: withn"])
        self.assertEqual(messages(of="y"), ["x: y needs either `is` or `counts`"])

    def test_words_must_be_equal(self):
        self.assertTrue(self.agrees({"is": "met"}, "met"))
        self.assertFalse(self.agrees({"is": "met"}, "met", "missed"))

    def test_counts_are_stated_as_a_rate_with_bounds_or_without(self):
        self.assertEqual(claims.notations({"of": "x", "counts": [2785, 3000]}), ["92.8 [91.8, 93.8]", "92.8"])

    def test_counts_may_differ_by_chance(self):
        value = {"of": "success_rate", "counts": [2785, 3000]}
        self.assertTrue(claims.judged_counts([(0.93, 1000)], value)[0])
        self.assertFalse(claims.judged_counts([(0.88, 1000)], value)[0])


if __name__ == "__main__":
    unittest.main()
