"""Draw the rooms, their folders and their imports of each other, from the imports of all modules.

Run it to write architecture.svg beside it. The tests use these imports too, and check that the
picture shows them.
"""

import ast
from functools import cache
from pathlib import Path

from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

ROOT = Path(__file__).parents[2]
PICTURE = Path(__file__).with_suffix(".svg")
# name: (left, bottom, width, height, colour)
ROOMS = {
    "apps": (0.0, 20.5, 12.0, 2.3, "#E4DDF3"),
    "reproduction": (0.0, 17.5, 12.0, 2.7, "#F9DCD0"),
    "comparison": (0.0, 12.3, 12.0, 4.9, "#F6DDEB"),
    "particles": (0.0, 4.9, 5.9, 7.0, "#D5E8F5"),
    "kinetic": (6.1, 4.9, 5.9, 7.0, "#FBE8C3"),
    "model": (0.0, 0.0, 12.0, 4.5, "#D4EFE6"),
}
# From, to, where along the line.
BETWEEN_ROOMS = (
    ("apps", "reproduction", 6.0),
    ("reproduction", "comparison", 6.0),
    ("comparison", "particles", 3.0),
    ("comparison", "kinetic", 9.0),
    ("particles", "model", 3.0),
    ("kinetic", "model", 9.0),
)
ARROW = {"arrowstyle": "-|>", "color": "0.35", "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}

Graph = dict[str, set[str]]


def modules() -> dict[str, Path]:
    """Return every module of the rooms by its name, without ``crazybilliards.``."""
    names = {}
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob("*.py")):
            parts = path.relative_to(ROOT).with_suffix("").parts
            names[".".join(parts).removesuffix(".__init__")] = path
    return names


@cache
def imports() -> Graph:
    """Return what every module imports of the package, those within functions too."""
    known = modules()
    return {name: _imported(path, known) for name, path in known.items()}


def _imported(path: Path, known: dict[str, Path]) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.ImportFrom):
            continue
        package, _, source = (node.module or "").partition(".")
        if package == "crazybilliards" and source:
            for alias in node.names:
                inner = f"{source}.{alias.name}"
                found.add(inner if inner in known else source)
    return found


def unit(module: str) -> str:
    """Return the folder of a room that a module lies in, or itself."""
    return ".".join(module.split(".")[:2])


def unit_imports(room: str) -> Graph:
    """Return which folders and modules of a room import which others of the room."""
    graph: Graph = {}
    for module, imported in imports().items():
        if module.startswith(f"{room}."):
            others = {unit(each) for each in imported if each.startswith(f"{room}.")}
            graph.setdefault(unit(module), set()).update(others - {unit(module)})
    return graph


def levels(graph: Graph) -> dict[str, int]:
    """Return how far above the ground each unit stands: one more than the highest it imports."""
    heights: dict[str, int] = {}

    def height(name: str) -> int:
        if name not in heights:
            heights[name] = max((height(below) + 1 for below in graph[name]), default=0)
        return heights[name]

    return {name: height(name) for name in graph}


def _direct(graph: Graph) -> Graph:
    """Leave out arrows that a way over others replaces."""

    def below(name: str) -> set[str]:
        return graph[name].union(*(below(each) for each in graph[name]))

    return {
        name: targets - set().union(*(below(each) for each in targets))
        for name, targets in graph.items()
    }


def draw() -> Figure:
    """Return the figure."""
    figure = Figure(figsize=(8.6, 15.2), layout="constrained")
    ax = figure.subplots()
    ax.set(xlim=(-0.1, 12.1), ylim=(-0.1, 22.9))
    ax.axis("off")
    for room, (left, bottom, width, height, colour) in ROOMS.items():
        _box(ax, left, bottom, width, height, colour)
        ax.text(left + 0.25, bottom + height - 0.3, room, va="top", size=13, weight="bold")
        _draw_units(ax, room)
    for upper, lower, x in BETWEEN_ROOMS:
        top, bottom = ROOMS[upper][1], ROOMS[lower][1] + ROOMS[lower][3]
        ax.annotate("", (x, bottom), (x, top), arrowprops=ARROW | {"linewidth": 2.0})
    return figure


def _draw_units(ax: Axes, room: str) -> None:
    left, bottom, width, height, _ = ROOMS[room]
    graph = unit_imports(room)
    level = levels(graph)
    floors = max(level.values()) + 1
    widest, half_high, margin = 0.74, 0.19, 0.3
    usable = width - 2 * margin
    places, half_wide = {}, {}
    for floor in range(floors):
        names = sorted(name for name in graph if level[name] == floor)
        y = bottom + 0.45 + floor * (height - 1.35) / max(floors - 1, 1)
        for number, name in enumerate(names):
            # Rows stand against each other, for arrows to pass between boxes.
            shift = 0.22 * (-1) ** floor
            places[name] = left + margin + (number + 0.5) * usable / len(names) + shift, y
            half_wide[name] = min(widest, 0.46 * usable / len(names))
    for name, targets in _direct(graph).items():
        x, y = places[name]
        for target in sorted(targets):
            end_x, end_y = places[target]
            ax.annotate("", (end_x, end_y + half_high), (x, y - half_high), arrowprops=ARROW)
    for name, (x, y) in places.items():
        folder = (ROOT / name.replace(".", "/")).is_dir()
        box = (x - half_wide[name], y - half_high, 2 * half_wide[name], 2 * half_high)
        _box(ax, *box, "white", edge="0.35" if folder else "0.75", pad=0.02)
        text = name.split(".")[1].replace("_", " ")
        ax.text(
            x,
            y,
            text,
            ha="center",
            va="center",
            size=7.5,
            weight="bold" if folder else "normal",
            zorder=4,
        )


def _box(
    ax: Axes,
    left: float,
    bottom: float,
    width: float,
    height: float,
    colour: str,
    edge: str = "0.35",
    pad: float = 0.1,
) -> None:
    corner = (left + pad, bottom + pad)
    ax.add_patch(
        FancyBboxPatch(
            corner,
            width - 2 * pad,
            height - 2 * pad,
            boxstyle=f"round,pad={pad}",
            facecolor=colour,
            edgecolor=edge,
            zorder=1 if colour != "white" else 3,
        )
    )


def described() -> str:
    """Return what the picture shows, as it stands in the file."""
    return "; ".join(
        f"{name}: {' '.join(sorted(targets))}"
        for room in ROOMS
        for name, targets in sorted(_direct(unit_imports(room)).items())
    )


def write(path: Path) -> None:
    """Write the picture, the same every time: no date, no random names."""
    with style.context(["default", {"svg.hashsalt": "crazybilliards"}]):
        metadata = {"Date": None, "Description": described()}
        draw().savefig(path, metadata=metadata)


if __name__ == "__main__":
    write(PICTURE)
