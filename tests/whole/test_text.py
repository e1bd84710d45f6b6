"""What no other tool finds in the texts: stale numbers, dead names, text that is not shown.

Sphinx checks the links of the documentation.
"""

import re
from html import escape
from pkgutil import resolve_name

import jupytext
import pandas as pd
import pytest
import qr_code
from installation import FOLDERS, ROOT

import crazybilliards as cb
from crazybilliards.comparison.stationary_theories import TITLES
from crazybilliards.model.vocabulary import VOCABULARY
from crazybilliards.reproduction.figures import FIGURES

FRONT = sorted({*ROOT.glob("*.md"), *ROOT.glob(".github/*.md")} - {ROOT / "CHANGELOG.md"})
PAGES = [*FRONT, *sorted((ROOT / "docs").rglob("*.md"))]
CODE = (*FOLDERS, "benchmarks", "docs", "notebooks", "studies")
LESSONS = [path.with_suffix(".py") for path in sorted((ROOT / "notebooks").glob("*.ipynb"))]


def words(page):
    return " ".join((ROOT / page).read_text(encoding="utf-8").split())


def test_the_draft_of_the_paper_counts_the_claims_as_their_page_does():
    [counts] = re.findall(r"Statements of the paper: (.*?) \|", words("docs/paper/claims.md"))
    number = {name: int(count) for count, name in re.findall(r"(\d+) ([a-z ]+)", counts)}
    total, held, failed = sum(number.values()), number["reproduced"], number["not reproduced"]
    sentence = f"Of {total} statements {held} are reproduced, {failed} are not"
    assert sentence in words("docs/paper/paper.md")


def test_the_errors_of_the_gas_are_those_that_were_measured():
    _, shown = (ROOT / "docs/gas.md").read_text(encoding="utf-8").split("\n| chains | ")
    rows = [line.split("|")[1:-1] for line in shown.split("\n\n")[0].splitlines()[2:]]
    measured = pd.read_csv(ROOT / "kinetic/measured/steady_state.csv")
    weakly = (measured.kind == "driven") & (measured.Gamma < 0.5)
    kinds = ["linear", "gap", "quadratic", "box", "gas in a box", "inelastic walls"]
    chains = dict(iter(measured.groupby(measured.kind.mask(weakly, "weakly driven"))))
    for kind, (name, *cells) in zip([*kinds, "weakly driven", "driven"], rows, strict=True):
        errors = 100 * chains.pop(kind).loc[:, "velocity_width":].dropna(axis=1, how="all")
        told = [f"{error.median():.1f} ({error.max():.0f})" for _, error in errors.items()]
        assert f"({len(errors)})" in name
        assert [cell.strip() for cell in cells if cell.strip()] == told
    assert not chains


def test_a_file_that_code_or_a_front_page_names_exists():
    named = re.compile(r"(?<![\w./-])(?:docs|studies|benchmarks|notebooks)/[\w/-]+\.\w+")
    script = re.compile(r"python\s+-m\s+(studies\.\w+)")
    link = re.compile(r"\]\((?!http|#)([^)#\s]+)")
    dead = []
    for file in [*FRONT, *(path for folder in CODE for path in (ROOT / folder).rglob("*.*"))]:
        if file.suffix not in {".py", ".md", ".js", ".toml"} or "docs/notebooks" in str(file):
            continue
        text = file.read_text(encoding="utf-8")
        targets = [f"{name.replace('.', '/')}.py" for name in script.findall(text)]
        targets += [] if file.suffix == ".md" else named.findall(text)
        targets += [file.parent / name for name in link.findall(text) if file in FRONT]
        dead += [(file.name, name) for name in targets if not (ROOT / name).exists()]
    assert not dead


def test_a_test_that_a_page_names_exists():
    code = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("*.py"))
    named = {name for page in PAGES for name in re.findall(r"`(test_\w+)`", words(page))}
    assert named
    assert not [name for name in named if f"def {name}(" not in code]


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
    text, sources = ((ROOT / f"docs/paper/paper.{end}").read_text("utf-8") for end in ("md", "bib"))
    cited, entries = re.findall(r"@(\w+)", text), re.findall(r"(?m)^@\w+\{(\w+),", sources)
    assert sorted(set(cited)) == sorted(entries)


@pytest.mark.compiled
@pytest.mark.validate
@pytest.mark.parametrize("end", ["# Continuity", pytest.param(None, marks=pytest.mark.torture)])
def test_the_sixty_lines_give_what_their_page_says(tmp_path, monkeypatch, capsys, end):
    """As far as they use this package; the fluid of py-pde, which takes long, under torture."""
    monkeypatch.chdir(tmp_path)
    exec((ROOT / "docs/paper/sixty_lines.py").read_text("utf-8").split(end or "\0")[0], {})
    found = re.findall(r"at most (\S+) of close packing", capsys.readouterr().out)
    assert 0.03 < float(found[0]) < 0.045
    assert end or (tmp_path / "sixty_lines.png").exists()


# -- the concordance --------------------------------------------------------------------------

CONCORDANCE = (ROOT / "docs/paper/concordance.md").read_text(encoding="utf-8")


def rows(heading):
    """Return the section of a heading, and the first cells of its table."""
    section = CONCORDANCE.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("|")]
    return section, [line.split("|")[1] for line in lines[2:]]


def test_the_concordance_names_what_exists():
    for name in set(re.findall(rf"`((?:{'|'.join(FOLDERS)})(?:\.\w+)+)`", CONCORDANCE)):
        resolve_name(f"crazybilliards.{name}")
    assert VOCABULARY.keys() >= {*re.findall(r"(?:variable|coordinate)s? `(\w+)`", CONCORDANCE)}


def test_the_concordance_has_every_equation_and_figure():
    numbers = []
    for cell in rows("Equations")[1]:
        data = [int(number) for number in re.findall(r"\((\d+)\)", cell)]
        whole = re.fullmatch(r"\(\d+\) to \(\d+\)", re.sub(r"`.*`", "", cell).strip())
        numbers += range(data[0], data[1] + 1) if whole else data
    assert numbers == list(range(1, 53))
    section, cells = rows("Figures")
    assert [int(cell.split()[0]) for cell in cells] == [figure.number for figure in FIGURES]
    names = re.findall(r"^\| \d+ `[^|]* \| `([\w-]+)`", section, re.MULTILINE)
    assert names == [figure.name for figure in FIGURES]


def test_links_to_settings_of_the_chain_name_what_it_has():
    """Sphinx does not check an address with a setting, chain.html#size=2."""
    page = (ROOT / "apps/explore/page/chain.html").read_text(encoding="utf-8")
    texts = "".join(path.read_text(encoding="utf-8") for path in PAGES + LESSONS)
    settings = re.findall(r'href="(?:chain\.html|\.\./docs/chain\.md)#([^"]*)"', texts)
    given = [part.split("=") for text in settings for part in re.split("&amp;|&", text)]
    assert given
    for name, value in given:
        is_one_of = {"challenge": f'"challenge-{value}"', "preset": f'value="{value}"'}
        assert is_one_of.get(name, f'data-chain="{name}"') in page, (name, value)


def test_the_qr_code_leads_to_the_documentation_that_the_project_names():
    """If it does not, draw it again: python docs/figures/qr_code.py."""
    picture = (ROOT / "docs/figures/qr_code.svg").read_text(encoding="utf-8")
    assert f"<title>{escape(qr_code.address())}</title>" in picture


@pytest.mark.compiled
def test_the_script_of_the_readme_draws_its_picture_with_our_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    _, begun = (ROOT / "README.md").read_text("utf-8").split("```python\n")
    exec(begun.partition("```")[0], made := {})
    assert (tmp_path / "density.png").read_bytes().startswith(b"\x89PNG")
    assert set(made["results"]) <= set(TITLES.values())
