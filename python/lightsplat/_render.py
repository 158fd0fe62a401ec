"""`lightsplat.render`."""

import json
import os
import tempfile
from pathlib import Path

from ._arguments import to_options
from ._run import run


def render(scene, output=None, *, progress=None, **options):
    """Renders a scene by the program `lightsplat`, and returns an `Image`.

    `scene` is a file, or the name of a built-in scene like "kitchen".
    `output` keeps the image as this OpenEXR file, with its PNG beside it, unless `png` names another.
    `progress` is called with the part of the run that is done, 0 to 1.
    `options` are those of `lightsplat render`, with `_` for `-`. `True` is a flag. Sequences are lists:
    `resolution=(640, 360)`, `look_from=(0, 1, 4)`, `aov=["depth", "normal"]`, `denoise=False`. With `background="none"`,
    the image is premultiplied, and `layers["A"]` is its alpha.

    Raises `UsageError`, `SceneError`, `OutputError` or another `Error`, with the message of the program.
    """
    from ._image import Image

    words = ["render", os.fspath(scene), "--stats=json", *to_options(options)]
    if output is not None:
        output = os.fspath(output)
        stats = run([*words, f"--output={output}"], progress)
        return Image.read(output, json.loads(stats))
    with tempfile.TemporaryDirectory(prefix="lightsplat-") as folder:
        output = str(Path(folder, "image.exr"))
        own = [] if "png" in options else ["--no-png"]
        stats = json.loads(run([*words, f"--output={output}", *own], progress))
        # The file is gone when the caller reads this.
        del stats["run"]["output"]
        return Image.read(output, stats)
