"""Draw the QR code of a setting of the chain to play with.

    python docs/figures/qr_code.py [ADDRESS] [FILE.svg]

writes qr_code.svg beside it, of two rods that hardly ever meet, in the published documentation. It
needs segno, ``pip install segno``.
"""

import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).parent


def address() -> str:
    """Return the address of the two rods, in the documentation that pyproject.toml names."""
    project = tomllib.loads((HERE.parents[1] / "pyproject.toml").read_text("utf-8"))["project"]
    return f"{project['urls']['Documentation']}chain.html#size=2&gap=5"


def main(target: str = "", file: str = str(HERE / "qr_code.svg")) -> None:
    """Write the picture, which names its address."""
    import segno

    target = target or address()
    code = segno.make(target, micro=False)
    code.save(file, scale=5, light="white", svgclass=None, lineclass=None, title=target)


if __name__ == "__main__":
    main(*sys.argv[1:])
