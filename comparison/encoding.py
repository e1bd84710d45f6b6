"""Pictures as a film: an mp4 by ffmpeg, an animated gif, or one of them in a page."""

from __future__ import annotations

import errno
import io
import tempfile
from base64 import b64encode
from collections.abc import Iterator
from contextlib import closing
from html import escape
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from crazybilliards.model.calls import public

Picture = NDArray[np.uint8]  # (height, width, 4)

PICTURES_A_SECOND = 25
_NO_FFMPEG = (
    "a film as mp4 needs ffmpeg, which was not found: pip install 'crazybilliards[film]' brings "
    "it, and a name that ends in .gif or .html needs none"
)


@public
class Player:
    """A film in HTML, which a notebook shows; ``html`` is the text."""

    def __init__(self, content: bytes, kind: str) -> None:
        data = b64encode(content).decode()
        self.html = (
            f'<video controls autoplay loop muted style="width: 100%" '
            f'src="data:video/mp4;base64,{data}"></video>'
            if kind == "mp4"
            else f'<img alt="film" style="width: 100%" src="data:image/gif;base64,{data}">'
        )

    def _repr_html_(self) -> str:
        return self.html

    def page(self, title: str) -> str:
        """Return a whole page that plays the film."""
        return (
            '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            f'<meta name="viewport" content="width=device-width"><title>{escape(title)}</title>'
            f"</head>\n<body><h1>{escape(title)}</h1>{self.html}</body></html>\n"
        )


def kind_of_film(suffix: str) -> str:
    """Return ``mp4`` or ``gif`` for the end of a file's name; a page holds an mp4 if it can.

    Raises ValueError for an mp4 without ffmpeg.
    """
    if suffix == ".mp4" and _ffmpeg() is None:
        raise ValueError(_NO_FFMPEG)
    return "gif" if suffix == ".gif" or _ffmpeg() is None else "mp4"


def encoded(pictures: Iterator[Picture], kind: str, a_second: float = PICTURES_A_SECOND) -> bytes:
    """Return the pictures, so many of which are shown in a second, as the content of a file."""
    return _as_mp4(pictures, a_second) if kind == "mp4" else _as_gif(pictures, a_second)


def _ffmpeg() -> Any:
    """Return the package that brings ffmpeg and calls it, or None."""
    try:
        package = import_module("imageio_ffmpeg")
        package.get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        return None
    return package


def _as_mp4(pictures: Iterator[Picture], a_second: float) -> bytes:
    """Return the pictures as an mp4, or raise an OSError, as for a full temporary folder."""
    ffmpeg, first, sent = _ffmpeg(), next(pictures), 0
    height, width, _ = first.shape
    # Players begin before they have all of the file.
    how = {"pix_fmt_in": "rgba", "fps": a_second, "macro_block_size": 2}
    options = ["-preset", "veryfast", "-movflags", "+faststart"]
    with tempfile.TemporaryDirectory() as scratch:
        film = Path(scratch, "film.mp4")
        writing = ffmpeg.write_frames(film, (width, height), **how, output_params=options)
        try:
            with closing(writing):
                writing.send(None)
                for picture in chain([first], pictures):
                    writing.send(picture)
                    sent += 1
            # It says nothing if it cannot write the end.
            if ffmpeg.count_frames_and_secs(film)[0] != sent:
                raise OSError(errno.EIO, "pictures are missing")
        except (OSError, RuntimeError) as error:
            reason = f"ffmpeg cannot write a film into {scratch}: the temporary folder may be full"
            raise OSError(errno.EIO, reason) from error
        return film.read_bytes()


def _as_gif(pictures: Iterator[Picture], a_second: float) -> bytes:
    # The first picture has all colours, because it shows their key.
    # Of a palette for the median the rare colours, which are those of the rods, would be wrong.
    method = Image.Quantize.MAXCOVERAGE
    first = Image.fromarray(next(pictures)).convert("RGB").quantize(256, method)
    others = (
        Image.fromarray(picture).convert("RGB").quantize(palette=first, dither=Image.Dither.NONE)
        for picture in pictures
    )
    film = io.BytesIO()
    first.save(
        film,
        "gif",
        save_all=True,
        append_images=others,
        duration=round(1000 / a_second),
        loop=0,
        optimize=False,
    )
    return film.getvalue()
