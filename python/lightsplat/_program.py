"""Search for the program."""

from __future__ import annotations

import os
import sysconfig
from pathlib import Path
from typing import Iterator

NAME = "lightsplat"


def program() -> str:
    """Returns the path of the program: `LIGHTSPLAT_PROGRAM` if it is set, else the program that the package installed."""
    chosen = os.environ.get("LIGHTSPLAT_PROGRAM")
    if chosen:
        return chosen
    for folder in _folders():
        path = folder / NAME
        if path.is_file() and os.access(path, os.X_OK):
            return str(path)
    tried = ", ".join(str(folder) for folder in _folders())
    raise FileNotFoundError(f"the program {NAME} is in none of {tried}; install the package again, "
                            "or set LIGHTSPLAT_PROGRAM to its path")


def _folders() -> Iterator[Path]:
    """Yields the folders where installers put programs."""
    packages = Path(__file__).resolve().parent.parent
    # pip install --target
    yield packages / "bin"
    # The package may be another scheme's than the running Python's, so its own prefix comes first.
    for prefix in packages.parents:
        if (prefix / "lib") in packages.parents:
            yield prefix / "bin"
            break
    yield Path(sysconfig.get_path("scripts"))
    yield Path(sysconfig.get_path("scripts", f"{os.name}_user"))
