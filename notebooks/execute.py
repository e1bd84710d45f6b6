"""Execute copies of notebooks one after the other in one kernel, and keep their outputs.

python notebooks/execute.py build/notebooks/*.ipynb

To start a kernel and to import all that a lesson needs takes longer than many lessons. Names of one
notebook are not known in the next.
"""

import sys
import time
from pathlib import Path

import nbformat
from nbclient import NotebookClient

_LIMIT = 300  # seconds of a cell, against hangs


def execute(paths: list[Path]) -> None:
    client = NotebookClient(
        nbformat.v4.new_notebook(),
        timeout=_LIMIT,
        kernel_name="python3",
        record_timing=False,  # outputs are found again by all that stands in their cells
        resources={"metadata": {"path": str(paths[0].parent)}},
    )
    with client.setup_kernel():
        kernel = client.wait_for_reply(client.kc.kernel_info())
        for path in paths:
            begun = time.monotonic()
            client.nb = nbformat.read(path, as_version=4)
            client.nb.metadata.language_info = kernel["content"]["language_info"]
            client.reset_execution_trackers()
            code = [i for i, cell in enumerate(client.nb.cells) if cell.cell_type == "code"]
            for count, i in enumerate(code, start=1):
                cell = client.execute_cell(client.nb.cells[i], i, execution_count=count)
                for output in cell.outputs:
                    if "execution_count" in output:  # the kernel counts all notebooks
                        output.execution_count = count
            nbformat.write(client.nb, path)
            print(f"{path.name}: {time.monotonic() - begun:.0f} s", flush=True)
            client.execute_cell(nbformat.v4.new_code_cell("%reset -f"), 0, store_history=False)


if __name__ == "__main__":
    execute([Path(each) for each in sys.argv[1:]])
