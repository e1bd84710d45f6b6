"""Nothing in the package unpickles anything: a pickle runs whatever it says."""

from __future__ import annotations

import ast
from pathlib import Path

from crazybilliards.model import load

FORBIDDEN = {"pickle", "cPickle", "dill", "cloudpickle", "joblib", "shelve", "marshal"}


def test_the_package_unpickles_nothing():
    root = Path(load.__code__.co_filename).parents[1]
    sources = [
        path
        for room in ("model", "particles", "kinetic", "comparison")
        for path in (root / room).rglob("*.py")
    ]
    assert len(sources) > 100
    for path in sources:
        for node in ast.walk(ast.parse(path.read_text())):
            names = {
                alias.name.split(".")[0]
                for alias in getattr(node, "names", [])
                if isinstance(node, ast.Import)
            }
            if isinstance(node, ast.ImportFrom):
                names.add((node.module or "").split(".")[0])
            assert not names & FORBIDDEN, path
            if isinstance(node, ast.Call):
                called = ast.unparse(node.func)
                assert called not in ("eval", "exec", "compile", "pd.read_pickle"), path
                if called == "np.load":
                    given = {each.arg: ast.unparse(each.value) for each in node.keywords}
                    assert given.get("allow_pickle") == "False", path
