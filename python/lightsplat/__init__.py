"""lightsplat from Python: images as NumPy arrays, rendered by the program that this package installs.

    import lightsplat
    image = lightsplat.render("room.glb", spp=16)

`image` is a float32 array of height x width x 3: radiance, linear Rec. 709. `image.stats` holds counters and times.
"""

from ._errors import Error, OutputError, SceneError, SceneWarning, UsageError
from ._program import program
from ._render import render

__all__ = [
    "Error", "Image", "OutputError", "SceneError", "SceneWarning", "UsageError", "program", "render",
]


def __getattr__(name):
    # NumPy is loaded with the first image.
    if name == "Image":
        from ._image import Image
        return Image
    if name == "__version__":
        from importlib.metadata import version
        return version("lightsplat")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
