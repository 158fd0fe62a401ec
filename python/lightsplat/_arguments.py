"""Keyword arguments as options of the program."""

from __future__ import annotations

import os
from typing import Any, Mapping

# Options that this module sets, with the remedy for those who ask for them.
RESERVED = {
    "dry_run": "an image is rendered",
    "no_png": "name no output, and no file is kept",
    "stats": "the image has them as `stats`",
    "format": "an image is an array",
    "quiet": "pass `progress`, or set the level of the logger \"lightsplat\"",
    "verbose": "pass `progress`",
}

# Flags that `False` turns off by an option of its own.
NEGATED = {"denoise": "no-denoise", "default_light": "no-default-light"}

# Flags that are on unless they are negated.
ON = {"default_light"}

# Options that take one value each time.
REPEATED = {"hide", "light", "show"}


def to_options(keywords: Mapping[str, Any]) -> list[str]:
    """Returns the options for keyword arguments: `max_depth=5` becomes `--max-depth=5`."""
    options = []
    for name, value in keywords.items():
        if name in RESERVED:
            raise TypeError(f"there is no argument {name!r}; {RESERVED[name]}")
        options.extend(_option(name, value))
    return options


def _option(name: str, value: Any) -> list[str]:
    flag = "--" + name.replace("_", "-")
    if value is None or (value is True and name in ON):
        return []
    if value is True:
        return [flag]
    if value is False:
        return ["--" + NEGATED[name]] if name in NEGATED else []
    if isinstance(value, dict):
        return [f"{flag}={key}={_text(part)}" for key, part in value.items()]
    if name in REPEATED and not isinstance(value, (str, os.PathLike)):
        return [f"{flag}={_text(part)}" for part in value]
    separator = "x" if name in ("resolution", "size") else ","
    return [f"{flag}={_text(value, separator)}"]


def _text(value: Any, separator: str = ",") -> str:
    """Returns a value as the command line has it."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, bool):
        return str(value).lower()
    try:
        parts = list(value)
    except TypeError:
        return str(value)
    return separator.join(_text(part) for part in parts)
