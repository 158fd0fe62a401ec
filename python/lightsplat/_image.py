"""Images as NumPy arrays."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Optional

import numpy
import OpenEXR

from ._camera import Camera


class Image(numpy.ndarray[Any, Any]):
    """A float32 array of height x width x 3: radiance in W/(sr m^2), linear Rec. 709, rows from the top.

    `stats` is the dictionary of `lightsplat render --stats json`. `layers` holds the other layers of the file by their
    names, like `depth`: arrays of height x width, or with an axis for their channels. `camera` is the `Camera` of the
    complete film, also if the image is a crop. `transparent` is true with `background="none"`: the image is premultiplied
    by the alpha `layers["A"]`. Copies and results of arithmetic are arrays without all of these.
    """

    stats: Optional[dict[str, Any]] = None
    layers: Optional[dict[str, numpy.ndarray[Any, Any]]] = None
    camera: Optional[Camera] = None
    transparent: bool = False

    @classmethod
    def read(cls, path: str | os.PathLike[str], stats: Optional[dict[str, Any]] = None) -> Image:
        """Reads an OpenEXR file of the program."""
        with OpenEXR.File(os.fspath(path), separate_channels=True) as file:
            channels = {name: channel.pixels for name, channel in file.channels().items()}
            header = file.header()
            camera = Camera.of_header(header, Path(path).stem)
            transparent = header.get("lightsplat.background") == "none"
        # A copy by `stack` belongs to nothing that the file's end would free.
        pixels = numpy.stack([channels.pop(name) for name in "RGB"], axis=-1)
        image = pixels.astype(numpy.float32, copy=False).view(cls)
        image.stats = stats
        image.layers = _layers(channels)
        image.camera = camera
        image.transparent = transparent
        return image

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        return array[()] if return_scalar or array.ndim == 0 else array.view(numpy.ndarray)

    def __reduce__(self) -> tuple[Any, ...]:
        reduced: Any = super().__reduce__()
        kind, arguments, state = reduced
        return kind, arguments, (state, self.stats, self.layers, self.camera, self.transparent)

    def __setstate__(self, state: Any) -> None:
        state, self.stats, self.layers, self.camera, self.transparent = state
        super().__setstate__(state)


# Order of the channels of a layer.
ORDER = ["R", "G", "B", "A", "X", "Y", "Z"]


def _layers(channels: dict[str, Any]) -> dict[str, numpy.ndarray[Any, Any]]:
    """Returns the layers of channels: `normal.X`, `normal.Y` and `normal.Z` make `normal`."""
    groups: dict[str, dict[str, Any]] = {}
    for name, pixels in channels.items():
        layer, _, part = name.rpartition(".")
        groups.setdefault(layer or name, {})[part if layer else ""] = pixels
    return {layer: _joined(parts) for layer, parts in groups.items()}


def _joined(parts: dict[str, Any]) -> numpy.ndarray[Any, Any]:
    names = sorted(parts, key=lambda name: ORDER.index(name) if name in ORDER else len(ORDER))
    if len(names) == 1:
        return numpy.array(parts[names[0]])
    return numpy.stack([parts[name] for name in names], axis=-1)
