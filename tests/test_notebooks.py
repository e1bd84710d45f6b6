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


@pytest.fixture(scope="module", params=NOTEBOOKS, ids=lambda path: path.stem)
def lesson(request):
    """Return the name of a lesson, its notebook and its script."""
    path = request.param
    return path.name, *(jupytext.read(path.with_suffix(end)) for end in (".ipynb", ".py"))


def tags(cell):
    return cell.metadata.get("tags", [])


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


def test_copies_have_no_outputs_and_keep_answers(tmp_path, capsys):
    write_copies(tmp_path)
    assert (tmp_path / "teaching.py").exists()
    assert [path.name for path in sorted(tmp_path.glob("*.ipynb"))] == [p.name for p in NOTEBOOKS]
    for path in NOTEBOOKS:
        copy, original = (nbformat.read(file, 4) for file in (tmp_path / path.name, path))
        kept = [[(cell.source, cell.metadata) for cell in each.cells] for each in (copy, original)]
        assert kept[0] == kept[1]
        assert not any(cell.get("outputs") or cell.get("execution_count") for cell in copy.cells)
        nbformat.validate(copy)
    answered = tmp_path / NOTEBOOKS[0].name
    answered.write_text("answers")
    (tmp_path / NOTEBOOKS[1].name).unlink()
    write_copies(tmp_path)
    assert answered.read_text() == "answers"
    assert (tmp_path / NOTEBOOKS[1].name).exists()
    assert f"{len(NOTEBOOKS) - 1} lessons were there" in capsys.readouterr().out


def broken(x):
    raise ValueError("no root")


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (abs, "Right."),
        (lambda x: -abs(x), "Right."),
        (lambda x: x + 1, "Not yet: for (-1) you have 0, and right is 1. Hint: sign"),
        (lambda x: ..., "Your turn"),
        (lambda x: None, "returns nothing: write return"),
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
