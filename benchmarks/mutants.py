"""Mutants: small errors put into the rooms, one at a time, to see whether a test notices them.

python benchmarks/mutants.py draw 60 76 > benchmarks/mutants.csv
python benchmarks/mutants.py test benchmarks/mutants.csv [pytest's arguments]

``draw`` takes places at random from everything in the rooms that has an operator, a comparison, a
number or a logical word. ``test`` makes one error after the other in this folder, runs the tests as
far as the first that fails, and writes that test into the list. It begins with the test that
noticed the error before. A test that takes longer than its limit has noticed it as well. An error
that no test notices need not be a gap, because some do not change what the code does.
"""

import ast
import csv
import random
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple, TextIO

HERE = Path(__file__).parent.parent
ROOMS = "model", "particles", "kinetic", "comparison", "reproduction", "apps", "api"
_SWAPPED = """
Add + -, Sub - +, Mult * /, Div / *, Pow ** *, FloorDiv // /, Mod % *, Lt < <=, LtE <= <, Gt > >=,
GtE >= >, Eq == !=, NotEq != ==, Is is is_not, IsNot is_not is, In in not_in, NotIn not_in in,
And and or, Or or and
"""
OPERATORS = {
    getattr(ast, name): (old.replace("_", " "), new.replace("_", " "))
    for name, old, new in (each.split() for each in _SWAPPED.split(","))
}
FACTOR = 1.1  # of a number with a point
NOT = "no"


class Mutant(NamedTuple):
    """A line and what is made of it; ``noticed``: the test that failed, or "no"."""

    file: str
    number: int
    line: str
    mutated: str
    noticed: str = ""


def mutants_of(path: Path) -> Iterator[Mutant]:
    """Make every error of a file, one for each place."""
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    for node in ast.walk(ast.parse(text)):
        for number, start, end, new in _changes(node, lines):
            line = lines[number - 1]
            mutated = line[:start] + new + line[end:]
            yield Mutant(str(path.relative_to(HERE)), number, line, mutated)


def _changes(node: ast.AST, lines: list[str]) -> Iterator[tuple[int, int, int, str]]:
    """Return line, columns and the new text of every error at a node."""
    if isinstance(node, ast.BinOp):
        yield from _operator(node.op, node.left, node.right, lines)
    elif isinstance(node, ast.BoolOp):
        for left, right in zip(node.values, node.values[1:], strict=False):
            yield from _operator(node.op, left, right, lines)
    elif isinstance(node, ast.Compare):
        sides = [node.left, *node.comparators]
        for op, left, right in zip(node.ops, sides, sides[1:], strict=False):
            yield from _operator(op, left, right, lines)
    elif isinstance(node, ast.Constant) and node.end_col_offset is not None:
        value = node.value
        if isinstance(value, bool):
            yield node.lineno, node.col_offset, node.end_col_offset, str(not value)
        elif isinstance(value, int):
            yield node.lineno, node.col_offset, node.end_col_offset, str(value + 1)
        elif isinstance(value, float):
            yield node.lineno, node.col_offset, node.end_col_offset, repr(value * FACTOR)


def _operator(
    op: ast.AST, left: ast.expr, right: ast.expr, lines: list[str]
) -> Iterator[tuple[int, int, int, str]]:
    """Replace the operator between two operands that are on one line."""
    if type(op) not in OPERATORS or left.end_lineno != right.lineno:
        return
    old, new = OPERATORS[type(op)]
    first, last = left.end_col_offset or 0, right.col_offset
    between = lines[right.lineno - 1][first:last]
    found = re.search(rf"(?<![*/<>=!]){re.escape(old)}(?![*/=])", between)
    if found:
        yield right.lineno, first + found.start(), first + found.end(), new


def draw(number: int, seed: int) -> None:
    """Print a list of mutants, drawn from all rooms."""
    files = sorted(path for room in ROOMS for path in (HERE / room).rglob("*.py"))
    every = [mutant for path in files for mutant in mutants_of(path)]
    _write(sys.stdout, random.Random(seed).sample(every, number))


def test(table: Path, arguments: list[str]) -> None:
    """Try all mutants of a list, and write what noticed them into it."""
    with table.open(encoding="utf-8") as file:
        mutants = [Mutant(row[0], int(row[1]), *row[2:]) for row in list(csv.reader(file))[1:]]
    for i, mutant in enumerate(mutants):
        noticed = _noticed(mutant, [mutant.noticed]) if "::" in mutant.noticed else NOT
        mutants[i] = mutant._replace(
            noticed=_noticed(mutant, arguments) if noticed == NOT else noticed
        )
        with table.open("w", encoding="utf-8", newline="") as file:
            _write(file, mutants)
        print(mutants[i].file, mutants[i].number, mutants[i].noticed, flush=True)


def _noticed(mutant: Mutant, arguments: list[str]) -> str:
    path = HERE / mutant.file
    before = path.read_text(encoding="utf-8")
    if before.count(f"{mutant.line}\n") == 0:
        return "the line has changed"
    lines = before.splitlines(keepends=True)
    same = [i for i, line in enumerate(lines) if line == f"{mutant.line}\n"]
    lines[min(same, key=lambda i: abs(i + 1 - mutant.number))] = f"{mutant.mutated}\n"
    pytest = [sys.executable, "-m", "pytest", "-x", "-q", "--no-header", "--tb=no", *arguments]
    try:
        path.write_text("".join(lines), encoding="utf-8")
        ended = subprocess.run(pytest, cwd=HERE, capture_output=True, text=True)
    finally:
        path.write_text(before, encoding="utf-8")
    failed = re.search(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", ended.stdout, re.MULTILINE)
    if failed:
        return failed[1]
    # A test that is no longer there notices nothing.
    return NOT if ended.returncode in (0, 4, 5) else "while tests were collected"


def _write(file: TextIO, mutants: list[Mutant]) -> None:
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(Mutant._fields)
    writer.writerows(mutants)


if __name__ == "__main__":
    command, *rest = sys.argv[1:] or ["help"]
    if command == "draw":
        draw(int(rest[0]), int(rest[1]))
    elif command == "test":
        test(Path(rest[0]), rest[1:])
    else:
        print(__doc__)
