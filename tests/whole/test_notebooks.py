"""Notebooks are their scripts, show the outputs of their own code, and go at a student's pace."""

import ast
import builtins
import re
import symtable
from pathlib import Path

import jupytext
import nbformat
import pytest
from outputs import HIDDEN, fingerprint
from without_outputs import write_copies

FOLDER = Path(__file__).parents[2] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
LONGEST_CELL = 15
MOST_WORDS = 1750
MOST_WORDS_OF_ALL = 14_000
STOP = "**You can stop here.**"
OF_A_MACHINE = re.compile(r"(?<![\w.])/(?:home|Users|root|tmp|var/folders)\b|[A-Za-z]:\\+Users\b")


@pytest.fixture(scope="module", params=NOTEBOOKS, ids=lambda path: path.stem)
def lesson(request):
    """Return the name of a lesson, its notebook and its script."""
    path = request.param
    return path.name, *(jupytext.read(path.with_suffix(end)) for end in (".ipynb", ".py"))


def tags(cell):
    return cell.metadata.get("tags", [])


def text_of(notebook):
    return "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")


def judged(cell):
    """Return whether the answer of a task is judged in a cell of code."""
    return any(line.startswith(("check(", "choose(")) for line in cell.source.splitlines())


def test_a_notebook_is_its_script_and_in_the_list_of_lessons(lesson):
    """Mend with: make render LESSON=NN."""
    name, *both = lesson
    cells, expected = ([(c.cell_type, c.source, tags(c)) for c in each.cells] for each in both)
    assert cells == expected
    table = (FOLDER.parent / "docs" / "notebooks.md").read_text(encoding="utf-8")
    assert re.search(rf"\n\| \[{int(name[:2])}\. [A-Z].*\]\(\.\./notebooks/{name}\) \|", table)


def test_outputs_belong_to_the_code(lesson):
    """Mend with: make render LESSON=NN."""
    _, notebook, script = lesson
    assert notebook.metadata.get("executed") == fingerprint(script)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    outputs = [output for cell in code for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert not any(output.get("name") == "stderr" for output in outputs)
    assert not any(output.output_type == "error" for output in outputs)
    for output in outputs:
        data = output.get("data", {}).items()
        texts = [str(content) for kind, content in data if kind != "image/png"]
        assert not OF_A_MACHINE.search("\n".join([output.get("text", ""), *texts]))


def test_the_plan_of_a_course_has_all_lessons_in_order_and_their_stops():
    plan = (FOLDER.parent / "docs" / "teach_a_week.md").read_text(encoding="utf-8")
    row = r"^\| \[(\d+)\. .*\]\(\.\./notebooks/(\d+)_.*\) \|.*\| (\d+) \| (\d+) \|"
    rows = [tuple(map(int, each)) for each in re.findall(row, plan, re.MULTILINE)]
    expected = []
    for path in NOTEBOOKS:
        before, _ = path.with_suffix(".py").read_text(encoding="utf-8").split(STOP)
        stop = re.findall(r"^# ## (\d+)\. ", before, re.MULTILINE)[-1]
        expected.append((int(path.stem[:2]), int(path.stem[:2]), 90, int(stop)))
    assert rows == expected


def test_what_a_student_sees(lesson):
    """A few lines that carry the idea, no assertions, and a task with a check."""
    _, _, script = lesson
    code = [cell for cell in script.cells if cell.cell_type == "code"]
    seen = [cell.source.splitlines() for cell in code if not HIDDEN.intersection(tags(cell))]
    cells = [[line for line in cell if line.strip()] for cell in seen]
    assert max(map(len, cells)) <= LONGEST_CELL
    copied = [cell.source for cell in code if "remove-cell" not in tags(cell)]
    assert not re.search(r"^\s*assert ", "\n".join(copied), re.MULTILINE)
    lines = [line for cell in cells for line in cell]
    assert any("your code here" in line for line in lines)
    assert "import crazybilliards as cb" in lines
    text = text_of(script)
    assert 0 < text.count("<details>") == text.count("</details>")
    assert 0 < text.count("**Predict") <= text.count("**Run")
    assert "hint=" in "\n".join(lines)
    assert "**Explain" not in text  # it would give the answer away: <details> folds it
    assert text.split("\n## ")[0].count("`make lessons`") == 1  # which has no outputs
    begun, later = text.split("**Back on the page")
    for part, name in ((begun, "**Two minutes on the page.**"), (later, "")):
        assert name in part
        assert part.count('<a href="../docs/chain.md#') == 1


def test_a_lesson_fits_ninety_minutes(lesson):
    """A minute for a hundred words of text and four for each answer; one place to stop."""
    _, _, script = lesson
    text = text_of(script)
    code = [cell for cell in script.cells if cell.cell_type == "code"]
    words, answers = len(text.split()), sum(map(judged, code))
    assert words <= MOST_WORDS
    assert answers >= 3
    assert words / 100 + 4 * answers <= 90
    stops = [line for line in text.splitlines() if line.startswith(STOP)]
    assert len(stops) == 1
    assert len(stops[0]) > len(STOP) + 20, "say what one has by then"
    assert "\n*90 minutes." in text


def test_all_lessons_together_are_short():
    books = [jupytext.read(path) for path in NOTEBOOKS]
    assert sum(len(text_of(book).split()) for book in books) <= MOST_WORDS_OF_ALL


def global_names(cells):
    """Return the global names that code uses, and those that it binds."""
    used, bound = set(), set()
    scopes = [symtable.symtable("\n".join(cell.source for cell in cells), "lesson", "exec")]
    for scope in scopes:  # which grows
        scopes += scope.get_children()
        whole = scope.get_type() == "module"
        for symbol in scope.get_symbols():
            if symbol.is_referenced() and (whole or symbol.is_global()):
                used.add(symbol.get_name())
            if whole and (symbol.is_assigned() or symbol.is_imported()):
                bound.add(symbol.get_name())
    return used, bound


def test_no_cell_needs_one_that_the_copies_lack(lesson):
    _, _, script = lesson
    code = [cell for cell in script.cells if cell.cell_type == "code"]
    used, bound = global_names([cell for cell in code if "remove-cell" not in tags(cell)])
    assert used <= {*bound, *vars(builtins), "display"}


def plain(code):
    return re.sub(r"\s+", "", code)


def answers_of_the_solutions():
    """Return, without white space, what the functions of the solutions return or compute."""
    for path in (FOLDER / "solutions").glob("[!_]*.py"):
        for function in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(function, ast.FunctionDef):
                for node in ast.walk(function):
                    if isinstance(node, ast.Return) and not isinstance(node.value, ast.Lambda):
                        yield plain(ast.unparse(node))


def test_copies_have_no_outputs_and_no_solutions_and_keep_answers(tmp_path, capsys):
    write_copies(tmp_path)
    assert (tmp_path / "teaching.py").exists()
    assert [path.name for path in sorted(tmp_path.glob("*.ipynb"))] == [p.name for p in NOTEBOOKS]
    answers = set(answers_of_the_solutions())
    assert answers
    for path in NOTEBOOKS:
        copy, original = (nbformat.read(file, 4) for file in (tmp_path / path.name, path))
        copied, code = (
            [cell for cell in book.cells if cell.cell_type == "code"] for book in (copy, original)
        )
        assert [c.source for c in copied] == [
            c.source for c in code if "remove-cell" not in tags(c)
        ]
        text = "\n".join(cell.source for cell in copy.cells)
        assert "Solution</summary>" not in text
        assert "../docs/" not in text
        assert not [answer for answer in answers if answer in plain(text)]
        assert not any(cell.get("outputs") or cell.get("execution_count") for cell in copy.cells)
    answered = tmp_path / NOTEBOOKS[0].name
    answered.write_text("answers")
    (tmp_path / NOTEBOOKS[1].name).unlink()
    write_copies(tmp_path)
    assert answered.read_text() == "answers"
    assert (tmp_path / NOTEBOOKS[1].name).exists()
    assert f"{len(NOTEBOOKS) - 1} lessons were there" in capsys.readouterr().out
