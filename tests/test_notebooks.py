"""Notebooks are their scripts, show the outputs of their own code, and go at a student's pace."""

import re
from pathlib import Path

import jupytext
import nbformat
import pytest
from outputs import HIDDEN, fingerprint
from teaching import agree, check, right
from without_outputs import write_copies

FOLDER = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
LONGEST_CELL = 15
OF_A_MACHINE = re.compile(r"(?<![\w.])/(?:home|Users|root|tmp|var/folders)\b|[A-Za-z]:\\+Users\b")
each_notebook = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def visible_code(notebook):
    """Return the lines of code of every cell that a student sees."""
    return [
        [line for line in cell.source.splitlines() if line.strip()]
        for cell in notebook.cells
        if cell.cell_type == "code" and not HIDDEN.intersection(cell.metadata.get("tags", []))
    ]


def test_they_are_numbered_and_paired():
    names = [path.stem for path in NOTEBOOKS]
    assert len({name[:3] for name in names}) == len(names)
    assert all(re.match(r"\d\d_", name) for name in names)
    assert [path.stem for path in sorted(FOLDER.glob("[0-9]*.py"))] == names


@each_notebook
def test_a_lesson_is_in_the_list_of_lessons(path):
    table = (FOLDER.parent / "docs" / "notebooks.md").read_text(encoding="utf-8")
    assert re.search(rf"\n\| \[{int(path.stem[:2])}\. .*\]\(\.\./notebooks/{path.name}\) \|", table)


@each_notebook
def test_a_notebook_is_its_script(path):
    """Mend with: make render LESSON=NN."""
    notebook, script = (jupytext.read(path.with_suffix(end)) for end in (".ipynb", ".py"))
    assert [(cell.cell_type, cell.source) for cell in notebook.cells] == [
        (cell.cell_type, cell.source) for cell in script.cells
    ]
    assert [cell.metadata.get("tags", []) for cell in notebook.cells] == [
        cell.metadata.get("tags", []) for cell in script.cells
    ]


@each_notebook
def test_outputs_belong_to_the_code(path):
    """Mend with: make render LESSON=NN."""
    notebook = jupytext.read(path)
    assert notebook.metadata.get("executed") == fingerprint(jupytext.read(path.with_suffix(".py")))
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
    hidden = [cell for cell in code if HIDDEN.intersection(cell.metadata.get("tags", []))]
    assert hidden
    assert all(cell.metadata.jupyter.source_hidden for cell in hidden)  # for JupyterLab
    outputs = [output for cell in code for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert not any(output.get("name") == "stderr" for output in outputs)
    assert not any(output.output_type == "error" for output in outputs)
    assert str(FOLDER.parent) not in str(outputs)
    assert not [text for output in outputs for text in texts(output) if OF_A_MACHINE.search(text)]


def texts(output):
    """Return what an output says, without its pictures."""
    data = output.get("data", {}).items()
    return [output.get("text", ""), *(str(each) for kind, each in data if "image/png" not in kind)]


def test_the_outputs_are_small():
    assert sum(path.stat().st_size for path in NOTEBOOKS) < 4e6


@each_notebook
def test_what_a_student_sees(path):
    """A few lines that carry the idea, no assertions, and a task with a check."""
    notebook = jupytext.read(path.with_suffix(".py"))
    cells = visible_code(notebook)
    assert max(map(len, cells)) <= LONGEST_CELL
    lines = [line for cell in cells for line in cell]
    assert not any(line.lstrip().startswith("assert ") for line in lines)
    assert any("your code here" in line for line in lines)
    assert "import crazybilliards as cb" in lines
    assert any(line.startswith("check(") for line in lines)
    text = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    assert 0 < text.count("<details>") == text.count("</details>")
    assert 0 < text.count("**Predict") <= text.count("**Run")
    assert "hint=" in "\n".join(lines)
    assert "**Explain" not in text  # it would give the answer away: <details> folds it
    assert text.split("\n## ")[0].count("`make lessons`") == 1  # which has no outputs


def test_copies_have_no_outputs_and_keep_answers(tmp_path, capsys):
    write_copies(tmp_path)
    assert (tmp_path / "teaching.py").exists()
    assert [path.name for path in sorted(tmp_path.glob("*.ipynb"))] == [p.name for p in NOTEBOOKS]
    for path in NOTEBOOKS:
        copy, original = (nbformat.read(file, 4) for file in (tmp_path / path.name, path))
        assert [cell.source for cell in copy.cells] == [cell.source for cell in original.cells]
        assert [cell.metadata for cell in copy.cells] == [cell.metadata for cell in original.cells]
        code = [cell for cell in copy.cells if cell.cell_type == "code"]
        assert not any(cell.outputs or cell.execution_count for cell in code)
        nbformat.validate(copy)
    answered = tmp_path / NOTEBOOKS[0].name
    answered.write_text("answers")
    (tmp_path / NOTEBOOKS[1].name).unlink()
    write_copies(tmp_path)
    assert answered.read_text() == "answers"
    assert (tmp_path / NOTEBOOKS[1].name).exists()
    assert f"{len(NOTEBOOKS) - 1} lessons were there" in capsys.readouterr().out


def wrong(x):
    return x + 1


def missing(x):
    return ...


def without_return(x):
    abs(x)


def broken(x):
    raise ValueError("no root")


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (abs, "Right."),
        (lambda x: -abs(x), "Right."),
        (wrong, "Not yet: for (-1) you have 0, and right is 1. Hint: sign"),
        (missing, "Your turn"),
        (without_return, "returns nothing: write return"),
        (broken, "no root"),
    ],
)
def test_an_answer_is_checked(answer, said, capsys):
    check(answer, abs, at=[(-1.0,), (2.0,)], hint="sign", also=[lambda x: -abs(x)])
    assert said in capsys.readouterr().out


def test_numbers_are_checked(capsys):
    check(..., 2.0, hint="half")
    check([1, 2], [1, 2], hint="half")
    check([1, 2], 1, hint="half")
    check([0.599], [0.6], hint="half", tolerance=2e-3)
    check([3, 4], [1, 2], hint="half")
    said = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in said] == ["Your", "Right.", "Not", "Right.", "Not"]
    assert "shape (2,)" in said[2]
    assert "you have [3, 4]" in said[4]
    assert not right(float("nan"), 1.0)
    assert right(0.5004, 0.5, tolerance=1e-3)


@pytest.mark.parametrize("measured", [6.0, float("nan")])
def test_disagreement_stops_a_lesson(measured):
    agree("near", [4.9, 0], 0, 1)
    with pytest.raises(AssertionError):
        agree("far", [measured, 0], 0, 1)
