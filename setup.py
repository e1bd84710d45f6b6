"""The text of the package index: README.md with links and pictures that lead to the repository.

Everything else about the build stands in pyproject.toml. The index shows the README on a page of
its own, where a relative link leads nowhere.
"""

import re
import tomllib
from pathlib import Path

from setuptools import setup

HERE = Path(__file__).parent


def for_the_index(text: str, version: str, repository: str) -> str:
    """Make the relative links of a Markdown text absolute, at the tag of a version.

    Pages and files are looked at in the repository, and pictures are loaded from its raw files.
    """
    pictures = re.compile(r"(!\[[^]]*\]\()(?!https?:|#)([^)]+)\)")
    links = re.compile(r"(\]\()(?!https?:|#)([^)]+)\)")
    text = pictures.sub(rf"\1{repository}/raw/v{version}/\2)", text)
    return links.sub(rf"\1{repository}/blob/v{version}/\2)", text)


project = tomllib.loads((HERE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
setup(
    long_description=for_the_index(
        (HERE / "README.md").read_text(encoding="utf-8"),
        project["version"],
        project["urls"]["Repository"],
    ),
    long_description_content_type="text/markdown",
)
