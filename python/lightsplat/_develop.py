"""`lightsplat.develop`."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._run import run

if TYPE_CHECKING:
    import numpy


def develop(
    image: numpy.ndarray[Any, Any] | str | os.PathLike[str],
    *,
    exposure: str | float = "auto",
    view: str = "neutral",
) -> numpy.ndarray[Any, Any]:
    """Returns an image for display: a uint8 array of height x width x 3, as the PNG files of the program have it.

    `image` is an OpenEXR file, or an array of linear radiance: height x width x 3, or x 4 if it is premultiplied by the
    alpha that its last channel holds. Images with a transparent background, and arrays of four channels, give four.
    `exposure` is "auto", "auto+1" or a number of stops. `view` is "neutral", "standard", "agx" or "filmic".
    """
    import numpy

    with tempfile.TemporaryDirectory(prefix="lightsplat-") as folder:
        if not isinstance(image, (str, os.PathLike)):
            path = str(Path(folder, "image.exr"))
            _write(image, path)
            image = path
        words = ["develop", os.fspath(image), "--output=-", f"--exposure={exposure}", f"--view={view}"]
        data = run(words)
    # A Portable Arbitrary Map: lines of a name and a value, then the bytes.
    head, _, pixels = data.partition(b"ENDHDR\n")
    facts = dict(line.split(None, 1) for line in head.decode().splitlines()[1:])
    shape = [int(facts[name]) for name in ("HEIGHT", "WIDTH", "DEPTH")]
    shown: numpy.ndarray[Any, Any] = numpy.frombuffer(pixels, numpy.uint8).reshape(shape).copy()
    return shown


def _write(image: Any, path: str) -> None:
    """Writes an array as an OpenEXR file."""
    import numpy
    import OpenEXR

    pixels = numpy.asarray(image, numpy.float32)
    if pixels.ndim != 3 or pixels.shape[2] not in (3, 4):
        raise ValueError(f"an image of the shape {pixels.shape} is none; pass height x width x 3, or x 4 with alpha")
    names = "RGBA"[:pixels.shape[2]]
    channels = {name: numpy.ascontiguousarray(pixels[..., number]) for number, name in enumerate(names)}
    if getattr(image, "transparent", False):
        channels["A"] = image.layers["A"]
    header = {"compression": OpenEXR.NO_COMPRESSION, "type": OpenEXR.scanlineimage}
    if "A" in channels:
        header["lightsplat.background"] = "none"
    OpenEXR.File(header, channels).write(path)
