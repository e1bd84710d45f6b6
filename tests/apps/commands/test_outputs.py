"""Where commands write to: a wrong place costs no work, and what is written arrives whole."""

import json
import os
import warnings
from contextlib import nullcontext
from dataclasses import asdict
from itertools import product

import pytest
from forked import command, forked
from rich.table import Table
from small_sweeps import AtOnce

from crazybilliards.apps.commands import sweep
from crazybilliards.apps.commands.answers import print_table
from crazybilliards.comparison.distances import deviations
from crazybilliards.comparison.side_by_side.relaxation import label_distances
from crazybilliards.model import load
from crazybilliards.model.locks import locked

SMALL = {
    "compare": ["--size", "4", "--duration", "300", "--amplitude", "10"],
    "relax": ["--size", "4", "--duration", "1", "--replicas", "2", "--every", "1"],
    "reproduce": ["1"],
    "simulate": ["--size", "4", "--duration", "100"],
    "theory": ["equilibrium", "--size", "4"],
}
FOLDERS = ["compare", "relax", "reproduce", "theory"]
ALONE = ["reproduce", "simulate", "sweep", "theory"]  # quick enough to be done apart


@pytest.fixture
def arguments(tmp_path):
    """Give a small job of a command; the sweep is that of one case in one process."""
    grid = tmp_path / "grid.toml"
    grid.write_text("[grid]\nsize = [3]\n[simulate]\nduration = 100\n")
    return lambda name: [name, *(SMALL | {"sweep": [grid, "--processes", "1"]})[name]]


@pytest.mark.posix
@pytest.mark.parametrize("name", [*SMALL, "sweep"])
def test_an_empty_name_a_dead_link_and_a_file_are_no_folders(name, arguments, refused, tmp_path):
    refused("an empty name", *arguments(name), "--output", "")
    link, file = tmp_path / "link", tmp_path / "file"
    link.symlink_to(tmp_path / "nothing")
    file.write_text("mine")
    for place in (link, link / "below"):
        refused(f"{link} is a link that leads nowhere", *arguments(name), "--output", place)
    refused(f"{file} is a file", *arguments(name), "--output", file)
    assert file.read_text() == "mine"


@pytest.mark.parametrize("name", [*FOLDERS, "sweep"])
def test_a_folder_belongs_to_one_process_at_a_time(name, arguments, run, tmp_path):
    folder = tmp_path / "results"
    folder.mkdir()
    with locked(folder):
        done = run(*arguments(name), "--output", folder)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
    assert f"{folder}: in use by process {os.getpid()}" in done.stderr
    assert list(folder.iterdir()) == []


def test_a_file_belongs_to_one_process_at_a_time(arguments, refused, run, tmp_path):
    file = tmp_path / "run.nc"
    with locked(file):
        refused(f"{file}: in use by process", *arguments("simulate"), "--output", file)
    assert run(*arguments("simulate"), "--output", file).returncode == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["grid.toml", "run.nc"]


@pytest.mark.usefixtures("sketched")
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is full")
def test_a_reader_that_goes_and_a_full_disk_cost_no_work(arguments, tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    full = "crazybilliards: error: standard output: No space left on device\n"
    for output, ends in ((writing, (141, "")), ("/dev/full", (2, full))):
        with open(output, "w") as stdout:
            done = forked(command(*arguments("theory"), "--output", tmp_path), stdout=stdout)
        assert (done.returncode, done.stderr) == ends
        for name in ("theory.nc", "density.png", "profile.png"):
            (tmp_path / name).unlink()


@pytest.mark.usefixtures("sketched")
@pytest.mark.posix
@pytest.mark.parametrize(
    ("name", "closed"), [*product(ALONE, [(0, 1, 2)]), ("theory", (1,)), ("theory", (2,))]
)
def test_a_closed_stream_costs_no_work(name, closed, arguments, tmp_path):
    output = tmp_path / ("run.nc" if name == "simulate" else "results")
    done = forked(command(*arguments(name), "--output", output), closed=closed)
    assert (done.returncode, done.stderr) == (0, "")
    assert output.exists()


def test_numbers_in_tables_are_never_cut(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "30")
    table = Table(title="A long title of a table that wraps", caption="A caption that wraps too")
    numbers = ["0.001234 +- 0.0005", "123456789.0123", "-1.234e-300", "4.17 / 1.58"]
    for number in numbers:
        table.add_column(f"a long heading [of {len(number)} words]", justify="right")
    table.add_row(*numbers)
    print_table(table)
    printed = capsys.readouterr().out
    assert all(number in printed for number in numbers)
    assert "…" not in printed
    assert "[of" in printed


def test_a_long_title_and_caption_use_the_width_of_the_terminal(monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "80")
    title = "Density: simulation minus theory, in % of close packing"
    table = Table("a", title=title, caption="Smoothed as in the paper; [sigma] is a unit.")
    table.add_row("1")
    print_table(table)
    lines = capsys.readouterr().out.splitlines()
    assert (lines[0], lines[-1]) == (title, "Smoothed as in the paper; [sigma] is a unit.")


@pytest.mark.usefixtures("sketched")
@pytest.mark.compiled
@pytest.mark.parametrize("name", [*SMALL, "sweep"])
def test_json_is_one_object_with_every_file_written(name, arguments, run, tmp_path, monkeypatch):
    """Numbers in full, as the functions return them; nothing else on standard output."""
    monkeypatch.setattr(sweep, "engine", lambda *_: nullcontext(AtOnce()))
    folder = tmp_path / "results"
    output = tmp_path / "run.nc" if name == "simulate" else folder
    done = run(*arguments(name), "--json", "--output", output)
    assert done.returncode == 0, done.stderr
    facts = json.loads(done.stdout)
    if name == "sweep":
        assert facts == {"cases": 1, "folder": str(folder), "computed": 1, "failed": []}
        return
    there = [output] if name == "simulate" else folder.glob("*.*")
    assert sorted(facts["written"]) == sorted(map(str, there))
    if name == "simulate":
        [first, *_] = facts["rods"]
        run_file = load(output)
        assert first["velocity_width"] == float(run_file.velocity_width[0])
        assert first["velocity_width_error"] == float(run_file.velocity_width_error[0])
        assert (facts["status"], facts["end_time"]) == ("completed", run_file.attrs["end_time"])
    if name == "theory":
        assert facts["velocity_width_model_error"] == facts["density_model_error"] == 0
    if name == "compare":
        tree = load(folder / "comparison.nc")
        [exact] = [row for row in facts["deviations"] if row["theory"] == "equilibrium"]
        found = deviations(tree["amplitude_10"])["equilibrium"]
        assert exact["amplitude"] == 10
        for name, value in asdict(found.density).items():
            assert exact[f"density_{name}"] == value
        for name, value in found.velocity_width._asdict().items():
            assert exact[f"velocity_width_{name}"] == value
    if name == "relax":
        found = {row["theory"]: row["distance"] for row in facts["distances"]}
        assert found == label_distances(load(folder / "relaxation.nc"))


def test_a_warning_is_one_plain_line(run):
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        done = run("compare", "--size", "3", "--amplitude", "0.1", "--duration", "2000")
    assert done.returncode == 0
    lines = [line for line in done.stderr.splitlines() if "compiling" not in line]
    (line,) = lines
    assert line.startswith("crazybilliards: warning: A = 0.1 has no arctanh fit: ")
