"""What no other tool finds in the texts: dead paths in code, text that is not shown, other imports.

Sphinx checks the links of the documentation. How a text is written says CONTRIBUTING.md.
"""

import re
from pathlib import Path

import jupytext

import crazybilliards as cb

ROOT = Path(__file__).parents[1]
FRONT = sorted(ROOT.glob("*.md"))
PAGES = [*FRONT, *sorted((ROOT / "docs").rglob("*.md"))]
ROOMS = ("api", "model", "particles", "kinetic", "comparison", "reproduction", "apps")
CODE = (*ROOMS, "benchmarks", "docs", "notebooks", "studies")
LESSONS = sorted((ROOT / "notebooks").glob("[0-9]*.py"))


def test_a_file_that_code_or_a_front_page_names_exists():
    named = re.compile(r"(?<![\w./-])(?:docs|studies|benchmarks|notebooks)/[\w/-]+\.\w+")
    command = re.compile(r"python\s+(?:-m\s+studies\.\w+|(?:benchmarks|docs/figures)/\S+?\.py)")
    link = re.compile(r"\]\((?!http|#)([^)#\s]+)")
    module = re.compile(r":mod:`(\.+)([\w.]+)`")
    dead = []
    for file in [*FRONT, *(path for folder in CODE for path in (ROOT / folder).rglob("*.*"))]:
        if file.suffix not in {".py", ".md", ".js", ".toml"} or "docs/notebooks" in str(file):
            continue
        text = file.read_text(encoding="utf-8")
        targets = [] if file.suffix == ".md" else named.findall(text)
        targets += link.findall(text) if file in FRONT else []
        for each in command.findall(text):
            script = each.split()[-1]
            targets.append(script if "/" in script else f"{script.replace('.', '/')}.py")
        dead += [(file.name, each) for each in targets if not (ROOT / each).exists()]
        for dots, name in module.findall(text):
            path = file.parents[len(dots) - 1] / name.replace(".", "/")
            dead += [] if path.is_dir() or path.with_suffix(".py").exists() else [(file.name, name)]
    assert not dead


def test_markdown_shows_all_of_a_page():
    """A line that begins with a per cent sign would be a comment, and <dx> a tag."""
    for page in PAGES + LESSONS:
        cells = jupytext.read(page).cells if page in LESSONS else []
        text = "\n\n".join(cell.source for cell in cells if cell.cell_type == "markdown")
        text = re.sub(r"```.*?```|\$\$.*?\$\$", "", text or page.read_text(), flags=re.DOTALL)
        text = re.sub(r"`[^`]*`|\$[^$]*\$", "X", text)
        assert not re.findall(
            r"^ *%.*|<(?!br>|/?details|/?summary)[A-Za-z]\w*>", text, re.MULTILINE
        )


def test_newcomers_see_one_way_to_import():
    """``import crazybilliards as cb`` and ``cb.simulate``; a room only for what cb has not."""
    taken = re.compile(r"^\W*from crazybilliards[\w.]* import (\([^)]*\)|.*)", re.MULTILINE)
    for page in PAGES + LESSONS:
        names = re.findall(r"\w+", " ".join(taken.findall(page.read_text(encoding="utf-8"))))
        assert not set(cb.__all__).intersection(names), page


def test_the_draft_of_the_paper_cites_what_its_bibliography_holds():
    cited = set(re.findall(r"@(\w+)", (ROOT / "paper.md").read_text(encoding="utf-8")))
    entries = re.findall(r"^@\w+\{(\w+),", (ROOT / "paper.bib").read_text(), re.MULTILINE)
    assert sorted(cited) == sorted(entries)
