"""Notebooks are their scripts, show the outputs of their own code, and go at a student's pace."""

import ast
import re
import symtable
from pathlib import Path

import jupytext
import nbformat
import pytest
from outputs import HIDDEN, fingerprint
from without_outputs import write_copies

FOLDER = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
LONGEST_CELL = 15
MOST_WORDS = 1800
STOP = "**You can stop here.**"
OF_A_MACHINE = re.compile(r"(?<![\w.])/(?:home|Users|root|tmp|var/folders)\b|[A-Za-z]:\\+Users\b")


@pytest.fixture(scope="module", params=NOTEBOOKS, ids=lambda path: path.stem)
def lesson(request):
    """Return the name of a lesson, its notebook and its script."""
    path = request.param
    return path.name, *(jupytext.read(path.with_suffix(end)) for end in (".ipynb", ".py"))


def sections():
    """Return the numbers of the sections of each lesson, and the one that ends at its stop."""
    found = {}
    for path in NOTEBOOKS:
        if is_for_a_class(path.stem):
            before, after = (
                [int(number) for number in re.findall(r"^# ## (\d+)\. ", part, re.MULTILINE)]
                for part in path.with_suffix(".py").read_text(encoding="utf-8").split(STOP)
            )
            found[int(path.stem[:2])] = before + after, before[-1]
    return found


def tags(cell):
    return cell.metadata.get("tags", [])


def is_for_a_class(name):
    """Tell lessons from notebooks for readers of the paper and for a seminar: by their number."""
    return name[0].isdigit()


def test_they_are_numbered_paired_and_small():
    scripts = {path.stem for path in FOLDER.glob("*.py")}
    assert scripts - {path.stem for path in NOTEBOOKS} == {"teaching", "outputs", "without_outputs"}
    lessons = [path for path in NOTEBOOKS if path.stem[0].isdigit()]
    assert [int(path.stem[:2]) for path in lessons] == list(range(1, len(lessons) + 1))
    assert sum(path.stat().st_size for path in NOTEBOOKS) < 4e6


def test_a_notebook_is_its_script_and_in_the_list_of_lessons(lesson):
    """Mend with: make render LESSON=NN."""
    name, *both = lesson
    cells, expected = ([(c.cell_type, c.source, tags(c)) for c in each.cells] for each in both)
    assert cells == expected
    table = (FOLDER.parent / "docs" / "notebooks.md").read_text(encoding="utf-8")
    number = rf"{int(name[:2])}\. " if name[0].isdigit() else ""
    assert re.search(rf"\n\| \[{number}[A-Z].*\]\(\.\./notebooks/{name}\) \|", table)


def test_outputs_belong_to_the_code(lesson):
    """Mend with: make render LESSON=NN."""
    _, notebook, script = lesson
    assert notebook.metadata.get("executed") == fingerprint(script)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
    hidden = [cell for cell in code if HIDDEN.intersection(tags(cell))]
    assert hidden
    assert all(cell.metadata.jupyter.source_hidden for cell in hidden)  # for JupyterLab
    outputs = [output for cell in code for output in cell.outputs]
    kinds = {kind for output in outputs for kind in output.get("data", {})}
    assert "image/png" in kinds
    assert not any(output.get("name") == "stderr" for output in outputs)
    assert not any(output.output_type == "error" for output in outputs)
    assert str(FOLDER.parent) not in str(outputs)
    for output in outputs:
        data = output.get("data", {}).items()
        texts = [str(each) for kind, each in data if kind != "image/png"]
        assert not OF_A_MACHINE.search("\n".join([output.get("text", ""), *texts]))


REFERENCE = re.compile(
    r"lesson (\d+)(?:\]\([^)]*\))?,? \(?sections? (\d+)(?: (?:to|and) (\d+))?"  # in a sentence
    r"|[|,] (\d+) \(sections? (\d+)(?: (?:to|and) (\d+))?",  # in a table
    re.IGNORECASE,
)


def test_sections_that_texts_refer_to_exist():
    root, known = FOLDER.parent, sections()
    pages = [root / "README.md", *root.glob("docs/**/*.md"), *FOLDER.glob("*.py")]
    found = [
        (path.name, *(int(each) for each in match if each))
        for path in pages
        for match in REFERENCE.findall(" ".join(path.read_text(encoding="utf-8").split()))
    ]
    assert {"notebooks.md", "teach_a_week.md", "force_balance.md"} <= {name for name, *_ in found}
    wrong = [each for each in found if not set(each[2:]) <= set(known[each[1]][0])]
    assert not wrong


def test_the_plan_of_a_course_has_all_lessons_in_order_and_their_stops():
    plan = (FOLDER.parent / "docs" / "teach_a_week.md").read_text(encoding="utf-8")
    row = r"^\| \[(\d+)\. .*\]\(\.\./notebooks/(\d+)_.*\) \|.*\| (\d+) \| (\d+) \|"
    rows = [tuple(map(int, each)) for each in re.findall(row, plan, re.MULTILINE)]
    stops = {number: stop for number, (_, stop) in sections().items()}
    assert rows == [(number, number, 90, stop) for number, stop in stops.items()]


def test_what_a_student_sees(lesson):
    """A few lines that carry the idea, no assertions, and a task with a check."""
    _, _, script = lesson
    code = [cell for cell in script.cells if cell.cell_type == "code"]
    seen = [cell.source.splitlines() for cell in code if not HIDDEN.intersection(tags(cell))]
    cells = [[line for line in cell if line.strip()] for cell in seen]
    assert max(map(len, cells)) <= LONGEST_CELL
    lines = [line for cell in cells for line in cell]
    assert not any(line.lstrip().startswith("assert ") for line in lines)
    assert any("your code here" in line for line in lines)
    assert "import crazybilliards as cb" in lines
    assert any(line.startswith("check(") for line in lines)
    text = "\n".join(cell.source for cell in script.cells if cell.cell_type == "markdown")
    assert 0 < text.count("<details>") == text.count("</details>")
    assert 0 < text.count("**Predict") <= text.count("**Run")
    assert "hint=" in "\n".join(lines)
    assert "**Explain" not in text  # it would give the answer away: <details> folds it
    assert text.split("\n## ")[0].count("`make lessons`") == 1  # which has no outputs


def test_a_lesson_fits_ninety_minutes(lesson):
    """A minute for a hundred words of comments and four for each answer; one place to stop."""
    name, _, script = lesson
    if not is_for_a_class(name):
        pytest.skip("not a lesson of ninety minutes")
    lines = (FOLDER / name).with_suffix(".py").read_text(encoding="utf-8").splitlines()
    lines = lines[lines.index("# ---", 1) + 1 :]  # behind the header of jupytext
    comments = [line for line in lines if line.startswith("#") and not line.startswith("# %%")]
    words = sum(len(line.split()) for line in comments)
    code = [cell.source for cell in script.cells if cell.cell_type == "code"]
    answers = sum(any(line.startswith("check(") for line in cell.splitlines()) for cell in code)
    assert words <= MOST_WORDS
    assert answers >= 3
    assert words / 100 + 4 * answers <= 90
    text = [cell.source for cell in script.cells if cell.cell_type == "markdown"]
    stops = [line for cell in text for line in cell.splitlines() if line.startswith(STOP)]
    assert len(stops) == 1
    assert len(stops[0]) > len(STOP) + 20, "say what one has by then"
    assert "Time: 90 minutes" in re.sub(r"\s+", " ", text[0])


def test_a_changed_number_stops_no_cell(lesson):
    """Assertions stand only in cells that the copies for learners lack."""
    _, _, script = lesson
    for cell in script.cells:
        if cell.cell_type == "code" and "remove-cell" not in tags(cell):
            nodes = ast.walk(ast.parse(cell.source))
            assert not any(isinstance(node, ast.Assert) for node in nodes)


class AsGenerators(ast.NodeTransformer):
    """Comprehensions as generators, whose names stay their own: from Python 3.12 only theirs do."""

    def visit_ListComp(self, node):
        self.generic_visit(node)
        return ast.GeneratorExp(node.elt, node.generators)

    def visit_SetComp(self, node):
        return self.visit_ListComp(node)

    def visit_DictComp(self, node):
        self.generic_visit(node)
        return ast.GeneratorExp(ast.Tuple([node.key, node.value], ast.Load()), node.generators)


def names(statement):
    """Return the global names that a statement uses and those that it binds."""
    used, bound = set(), set()
    scopes = [symtable.symtable(ast.unparse(AsGenerators().visit(statement)), "cell", "exec")]
    while scopes:
        scope = scopes.pop()
        whole = scope.get_type() == "module"
        scopes += scope.get_children()
        for symbol in scope.get_symbols():
            if symbol.is_referenced() and (whole or symbol.is_global()):
                used.add(symbol.get_name())
            if whole and (symbol.is_assigned() or symbol.is_imported()):
                bound.add(symbol.get_name())
    if isinstance(statement, ast.For | ast.With | ast.FunctionDef):
        used -= bound  # these bind their names first
    return used, bound


def used_from_removed_cells(notebook):
    """Return the names that a cell takes from a cell that the copies for learners lack."""
    removed, found = set(), set()
    for cell in notebook.cells:
        if cell.cell_type == "code":
            for statement in ast.parse(cell.source).body:
                used, bound = names(statement)
                if "remove-cell" in tags(cell):
                    removed |= bound
                else:
                    found |= used & removed
                    removed -= bound
    return found


def test_no_cell_needs_one_that_the_copies_lack(lesson):
    _, _, script = lesson
    assert not used_from_removed_cells(script)


@pytest.mark.parametrize(
    ("removed", "later", "found"),
    [
        ("a = 1", "print(a)", {"a"}),
        ("a = 1", "f = lambda x: a * x", {"a"}),
        ("def a(): return 1", "def f(b):\n    return a() + b", {"a"}),
        ("a = 1", "for a in (1, 2):\n    print(a)\nprint(a)", set()),
        ("a = [b for b in (1, 2)]", "b = 3\nc = [a for a in (1, 2)]", set()),
        ("a = 1", "a = 2\nprint(a)", set()),
        ("a = 1", "def f(a):\n    return a", set()),
    ],
)
def test_names_from_removed_cells_are_found(removed, later, found):
    cells = [nbformat.v4.new_code_cell(source) for source in (removed, later)]
    cells[0].metadata["tags"] = ["remove-cell"]
    assert used_from_removed_cells(nbformat.v4.new_notebook(cells=cells)) == found


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


def test_copies_have_no_outputs_and_no_solutions(tmp_path):
    write_copies(tmp_path)
    assert (tmp_path / "teaching.py").exists()
    assert [path.name for path in sorted(tmp_path.glob("*.ipynb"))] == [p.name for p in NOTEBOOKS]
    answers = set(answers_of_the_solutions())
    assert answers
    for path in NOTEBOOKS:
        copy, original = (nbformat.read(file, 4) for file in (tmp_path / path.name, path))
        kept = [(cell.source, cell.metadata) for cell in copy.cells if cell.cell_type == "code"]
        code = [cell for cell in original.cells if cell.cell_type == "code"]
        assert kept == [(c.source, c.metadata) for c in code if "remove-cell" not in tags(c)]
        text = "\n".join(cell.source for cell in copy.cells)
        assert "Solution</summary>" not in text
        assert text.count("<details>") == text.count("</details>")
        assert not [answer for answer in answers if answer in plain(text)]
        assert not any(cell.get("outputs") or cell.get("execution_count") for cell in copy.cells)
        for module in re.findall(r"from solutions import (\w+)", text):
            assert (tmp_path / "solutions" / f"{module}.py").exists()
        nbformat.validate(copy)


def test_copies_keep_answers(tmp_path, capsys):
    write_copies(tmp_path)
    answered = tmp_path / NOTEBOOKS[0].name
    answered.write_text("answers")
    (tmp_path / NOTEBOOKS[1].name).unlink()
    write_copies(tmp_path)
    assert answered.read_text() == "answers"
    assert (tmp_path / NOTEBOOKS[1].name).exists()
    assert f"{len(NOTEBOOKS) - 1} lessons were there" in capsys.readouterr().out
