"""What a program can check of the prose: phrases to avoid, long sentences, links, citations.

Prose linters were tried. Of the findings of proselint on these pages nearly all were quotes in
code and the word "resume". vale downloads its program when it is first used. Neither knows the
phrases that readers of this project stumbled over, so those are listed here.
"""

import ast
import re
from pathlib import Path

import jupytext
import pytest

import crazybilliards as cb

ROOT = Path(__file__).parents[1]
ROOMS = ("api", "model", "particles", "kinetic", "comparison", "reproduction", "apps")
WRITTEN_BY_A_PROGRAM = ROOT / "docs" / "paper" / "claims.md"
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "paper.md",
    *(page for page in sorted((ROOT / "docs").rglob("*.md")) if page != WRITTEN_BY_A_PROGRAM),
]
LESSONS = sorted((ROOT / "notebooks").glob("[0-9]*.py"))
MODULES = [path for room in ROOMS for path in sorted((ROOT / room).rglob("*.py"))]
AVOID = {
    r"\boff (restitution|\$?e\b)": "for e != 1",
    r"\bwhoever\b": "name the person or thing",
    r"\bwhat is left\b": "the remaining error, the rest",
    r", say\b|\bsay\)": "for example",
    r"\b(take|takes|taken|took) (\w+ )?down\b": "record",
    r"\b(gives|gave|given) up\b": "stops",
    r"\bdearer\b": "more expensive",
    r"\bfor certain\b": "leave it out",
    r"\b(that|which) (is|are) none\b": "say what it is not",
    r"\bone's own\b": "your own",
    r"\bof today\b": "current",
    r"\bwhat about grants\b": "tolerance",
    r"\bno script\b": "name the command that prints the number, or leave the number out",
}
MOST_WORDS = 45


def plain(text):
    """Return a page without code, formulas, tables, and the targets of links."""
    text = re.sub(r"\A---\n.*?\n---\n", "", text, flags=re.DOTALL)
    text = re.sub(r"```.*?```|\$\$.*?\$\$", "\n\n", text, flags=re.DOTALL)
    text = re.sub(r"^ *\|.*$", "", text, flags=re.MULTILINE)
    text = re.sub(r"`[^`]*`|\$[^$]*\$", "X", text)
    return re.sub(r"\]\([^)]*\)", "]", text)


def sentences(text):
    for paragraph in re.split(r"\n\s*\n|\n\s*(?:[*-]|\d+\.|:) |\n#+ ", text):
        yield from re.split(r"(?<=[.!?:;])[*)]*\s+", " ".join(paragraph.split()))


def found(text):
    return {
        f"{match[0]!r}: {better}"
        for phrase, better in AVOID.items()
        for match in re.finditer(phrase, " ".join(text.split()), re.IGNORECASE)
    }


def named(path):
    return path.relative_to(ROOT).as_posix()


def text_of(page):
    if page not in LESSONS:
        return page.read_text(encoding="utf-8")
    cells = jupytext.read(page).cells
    text = "\n\n".join(cell.source for cell in cells if cell.cell_type == "markdown")
    return re.sub(r"</?(details|summary)>", "\n\n", text)


def offenders(files, complaints):
    """Return what there is to complain of in every file that is not as it should be."""
    return {named(file): said for file in files if (said := complaints(file))}


def test_pages_are_plain():
    assert not offenders(PAGES + LESSONS, lambda page: found(plain(text_of(page))))


def test_sentences_are_short():
    def too_long(page):
        every = sentences(plain(text_of(page)))
        return [each for each in every if len(re.findall("[A-Za-z]{2,}", each)) > MOST_WORDS]

    assert not offenders(PAGES + LESSONS, too_long)


def test_markdown_shows_all_of_a_page():
    """A line that begins with a per cent sign would be a comment, and <dx> a tag."""

    def hidden(page):
        text = re.sub(r"```.*?```|\$\$.*?\$\$", "", text_of(page), flags=re.DOTALL)
        text = re.sub(r"`[^`]*`|\$[^$]*\$", "X", text)
        comments = re.findall(r"^ *%.*", text, re.MULTILINE)
        return comments + re.findall(r"<(?!br>)[A-Za-z]\w*>", text)

    assert not offenders(PAGES + LESSONS, hidden)


def test_newcomers_see_one_way_to_import():
    """``import crazybilliards as cb`` and ``cb.simulate``; a room only for what cb has not."""

    def taken_from_rooms(page):
        found = re.findall(
            r"^\W*from crazybilliards[\w.]* import (\([^)]*\)|.*)",
            page.read_text(encoding="utf-8"),
            re.MULTILINE,
        )
        return set(cb.__all__).intersection(re.findall(r"\w+", " ".join(found)))

    assert not offenders(PAGES + LESSONS, taken_from_rooms)


def test_docstrings_are_plain():
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef)

    def complaints(module):
        nodes = ast.walk(ast.parse(module.read_text(encoding="utf-8")))
        docstrings = [ast.get_docstring(node) for node in nodes if isinstance(node, kinds)]
        return found("\n".join(filter(None, docstrings)))

    assert not offenders(MODULES, complaints)


@pytest.mark.parametrize("page", ["README.md", "CONTRIBUTING.md"])
def test_links_of_the_front_pages_lead_somewhere(page):
    """Sphinx checks the links of docs/ only."""
    targets = re.findall(r"\]\((?!http)([^)#]+)", (ROOT / page).read_text(encoding="utf-8"))
    assert targets
    assert not [target for target in targets if not (ROOT / target).exists()]


def test_the_draft_of_the_paper_cites_what_its_bibliography_holds():
    cited = set(re.findall(r"@(\w+)", (ROOT / "paper.md").read_text(encoding="utf-8")))
    entries = re.findall(r"^@\w+\{(\w+),", (ROOT / "paper.bib").read_text(), re.MULTILINE)
    assert cited == set(entries)
    assert len(entries) == len(set(entries))
