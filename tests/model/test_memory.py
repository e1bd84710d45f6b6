"""What would not fit into memory is refused, with both numbers."""

import math
from types import SimpleNamespace

import psutil
import pytest

from crazybilliards.kinetic import phase_space
from crazybilliards.model import Chain
from crazybilliards.model.memory import available_memory, require_memory


def test_available_memory_is_that_of_a_computer():
    assert 2**20 < available_memory() < 2**60


@pytest.fixture(params=[math.inf])
def groups(tmp_path, monkeypatch, request):
    """Write a tree of control groups, /proc with it, and read it on a machine with much memory."""
    machine = SimpleNamespace(available=request.param)
    monkeypatch.setattr(psutil, "virtual_memory", lambda: machine)

    def read(membership, **files):
        (tmp_path / "proc/self").mkdir(parents=True)
        (tmp_path / "proc/self/cgroup").write_text(membership)
        for name, content in files.items():
            file = tmp_path / "sys/fs/cgroup" / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(content)
        return available_memory(tmp_path)

    return read


def group(path, limit, used, cached):
    """Return the three files of a group."""
    values = {"max": limit, "current": used, "stat": f"file 1\ninactive_file {cached}"}
    return {f"{path}/memory.{name}": f"{value}\n" for name, value in values.items()}


LIMITED = {
    "what can be dropped is left": ("0::/job\n", group("job", 1000, 400, 150), 750),
    "the tightest of those around": (
        "0::/a/b/c\n",
        group("a", 1000, 900, 0)
        | group("a/b", "max", 500, 0)
        | group("a/b/c", 800, 300, 0)
        | group("other", 10, 5, 0),
        100,
    ),
    # A container sees its own group at the top.
    "a container": ("0::/docker/abc\n", group(".", 1000, 400, 0), 600),
    "over its limit": ("0::/job\n", group("job", 1000, 1001, 0), 0),
    "no limit": ("0::/job\n3:cpuset:/job\n", group("job", "max", 400, 0), math.inf),
}


@pytest.mark.parametrize("name", LIMITED)
def test_the_limits_of_groups_count(name, groups):
    membership, files, left = LIMITED[name]
    assert groups(membership, **files) == left


def test_a_group_without_statistics_and_no_groups_at_all(groups, tmp_path):
    files = group("job", 1000, 400, 0)
    del files["job/memory.stat"]
    assert groups("0::/job\n", **files) == 600
    assert available_memory(tmp_path / "not Linux") == math.inf


@pytest.mark.parametrize(("groups", "left"), [(700, 600), (500, 500)], indirect=["groups"])
def test_the_smallest_of_machine_and_groups_is_available(groups, left):
    assert groups("0::/job\n", **group("job", 1000, 400, 0)) == left


def test_the_error_has_both_numbers():
    require_memory("nothing", 0.0)
    with pytest.raises(ValueError, match=r"^size=3 would take 1e\+12 GiB of memory, .* available$"):
        require_memory("size=3", 1e12 * 2**30)


def test_only_the_meshes_that_are_used_are_checked(monkeypatch):
    """22 and 33 cells are enough for a small chain: 44 MB; the next mesh takes 100 MB."""
    monkeypatch.setattr("crazybilliards.model.memory.available_memory", lambda: 5e7)
    assert phase_space(Chain(size=3)).attrs["cells"] == 33
    with pytest.raises(ValueError, match=r"cells=50 would take"):
        phase_space(Chain(size=3), tolerance=1e-12)
    with pytest.raises(ValueError, match=r"cells=40 would take"):
        phase_space(Chain(size=3), cells=40)
