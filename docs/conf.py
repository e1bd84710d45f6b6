"""How the documentation is built: ``make docs``."""

import re
import shutil
import sys
from html import escape
from importlib import import_module
from importlib.metadata import version as version_of
from inspect import unwrap
from pathlib import Path
from runpy import run_path

from docutils.nodes import SkipNode, Text, entry, image, math
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from imagesize import getDPI
from sphinx.util import logging
from sphinx.util.images import get_image_size
from sphinx.util.math import get_node_equation_number

logger = logging.getLogger(__name__)

HERE = Path(__file__).parent
ROOT = HERE.parent

project = "crazybilliards"
author = "The crazybilliards developers"
project_copyright = "The crazybilliards developers"
release = version = version_of(project)

sys.path.insert(0, str(HERE))
extensions = [
    "reference",  # docs/reference.py
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
]
exclude_patterns = ["_static", "**.ipynb_checkpoints", "package_index.md", "paper/paper.md"]
html_theme = "furo"
html_title = f"{project} {release}"
html_theme_options = {"navigation_with_keys": True}
html_static_path = ["_static", "../apps/explore/page"]
html_css_files = ["style.css"]
html_math_renderer = "mathml"
highlight_language = "none"  # of blocks that do not name one: equations, commands

# -- pages -------------------------------------------------------------------------------------

myst_enable_extensions = ["dollarmath", "amsmath", "deflist"]
myst_heading_anchors = 3
myst_dmath_double_inline = True
# Equations are numbered within the numbered pages, so that a number has one meaning everywhere.
numfig = True

# The notebooks come with the outputs that `make notebooks` has given them. Those of the examples in
# the pages lie in a cache. An example that is not there is executed; what fails fails the build.
nb_execution_mode = "cache"
nb_execution_cache_path = str(ROOT / "build" / "pages" / "cache")
nb_execution_excludepatterns = ["notebooks/*"]
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_merge_streams = True
# Sliders need a running notebook. Without one their scripts, from outside, would show nothing.
nb_ipywidgets_js = {}

# Addresses outside are looked at by `sphinx-build -b linkcheck`, links inside by every build.
linkcheck_timeout = 20
linkcheck_retries = 2

# -- reference ---------------------------------------------------------------------------------

autosummary_generate = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # types stand in the signatures
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True


def copy_notebooks() -> None:
    """Bring the executed notebooks below docs/, where Sphinx looks for pages.

    Links to ../docs/ become links to pages, and those with a setting to the chain. A file that has
    not changed is left alone, for Sphinx not to read it again.
    """
    there = HERE / "notebooks"
    there.mkdir(exist_ok=True)
    sources = {path.name: path for path in (ROOT / "build" / "notebooks").glob("*.ipynb")}
    for stale in there.iterdir():
        if stale.name not in sources:
            shutil.rmtree(stale) if stale.is_dir() else stale.unlink()
    for name, source in sources.items():
        text = source.read_text(encoding="utf-8").replace("../docs/chain.md#", "../chain.html#")
        text = text.replace("](../docs/", "](../")
        copy = there / name
        if not copy.exists() or copy.read_text(encoding="utf-8") != text:
            copy.write_text(text, encoding="utf-8")


def pack_lessons() -> None:
    """Offer the lessons without outputs and solutions as one archive, with what they import."""
    there = HERE / "notebooks" / "lessons"
    run_path(str(ROOT / "notebooks" / "without_outputs.py"))["write_copies"](there)
    shutil.make_archive(str(there), "zip", there)
    shutil.rmtree(there)  # Sphinx would take them for pages


def point_to_copies(app, page, source) -> None:
    """Turn links to ../notebooks/, which are right in the repository, into links to the copies.

    Lines that begin ``*On a code host`` stand for included files, which only this build shows.
    """
    source[0] = re.sub(r"^\*On a code host .*\*$", "", source[0], flags=re.MULTILINE)
    if not page.startswith("notebooks/"):
        source[0] = source[0].replace("](../notebooks/", "](notebooks/")
        source[0] = source[0].replace("](../../notebooks/", "](../notebooks/")


def as_restructured_text(app, what, name, thing, options, lines) -> None:
    """Docstrings are plain text: set equations apart, and let no bar or star have a meaning."""
    if what == "property":
        # Otherwise napoleon takes what stands before a colon in the first line for a type. It
        # skips empty lines, but not an empty comment.
        lines[:0] = ["..", ""]
    if what == "module":
        lines[:] = _equations_as_code(lines)
    quoted = False
    for number, line in enumerate(lines):
        quoted = quoted and (not line or line.startswith(" "))
        if not quoted and not line.lstrip().startswith(">>>"):
            # Not within ``literals``.
            parts = re.split(r"(``.*?``)", line)
            parts[::2] = [re.sub(r"\||(?<=\()\*+(?=\))", _escaped, part) for part in parts[::2]]
            lines[number] = "".join(parts)
        quoted = quoted or line.startswith(".. code-block::")


_TOGETHER = re.compile(r"^:ivar (\w+(?:, \w+)+):(.*\n(?: .*\n)*)", re.MULTILINE)


def repeat_fields(app, what, name, thing, options, lines) -> None:
    """Repeat the field of attributes told together, which Sphinx takes for a type and a name."""
    lines[:] = _TOGETHER.sub(
        lambda told: "".join(f":ivar {each}:{told[2]}" for each in told[1].split(", ")),
        "\n".join(lines),
    ).split("\n")


def _equations_as_code(lines: list[str]) -> list[str]:
    """Mark indented blocks after a paragraph, equations or tables, to stay as they are."""
    marked: list[str] = []
    paragraph = ""  # the last line that is not indented
    for number, line in enumerate(lines):
        begins = line.startswith("    ") and number > 0 and not lines[number - 1]
        after_list = re.match(r"\* |\d+\. ", paragraph)
        if begins and paragraph and not after_list:
            marked += [".. code-block:: text", ""]
            paragraph = ""
        elif line and not line.startswith(" "):
            paragraph = line if not (number and lines[number - 1] and paragraph) else paragraph
        marked.append(line)
    return marked


def _escaped(match: re.Match[str]) -> str:
    return "".join(f"\\{sign}" for sign in match[0])


# What docutils does not know, and stands in notebooks: short fractions, powers of a modulus, sizes
# of brackets, names of dots and of aligned equations.
_SAME = (
    (re.compile(r"\\([dt]?frac)\s*(\w)\s*(\d)"), r"\\\1{\2}{\3}"),
    # A power belongs to all of a modulus; otherwise the closing bar alone is its base.
    (re.compile(r"\\lvert(.*?)\\rvert(?=\^)"), r"{\\lvert\1\\rvert}"),
    (re.compile(r"\|(\w+)\|(?=\^)"), r"{|\1|}"),
    (re.compile(r"\\[bB]igg?(?=[(\[])"), r"\\left"),
    (re.compile(r"\\[bB]igg?(?=[)\]])"), r"\\right"),
    (re.compile(r"\\[bB]igg?(?![a-zA-Z])"), ""),
    (re.compile(r"\\dots(?![a-zA-Z])"), r"\\ldots"),
    (re.compile(r"\\(begin|end)\{align\*?\}"), r"\\\1{aligned}"),
)


# docutils puts the index of a letter with dots or a bar below the letter, as if it were a limit.
_ACCENT = re.compile(
    r"<munderover>\s*(<mi>\w</mi>)\s*(<(m\w+)>.*?</\3>)\s*(<mo[^>]*>.</mo>)\s*</munderover>",
    re.DOTALL,
)
# Names of functions keep a thin space from what stands before and behind, unless it is a bracket.
_APPLY = "<mo>&ApplyFunction;</mo>"
_BEFORE = re.compile(rf"(</m(?!o>)\w+>)(?=\s*<mi[^>]*>\w+</mi>\s*{_APPLY})")
_BEHIND = re.compile(rf"{_APPLY}(?!\s*(?:<mrow>\s*)?<mo)")
_THIN = '<mspace width="0.17em"></mspace>'
_TAG = re.compile(r"\\tag\{(.*?)\}")


def mathml(node, **options) -> str:
    """Return a formula as MathML, which browsers set themselves, without a script from outside."""
    formula = _TAG.sub("", node.astext()).strip()
    for pattern, replacement in _SAME:
        formula = pattern.sub(replacement, formula)
    try:
        text = tex2mathml(formula, **options)
    except MathError as error:
        logger.warning("formula %r: %s", formula, error, location=node)
        return f"<code>{escape(formula)}</code>"
    text = _ACCENT.sub(r'<msub><mover accent="true">\1\4</mover>\2</msub>', text)
    # Bars are brackets, not signs between two things; averages keep the height of the line.
    text = re.sub(r'<mo stretchy="false"[^>]*>([|\u2223])</mo>', r"<mi>\1</mi>", text)
    upright = r'<mo\1 stretchy="false" lspace="0" rspace="0">'
    text = re.sub(r"<mo([^>]*)>(?=[|\u2223]</mo>)", upright, text)
    text = _BEHIND.sub(_APPLY + _THIN, _BEFORE.sub(r"\1" + _THIN, text))
    return re.sub(r"<mo>(?=[⟨⟩]</mo>)", '<mo stretchy="false">', text)


def write_inline_formula(translator, node) -> None:
    """Write a formula within a line."""
    formula = mathml(node)
    if "behind" in node:
        formula = f'<span class="glued">{node["before"]}{formula}{escape(node["behind"])}</span>'
    translator.body.append(formula)
    raise SkipNode


def glue_formulas(app, doctree, page) -> None:
    """Give brackets, full stops and the like to the formula, for no line to break in between."""
    for formula in list(doctree.findall(math)):
        parent, place = formula.parent, formula.parent.index(formula)
        behind = parent[place + 1] if place + 1 < len(parent) else None
        before = parent[place - 1] if place else None
        formula["before"] = "(" if isinstance(before, Text) and before.endswith("(") else ""
        sign = re.match(r"[^\s\w]*(?:(?<=-)\w+)?", behind) if isinstance(behind, Text) else None
        formula["behind"] = sign[0] if sign else ""
        if formula["before"]:
            parent[place - 1] = Text(before[:-1])
        if formula["behind"]:
            parent[place + 1] = Text(behind[sign.end() :])


def mark_pictures(app, doctree, page) -> None:
    """Tell wide pictures, which small screens scroll, from those for one column of print."""
    for picture in doctree.findall(image):
        file = app.srcdir / picture["uri"]
        if size := get_image_size(file):
            inches = size[0] / max(getDPI(file)[0], 72)
            picture["classes"].append("panels" if inches > 6 else "panel")


def mark_numbers(app, doctree, page) -> None:
    """Tell cells of tables that hold numbers only."""
    for cell in doctree.findall(entry):
        if re.fullmatch(r"[-+±\d.,e%→> /()]+", cell.astext()):
            cell["classes"].append("number")


def write_formula(translator, node) -> None:
    """Write a formula on a line of its own, with its number if it has one."""
    translator.body.append(translator.starttag(node, "div", CLASS="math"))
    translator.body.append(mathml(node, as_block=True))
    tag = _TAG.search(node.astext())
    if tag or node["number"]:
        number = tag[1] if tag else get_node_equation_number(translator, node)
        translator.body.append(f'<span class="eqno">({number})</span>')
    translator.body.append("</div>\n")
    raise SkipNode


def defining_module(_, room: str, name: str) -> str | None:
    """Return the module with the source code of a function, which its room hands out."""
    found = getattr(import_module(room), name, None)
    return unwrap(found).__module__ if hasattr(found, "__wrapped__") else None


def setup(app) -> None:
    """Let Sphinx know of the above."""
    copy_notebooks()
    pack_lessons()
    app.connect("source-read", point_to_copies)
    app.connect("viewcode-follow-imported", defining_module)
    app.add_html_math_renderer("mathml", (write_inline_formula, None), (write_formula, None))
    app.connect("doctree-resolved", mark_pictures)
    app.connect("doctree-resolved", mark_numbers)
    app.connect("doctree-resolved", glue_formulas)
    # Before napoleon, which turns the sections of docstrings into fields.
    app.connect("autodoc-process-docstring", as_restructured_text, priority=400)
    app.connect("autodoc-process-docstring", repeat_fields, priority=600)
