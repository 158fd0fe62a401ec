"""Exceptions. Each has the message of the program, and its exit code."""

from __future__ import annotations

import os
import re
from typing import Any, Optional

# Beginning of a message up to a colon: `room.toml:12` or `room.toml`, or `cannot read room.toml`.
PLACE = re.compile(r"(?P<cannot>cannot \w+ )?(?P<file>.+?)(?::(?P<line>\d+))?")


class Error(RuntimeError):
    """The program failed.

    `code` is its exit code. `file` and `line` are the place that the message names, or None. A message may have several
    lines, one per error. The place is then that of the first.
    """

    code: int
    file: Optional[str]
    line: Optional[int]

    def __init__(self, message: str, code: int) -> None:
        super().__init__(message)
        self.code = code
        self.file, self.line = place_of(message)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.args[0], self.code)


class UsageError(Error, ValueError):
    """An argument is wrong, or the scene lacks what it asks for."""


class SceneError(Error):
    """The scene or an image cannot be read, or is invalid."""


class OutputError(Error):
    """The result cannot be written."""


def place_of(message: str) -> tuple[Optional[str], Optional[int]]:
    """Returns the file and the line that a message begins with, each None if it names none."""
    first = message.partition("\n")[0]
    for colon in re.finditer(": ", first):
        found = PLACE.fullmatch(first[:colon.start()])
        # Words before a colon are a file if the message says so, or if there is one.
        if found and (found["line"] or found["cannot"] or os.path.exists(found["file"])):
            return found["file"], int(found["line"]) if found["line"] else None
    return None, None


def of_code(code: int, message: str) -> Error:
    """Returns the exception for an exit code of the program."""
    kind = {2: UsageError, 3: SceneError, 4: OutputError}.get(code, Error)
    return kind(message, code)
