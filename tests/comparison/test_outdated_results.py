"""Results of other source code are computed anew, and new parameters leave old results valid."""

import json
import warnings
from concurrent.futures import Executor

import pytest
from small_sweeps import missing_cases

from crazybilliards.comparison import load_sweep
from crazybilliards.comparison.sweeps import Case, case, run_cases
from crazybilliards.comparison.sweeps.case import compute
from crazybilliards.kinetic import equilibrium
from crazybilliards.model import Chain, fingerprint, load, save
from crazybilliards.model.fingerprint import room_fingerprint
from crazybilliards.model.storage import write_sealed

CASES = [Case("equilibrium", Chain(size=size), {}) for size in (2, 3)]
QUIET = {"progress": False}


@pytest.fixture
def folder(tmp_path):
    """Return a folder with the results of the cases."""
    for each in CASES:
        write_sealed(each.file(tmp_path), compute(each, each.source))
    return tmp_path


@pytest.fixture
def edited(monkeypatch):
    """Let the exact equilibrium be one whose velocity widths are twice as large."""

    def doubled(chain):
        result = equilibrium(chain)
        return result.assign(velocity_width=2 * result.velocity_width)

    monkeypatch.setitem(case.JOBS, "equilibrium", doubled)
    monkeypatch.setitem(case._SOURCES, "equilibrium", "other source code")


def width(case, folder):
    return float(case.load(folder).velocity_width[0]) / case.chain.free_velocity_width


# -- source code ------------------------------------------------------------------------------


def test_a_result_of_other_source_code_is_kept_on_request_and_otherwise_computed_anew(
    folder, edited
):
    assert missing_cases(CASES, folder, keep_old=True) == []
    with warnings.catch_warnings(action="error"):
        assert run_cases(CASES, folder, keep_old=True, **QUIET) == {}
    assert width(CASES[0], folder) == pytest.approx(1)
    assert missing_cases(CASES, folder) == CASES
    with pytest.warns(UserWarning, match="computing it anew, and others like it .*--keep-old"):
        assert run_cases(CASES, folder, **QUIET) == {}
    assert missing_cases(CASES, folder) == []
    assert [width(each, folder) for each in CASES] == pytest.approx([2, 2])


@pytest.mark.filterwarnings("ignore:.*computing it anew")
def test_an_old_file_stays_until_the_new_result_is_there(folder, edited):
    class Full(Executor):
        def submit(self, function, /, *arguments):
            raise MemoryError

    with pytest.raises(MemoryError):
        run_cases(CASES, folder, Full(), **QUIET)
    assert width(CASES[0], folder) == pytest.approx(1)


@pytest.mark.filterwarnings("ignore:.*computing it anew")
def test_a_sweep_of_two_source_codes_is_read_with_a_warning(folder, edited):
    assert "source_fingerprint" in load_sweep(folder).attrs
    run_cases(CASES[:1], folder, **QUIET)
    with pytest.warns(UserWarning, match="different source code computed these cases"):
        grid = load_sweep(folder)
    assert "source_fingerprint" not in grid.attrs


def test_an_edit_of_a_room_is_other_source_code(tmp_path, monkeypatch):
    monkeypatch.setattr(fingerprint, "_ROOT", tmp_path)
    folder, prints = tmp_path / "kinetic" / "gas", []
    folder.mkdir(parents=True)
    for name, text in (("gas.py", "width = 1"), ("page.md", "a text"), ("gas.py", "width = 2")):
        (folder / name).write_text(text)
        prints.append(room_fingerprint.__wrapped__("model", "kinetic"))
    assert prints[0] == prints[1] != prints[2]


# -- parameters -------------------------------------------------------------------------------


def without(name, path):
    """Rewrite a file as if a parameter had not existed when it was written."""
    result = load(path)
    stored = json.loads(result.attrs["case"])
    del stored[name]
    save(result.assign_attrs(case=json.dumps(stored)), path)


def test_parameters_that_a_file_lacks_are_at_their_defaults(tmp_path):
    """A parameter of the chain, and a setting of the job."""
    cases = [
        Case("simulate", Chain(size=size), {"duration": 100, "observe": ["widths"]})
        for size in (2, 3)
    ]
    assert run_cases(cases, tmp_path, **QUIET) == {}
    before = load_sweep(tmp_path)
    for name in ("spring", "merging", "mass_ratio"):
        without(name, cases[0].file(tmp_path))
        assert missing_cases(cases, tmp_path) == []
        assert load_sweep(tmp_path).identical(before)


def test_a_file_that_lacks_a_parameter_is_not_that_of_another_value(tmp_path):
    case = Case("equilibrium", Chain(size=2, gap=1), {})
    write_sealed(case.file(tmp_path), compute(case, case.source))
    without("gap", case.file(tmp_path))
    with pytest.raises(ValueError, match="not the case that its name says"):
        case.load(tmp_path)


def test_two_files_of_one_case_and_a_parameter_that_some_files_have_are_refused(folder):
    path = CASES[0].file(folder)
    result = load(path)
    stored = json.loads(result.attrs["case"]) | {"colour": "red"}
    for file, changed, said in (
        (folder / "copy.nc", result, "two files hold the same case"),
        (path, result.assign_attrs(case=json.dumps(stored)), "not all cases have .* colour"),
    ):
        save(changed, file)
        with pytest.raises(ValueError, match=said):
            load_sweep(folder)
        file.unlink()
