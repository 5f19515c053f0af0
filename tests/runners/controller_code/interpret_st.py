"""An interpreter of the part of Structured Text (IEC 61131-3) that `controller --language st` writes: the outside judge of that text.

interpret_st.py FILE.st...: runs the function block of each file, one call for each line of FILE.st.samples, which has the inputs in the
order of VAR_INPUT after `restart`, and then the expected output, in hexadecimal. Every output must equal it to the bit. Types are not
converted but by the functions of the standard that say so; REAL is rounded to single precision after each operation."""

import re
import struct
import sys
from pathlib import Path

TOKEN = re.compile(r"\s+|\(\*.*?\*\)|(?P<number>\d[\d_]*(?:\.\d+(?:[eE][+-]?\d+)?)?)|(?P<word>[A-Za-z_]\w*)"
                   r"|(?P<sign>:=|<=|>=|<>|[-+*/=<>():;,])", re.S)
RESERVED = set("""abs add and array at by case constant div do else elsif end_case end_for end_function_block end_if end_var end_while eq exit
exp false for from function function_block ge gt if initial_step int integral interval le limit lint ln log lreal lt max min mod mul mux ne
not of on or priority program read_only read_write real repeat retain return sel single sqrt step string sub task then time to transition
true trunc type until var var_input var_output var_temp while with xor ct d l n p pid r s""".split())
LITERAL = "literal"  # a real number, of the type of what it is combined with


def single(value):
    return struct.unpack("f", struct.pack("f", value))[0]


class Block:
    """A function block, as a Python function that is called at each sample with its variables."""

    def __init__(self, text):
        self.tokens = [(m.lastgroup, m.group(m.lastgroup)) for m in self._scan(text) if m.lastgroup]
        self.at = 0
        self.types, self.start, self.inputs, self.outputs, self.constants = {}, {}, [], [], set()
        self.expect("FUNCTION_BLOCK")
        self.name()
        while self.peek().startswith("VAR"):
            self.section()
        self.lines = []
        self.statements(1, {"END_FUNCTION_BLOCK"})
        assert self.at == len(self.tokens), f"'{self.peek()}' after the end"
        space = {"single": single, "trunc": int}
        exec("def call(v):\n" + "\n".join(self.lines), space)
        self.call = space["call"]

    @staticmethod
    def _scan(text):
        at = 0
        while at < len(text):
            match = TOKEN.match(text, at)
            assert match and match.end() > at, f"no Structured Text: {text[at:at + 40]!r}"
            at = match.end()
            yield match

    def peek(self):
        return self.tokens[self.at][1] if self.at < len(self.tokens) else ""

    def next(self):
        self.at += 1
        return self.tokens[self.at - 1][1]

    def expect(self, text):
        found = self.next()
        assert found == text, f"'{found}' in place of '{text}'"

    def name(self):
        kind, text = self.tokens[self.at]
        assert kind == "word" and text.lower() not in RESERVED, f"'{text}' cannot be a name"
        self.at += 1
        return text

    def section(self):
        kind = self.next()
        if self.peek() == "CONSTANT":
            kind += " " + self.next()
        while self.peek() != "END_VAR":
            name = self.name()
            assert name.lower() not in (known.lower() for known in self.types), f"two variables {name}"
            self.expect(":")
            self.types[name] = kind_of = self.next()
            assert kind_of in ("BOOL", "LINT", "REAL", "LREAL"), kind_of
            self.start[name] = {"BOOL": False, "LINT": 0}.get(kind_of, 0.0)
            if self.peek() == ":=":
                self.next()
                code, type_of = self.expression()
                self.check(type_of, kind_of)
                self.start[name] = eval(self.typed(code, type_of, kind_of), {"single": single})
            self.expect(";")
            {"VAR_INPUT": self.inputs, "VAR_OUTPUT": self.outputs}.get(kind, []).append(name)
            if kind in ("VAR CONSTANT", "VAR_INPUT"):
                self.constants.add(name)
        self.expect("END_VAR")

    def statements(self, indent, ends):
        before = "  " * indent
        self.lines.append(before + "pass")
        while self.peek() not in ends:
            if self.peek() == "IF":
                self.next()
                self.lines.append(f"{before}if {self.condition()}:")
                self.expect("THEN")
                self.statements_of_branch(indent)
            else:
                target = self.name()
                assert target in self.types and target not in self.constants, f"{target} cannot be assigned"
                self.expect(":=")
                code, type_of = self.expression()
                self.check(type_of, self.types[target])
                self.lines.append(f"{before}v[{target!r}] = {self.typed(code, type_of, self.types[target])}")
                self.expect(";")
        if "END_FUNCTION_BLOCK" in ends:
            self.next()

    def statements_of_branch(self, indent):
        self.statements(indent + 1, {"ELSE", "END_IF"})
        if self.next() == "ELSE":
            self.lines.append("  " * indent + "else:")
            self.statements(indent + 1, {"END_IF"})
            self.next()
        self.expect(";")

    def condition(self):
        code, type_of = self.expression()
        self.check(type_of, "BOOL")
        return code

    @staticmethod
    def check(type_of, wanted):
        assert type_of == wanted or type_of == LITERAL and wanted in ("REAL", "LREAL"), f"{type_of} in place of {wanted}"

    @staticmethod
    def typed(code, type_of, wanted):
        return f"single({code})" if type_of == LITERAL and wanted == "REAL" else code

    def common(self, left, right):
        """Both operands in their common type."""
        (a, of_a), (b, of_b) = left, right
        wanted = of_b if of_a == LITERAL else of_a
        for type_of in (of_a, of_b):
            if wanted != LITERAL:
                self.check(type_of, wanted)
        return self.typed(a, of_a, wanted), self.typed(b, of_b, wanted), wanted

    def binary(self, operand, signs, result=None):
        left = operand()
        while self.peek() in signs:
            sign = signs[self.next()]
            a, b, type_of = self.common(left, operand())
            code = f"({a} {sign} {b})"
            if type_of == "REAL" and not result:
                code = f"single{code}"
            left = code, result or type_of
        return left

    def logical(self, operand, sign):
        left = operand()
        while self.peek() == sign:
            self.next()
            right = operand()
            self.check(left[1], "BOOL")
            self.check(right[1], "BOOL")
            left = f"({left[0]} {sign.lower()} {right[0]})", "BOOL"
        return left

    # The standard's order of precedence, from the weakest.
    def expression(self):
        return self.logical(self.conjunction, "OR")

    def conjunction(self):
        return self.logical(self.equality, "AND")

    def equality(self):
        return self.binary(self.comparison, {"=": "==", "<>": "!="}, "BOOL")

    def comparison(self):
        return self.binary(self.sum, {s: s for s in ("<=", ">=", "<", ">")}, "BOOL")

    def sum(self):
        return self.binary(self.product, {"+": "+", "-": "-"})

    def product(self):
        return self.binary(self.unary, {"*": "*", "/": "/", "MOD": "%"})

    def unary(self):
        if self.peek() == "-":
            self.next()
            code, type_of = self.primary()
            assert type_of != "BOOL"
            return f"(-{code})", type_of
        if self.peek() == "NOT":
            self.next()
            code, type_of = self.primary()
            self.check(type_of, "BOOL")
            return f"(not {code})", "BOOL"
        return self.primary()

    def primary(self):
        kind, text = self.tokens[self.at]
        self.at += 1
        if text == "(":
            inside = self.expression()
            self.expect(")")
            return inside
        if kind == "number":
            return (text, LITERAL) if "." in text else (text, "LINT")
        if text in ("TRUE", "FALSE"):
            return text.capitalize(), "BOOL"
        if self.peek() == "(":
            return self.function(text)
        assert text in self.types, f"'{text}' is not declared"
        return f"v[{text!r}]", self.types[text]

    def function(self, name):
        self.expect("(")
        operands = [self.expression()]
        while self.peek() == ",":
            self.next()
            operands.append(self.expression())
        self.expect(")")
        if name == "ABS":
            (code, type_of), = operands
            return f"abs({code})", type_of
        if name == "SEL":
            self.check(operands[0][1], "BOOL")
            a, b, type_of = self.common(*operands[1:])
            return f"({b} if {operands[0][0]} else {a})", type_of
        if name == "LIMIT":
            low, x, type_of = self.common(*operands[:2])
            _, high, _ = self.common(operands[1], operands[2])
            return f"min(max({x}, {low}), {high})", type_of
        source, target = name.split("_TO_")
        self.check(operands[0][1], source)
        forms = {("LINT", "REAL"): "single({0})", ("LINT", "LREAL"): "float({0})", ("BOOL", "LINT"): "int({0})",
                 ("LREAL", "LINT"): "round({0})", ("REAL", "LINT"): "round({0})"}
        return forms[source, target].format(operands[0][0]), target


def judge(path):
    block = Block(path.read_text())
    state = dict(block.start)
    output, = block.outputs
    state["restart"] = True
    for number, line in enumerate(Path(f"{path}.samples").read_text().splitlines()):
        *given, expected = [float.fromhex(word) for word in line.split()]
        for name, value in zip(block.inputs[1:], given, strict=True):
            state[name] = {"BOOL": bool, "LINT": int, "REAL": single, "LREAL": float}[block.types[name]](value)
        block.call(state)
        state["restart"] = False
        if state[output] != expected:
            sys.exit(f"{path}, sample {number}: {state[output].hex()} in place of {expected.hex()}\n{path.read_text()}")


for file in sys.argv[1:]:
    judge(Path(file))
