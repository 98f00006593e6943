"""Mutants of a C++ source: the same text with one operator, comparison or constant changed."""

import re
from dataclasses import dataclass

# Binary operators have spaces around them in this project, template brackets have none.
OPERATORS = {
    "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==",
    "+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "+=": "-=", "-=": "+=", "*=": "/=",
    "&&": "||", "||": "&&", "<<": ">>", ">>": "<<", "&": "|", "|": "&",
}
WORDS = {"true": "false", "false": "true", "std::min": "std::max", "std::max": "std::min"}

HIDDEN = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|^ *#[^\n]*'
                    r'|^ *WEFT_ASSERT\(.*?\);|^ *static_assert\(.*?\);', re.S | re.M)
OPERATOR = re.compile(r"(?<= )(%s)(?= |\n)" % "|".join(
    re.escape(o) for o in sorted(OPERATORS, key=len, reverse=True)))
WORD = re.compile(r"(?<![\w:])(%s)(?!\w)" % "|".join(WORDS))
STEP = re.compile(r"(\+\+|--)(?=\w)")
NOT = re.compile(r"(?<=[( ])!(?=[\w(])")
NUMBER = re.compile(r"(?<![\w.])(\d+\.?\d*(?:e[+-]?\d+)?)([uUlLfF]*)(?![\w.])")


@dataclass(frozen=True)
class Mutant:
    begin: int  # of what is replaced, in the text
    end: int
    new: str
    line: int   # from 1

    def applied_to(self, text):
        return text[:self.begin] + self.new + text[self.end:]


def mutants_of(text):
    """All mutants, by place."""
    # Comments, strings and checks keep their length and lose their letters.
    bare = HIDDEN.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
    found = []

    def add(match, new):
        found.append(Mutant(match.start(), match.end(), new, text.count("\n", 0, match.start()) + 1))

    for match in OPERATOR.finditer(bare):
        add(match, OPERATORS[match.group()])
    for match in WORD.finditer(bare):
        add(match, WORDS[match.group()])
    for match in STEP.finditer(bare):
        add(match, "--" if match.group() == "++" else "++")
    for match in NOT.finditer(bare):
        add(match, "")
    for match in NUMBER.finditer(bare):
        add(match, _other_number(match.group(1)) + match.group(2))
    return sorted(found, key=lambda mutant: mutant.begin)


def _other_number(number):
    if re.fullmatch(r"\d+", number):
        return {"0": "1", "1": "0"}.get(number, str(int(number) + 1))
    return "1.0" if float(number) == 0.0 else repr(2.0 * float(number))
