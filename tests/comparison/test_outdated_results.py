"""Results of other source code are computed anew, and new parameters leave old results valid."""

import json
import os
import shutil
import sys
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace

import pytest
from installation import ROOT, run
from missing_cases import missing_cases

from crazybilliards.comparison import load_sweep
from crazybilliards.comparison.sweeps import Case, run_cases
from crazybilliards.comparison.sweeps.case import compute
from crazybilliards.comparison.sweeps.jobs import JOBS
from crazybilliards.model import Chain, load, save
from crazybilliards.model.storage import write_sealed

CASES = [Case("equilibrium", Chain(size=size), {}) for size in (2, 3)]


@pytest.fixture
def executor():
    with ThreadPoolExecutor(1) as threads:
        yield threads


@pytest.fixture
def folder(tmp_path):
    """Return a folder with the results of the cases."""
    for case in CASES:
        write_sealed(case.file(tmp_path), compute(case, case.source))
    return tmp_path


@pytest.fixture
def edited(monkeypatch):
    """Let the exact equilibrium be one whose velocity widths are twice as large."""
    job = JOBS["equilibrium"]

    def doubled(chain):
        result = job.function(chain)
        return result.assign(velocity_width=2 * result.velocity_width)

    other = replace(job, function=doubled, source="other source code")
    monkeypatch.setitem(JOBS, "equilibrium", other)


def width(case, folder, **settings):
    free = case.chain.free_velocity_width
    return float(case.load(folder, **settings).velocity_width[0]) / free


# -- source code ------------------------------------------------------------------------------


def test_a_result_of_other_source_code_is_computed_anew(folder, edited, executor, capsys):
    assert set(missing_cases(CASES, folder)) == set(CASES)
    for case in CASES:
        with pytest.raises(ValueError, match="computed by other source code"):
            case.load(folder)
    assert run_cases(CASES, folder, executor, progress=False) == {}
    [line] = capsys.readouterr().err.splitlines()
    assert f"computed 2 cases in {folder}; computing them anew" in line
    assert "--keep-old" in line
    assert missing_cases(CASES, folder) == []
    assert [width(case, folder) for case in CASES] == pytest.approx([2, 2])


def test_a_result_of_other_source_code_can_be_kept(folder, edited, executor, capsys):
    assert missing_cases(CASES, folder, keep_old=True) == []
    assert run_cases(CASES, folder, executor, keep_old=True, progress=False) == {}
    assert capsys.readouterr().err == ""
    assert width(CASES[0], folder, keep_old=True) == pytest.approx(1)


def test_an_old_file_stays_until_the_new_result_is_there(folder, edited):
    class Full(Executor):
        def submit(self, function, /, *arguments):
            raise MemoryError

    with pytest.raises(MemoryError):
        run_cases(CASES, folder, Full(), progress=False)
    assert width(CASES[0], folder, keep_old=True) == pytest.approx(1)


def test_a_sweep_of_two_source_codes_is_read_with_a_warning(folder, edited, executor):
    assert "source_fingerprint" in load_sweep(folder).attrs
    run_cases(CASES[:1], folder, executor, progress=False)
    with pytest.warns(UserWarning, match="different source code computed these cases"):
        grid = load_sweep(folder)
    assert "source_fingerprint" not in grid.attrs


EDITED = """
import sys
from concurrent.futures import ThreadPoolExecutor
from crazybilliards.comparison.sweeps import Sweep, run_cases
with ThreadPoolExecutor(1) as here:
    run_cases(Sweep({"size": [2]}, "equilibrium", {}, {}), sys.argv[1], here, progress=False)
"""


def test_after_an_edit_of_a_theory_its_sweep_gives_the_new_number(folder, tmp_path_factory):
    """In a copy of the package, as it would be with a developer."""
    place = tmp_path_factory.mktemp("edited")
    package = place / "crazybilliards"
    for room in ("model", "particles", "kinetic", "comparison"):
        shutil.copytree(ROOT / room, package / room, ignore=shutil.ignore_patterns("__pycache__"))
    (package / "__init__.py").touch()
    theory = package / "kinetic" / "exact" / "gibbs_measure.py"
    text = theory.read_text()
    assert text.count('("particle", np.sqrt(') == 1
    theory.write_text(text.replace('("particle", np.sqrt(', '("particle", 2 * np.sqrt('))
    # Coverage is that of the package, and not of its copy.
    unmeasured = {name: value for name, value in os.environ.items() if "COVERAGE" not in name}
    own = {**unmeasured, "PYTHONPATH": str(place), "PYTHONDONTWRITEBYTECODE": "1"}
    done = run(sys.executable, "-c", EDITED, folder, cwd=place, env=own)
    [line] = done.stderr.splitlines()
    assert f"computed 1 cases in {folder}; computing them anew" in line
    with pytest.raises(ValueError, match="computed by other source code"):
        CASES[0].load(folder)
    assert width(CASES[0], folder, keep_old=True) == pytest.approx(2)


# -- parameters -------------------------------------------------------------------------------


def without(name, path):
    """Rewrite a file as if a parameter had not existed when it was written."""
    result = load(path)
    stored = json.loads(result.attrs["case"])
    del stored[name]
    save(result.assign_attrs(case=json.dumps(stored)), path)


@pytest.mark.parametrize("name", ["spring", "merging", "mass_ratio"])
def test_parameters_that_a_file_lacks_are_at_their_defaults(name, executor, tmp_path):
    """A parameter of the chain, and a setting of the job."""
    cases = [
        Case("simulate", Chain(size=size), {"duration": 100, "observe": ["widths"]})
        for size in (2, 3)
    ]
    assert run_cases(cases, tmp_path, executor, progress=False) == {}
    before = load_sweep(tmp_path)
    without(name, cases[0].file(tmp_path))
    assert missing_cases(cases, tmp_path) == []
    assert load_sweep(tmp_path).identical(before)


def test_a_file_that_lacks_a_parameter_is_not_that_of_another_value(tmp_path):
    case = Case("equilibrium", Chain(size=2, gap=1), {})
    write_sealed(case.file(tmp_path), compute(case, case.source))
    without("gap", case.file(tmp_path))
    with pytest.raises(ValueError, match="not the case that its name says"):
        case.load(tmp_path)


def test_two_files_of_one_case_are_refused_by_name(folder):
    name = CASES[0].file(folder)
    shutil.copy(name, folder / "copy.nc")
    with pytest.raises(ValueError, match=rf"{name.name} and .*copy\.nc: hold the same case"):
        load_sweep(folder)


def test_parameters_that_nobody_knows_are_refused(folder):
    path = CASES[0].file(folder)
    result = load(path)
    stored = json.loads(result.attrs["case"]) | {"colour": "red"}
    save(result.assign_attrs(case=json.dumps(stored)), path)
    with pytest.raises(ValueError, match=r"\.nc: only one of them has 'colour'"):
        load_sweep(folder)
