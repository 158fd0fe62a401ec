"""`lightsplat.info`."""

from __future__ import annotations

import json
import os
from typing import Any

from ._arguments import to_options
from ._run import run


def info(scene: str | os.PathLike[str], **options: Any) -> dict[str, Any]:
    """Returns what a scene contains and requires, as `lightsplat info --json` prints it.

    `options` are those of `lightsplat info`, with `_` for `-`. Raises `SceneError` or `UsageError`.
    """
    facts: dict[str, Any] = json.loads(run(["info", os.fspath(scene), "--json", *to_options(options)]))
    return facts
