"""Pictures with few colours, whose files are small."""

from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image


def save(figure: Figure, name: str, colours: int = 64) -> None:
    """Write a picture beside this file."""
    drawn = BytesIO()
    figure.savefig(drawn)
    picture = Image.open(drawn).convert("RGB").quantize(colours)
    picture.save(Path(__file__).with_name(name), optimize=True, dpi=(250, 250))
