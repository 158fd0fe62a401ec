"""lightsplat from Python: images as NumPy arrays, rendered by the program that this package installs.

    import lightsplat
    image = lightsplat.render("room.glb", spp=16)
    pixels = lightsplat.develop(image)

`image` is a float32 array of height x width x 3: radiance, linear Rec. 709. `image.stats` holds counters and times.
Messages of the program go to the logger "lightsplat".
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._dataset import dataset
from ._develop import develop
from ._errors import Error, OutputError, SceneError, UsageError
from ._info import info
from ._program import program
from ._render import render, views

if TYPE_CHECKING:
    from ._camera import Camera
    from ._image import Image

__all__ = [
    "Camera", "Error", "Image", "OutputError", "SceneError", "UsageError",
    "dataset", "develop", "info", "program", "render", "views",
]


def __getattr__(name: str) -> Any:
    # NumPy is loaded with the first image or camera.
    if name == "Image":
        from ._image import Image
        return Image
    if name == "Camera":
        from ._camera import Camera
        return Camera
    if name == "__version__":
        from importlib.metadata import version
        return version("lightsplat")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
