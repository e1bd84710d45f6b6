"""Keep the outputs of executed notebooks in notebooks/, so that web pages show them.

``make render`` executes all notebooks into build/notebooks/ and calls this file. It takes only
notebooks whose code is that of the script, and makes their outputs small and the same everywhere.
"""

import base64
import hashlib
import io
import sys
from pathlib import Path

import jupytext
import nbformat
from PIL import Image

HERE = Path(__file__).parent
EXECUTED = HERE.parent / "build" / "notebooks"
HIDDEN = {"hide-input", "remove-cell"}
WIDGET = "application/vnd.jupyter.widget-view+json"


def fingerprint(notebook):
    """Return a hash of the code cells, which the outputs belong to."""
    code = "\0".join(cell.source for cell in notebook.cells if cell.cell_type == "code")
    return hashlib.sha256(code.encode()).hexdigest()


def smaller(picture):
    """Return a PNG in base64 with a palette of 128 colours: a third of the size."""
    image = Image.open(io.BytesIO(base64.b64decode(picture)))
    if image.mode == "P":
        return picture
    file = io.BytesIO()
    image.convert("RGB").quantize(128, dither=Image.Dither.NONE).save(file, "PNG", optimize=True)
    return base64.b64encode(file.getvalue()).decode()


def keep(script):
    """Write the notebook of a script with the outputs of its execution."""
    from nbconvert.preprocessors import CoalesceStreamsPreprocessor  # the tests have no nbconvert

    executed = nbformat.read(EXECUTED / f"{script.stem}.ipynb", as_version=4)
    if fingerprint(executed) != fingerprint(jupytext.read(script)):
        raise SystemExit(f"{script.name} is newer than its execution; run: make render")
    paired = {"cell_metadata_filter": "tags,-all", "formats": "ipynb,py:percent"}
    metadata = {"jupytext": paired, "kernelspec": executed.metadata.kernelspec}
    executed.metadata = nbformat.from_dict({**metadata, "executed": fingerprint(executed)})
    executed, _ = CoalesceStreamsPreprocessor().preprocess(executed, {})
    for number, cell in enumerate(executed.cells):
        cell.id = f"cell-{number}"
        tags = cell.metadata.get("tags", [])
        cell.metadata = nbformat.from_dict({"tags": tags} if tags else {})
        if HIDDEN.intersection(tags):
            cell.metadata["jupyter"] = {"source_hidden": True}  # as JupyterLab knows it
        if cell.cell_type != "code":
            continue
        # A widget shows nothing without its kernel.
        cell.outputs = [output for output in cell.outputs if WIDGET not in output.get("data", {})]
        for output in cell.outputs:
            data = output.get("data", {})
            if "image/png" in data:
                data["image/png"] = smaller(data["image/png"])
    nbformat.write(executed, script.with_suffix(".ipynb"))


if __name__ == "__main__":
    for each in sys.argv[1:]:
        keep(Path(each))
