"""A run of the program: its messages become exceptions, records of the logger "lightsplat" and calls of a function."""

from __future__ import annotations

import json
import logging
import os
import subprocess
import tempfile
from typing import IO, Any, Callable, Optional, Sequence

from ._errors import of_code
from ._program import program

# Called with the part of a run that is done, 0 to 1.
Progress = Optional[Callable[[float], Any]]

# Seconds that a run has to stop by itself.
PATIENCE = 5.0

LOGGER = logging.getLogger("lightsplat")

# Messages with a text, by their level. Errors become exceptions.
LEVELS = {"warning": logging.WARNING, "note": logging.INFO, "wrote": logging.INFO, "summary": logging.INFO}


def run(arguments: Sequence[str], progress: Progress = None) -> bytes:
    """Runs the program, and returns the bytes of its standard output.

    `progress` is called with the part of the run that is done, 0 to 1. An exception in it, and Ctrl-C, stop the run.
    """
    with tempfile.TemporaryFile() as output:
        # Commands without progress ignore the variable, and write text.
        environment = {**os.environ, "LIGHTSPLAT_PROGRESS": "ndjson"}
        child = subprocess.Popen(
            [program(), *arguments], stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.PIPE,
            encoding="utf-8", errors="replace", env=environment)
        try:
            assert child.stderr is not None
            with child.stderr:
                said = _listen(child.stderr, progress)
            code = child.wait()
        except BaseException:
            _stop(child)
            raise
        if code != 0:
            raise of_code(code, "\n".join(said) or f"lightsplat ended with {code}")
        output.seek(0)
        return output.read()


def _listen(lines: IO[str], progress: Progress) -> list[str]:
    """Reads and logs all messages. Returns the errors."""
    prose: list[str] = []
    errors: list[str] = []
    for line in lines:
        event = _event(line)
        kind = event.get("event")
        if kind == "error":
            errors.append(event["text"])
        elif kind == "progress" and progress is not None:
            progress(event["fraction"])
        elif kind in LEVELS:
            LOGGER.log(LEVELS[kind], "%s", event["text"])
        elif kind is None and line.startswith("warning: "):
            LOGGER.warning("%s", line.rstrip()[len("warning: "):])
        elif kind is None and line.strip():
            prose.append(line.rstrip())
    # The parser of the command line, and a processor that is too old, are reported in prose.
    return errors or _errors_in(prose)


def _errors_in(prose: list[str]) -> list[str]:
    """Returns the error in lines of text, and all lines if none begins with the word. Logs the lines before it."""
    mark = "error: "
    first = next((number for number, line in enumerate(prose) if line.startswith(mark)), None)
    for line in prose[:first]:
        LOGGER.info("%s", line)
    if first is None:
        return prose
    return [prose[first][len(mark):], *prose[first + 1:]]


def _event(line: str) -> dict[str, Any]:
    """Returns the event of a line, or an empty one if the line is prose."""
    if not line.startswith("{"):
        return {}
    try:
        event = json.loads(line)
    except ValueError:
        return {}
    return event if isinstance(event, dict) else {}


def _stop(child: subprocess.Popen[str]) -> None:
    """Ends the program: it cleans up at the first signal, stops at the second, and cannot outlive the third."""
    for end in (child.terminate, child.terminate, child.kill):
        end()
        try:
            child.wait(PATIENCE)
            return
        except (subprocess.TimeoutExpired, KeyboardInterrupt):
            continue
