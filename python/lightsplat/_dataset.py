"""`lightsplat.dataset`."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Iterable

from ._arguments import to_options
from ._run import Progress, run


def dataset(
    models: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    output: str | os.PathLike[str],
    *,
    progress: Progress = None,
    **options: Any,
) -> dict[str, Any]:
    """Renders models from random cameras in random light into the folder `output`, and returns its `metadata.json`.

    `options` are those of `lightsplat dataset`, with `_` for `-`: `views=20`, `size=256`, `light=["sky,0,60", "a.exr"]`.
    `Image.read` reads the images. Raises `Error` with the code 5 if some models cannot be read. All others are then
    rendered, and `metadata.json` lists the models that are left out.
    """
    paths = [models] if isinstance(models, (str, os.PathLike)) else list(models)
    words = ["dataset", *(os.fspath(path) for path in paths), f"--output={os.fspath(output)}", *to_options(options)]
    run(words, progress)
    metadata: dict[str, Any] = json.loads(Path(output, "metadata.json").read_text(encoding="utf-8"))
    return metadata
