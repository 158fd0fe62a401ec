"""A run of the program: its messages become exceptions, warnings and calls of a function."""

import json
import subprocess
import tempfile
import warnings

from ._errors import SceneWarning, of_code
from ._program import program

# Seconds that a run has to stop by itself.
PATIENCE = 5.0


def run(arguments, progress=None):
    """Runs the program, and returns the bytes of its standard output.

    `progress` is called with the part of the run that is done, 0 to 1. An exception in it, and Ctrl-C, stop the run.
    """
    with tempfile.TemporaryFile() as output:
        command = [program(), *arguments, "--progress=ndjson"]
        child = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.PIPE, encoding="utf-8",
            errors="replace")
        try:
            with child.stderr:
                said, cautions = _listen(child.stderr, progress)
            code = child.wait()
        except BaseException:
            _stop(child)
            raise
        if code != 0:
            raise of_code(code, "\n".join(said) or f"lightsplat ended with {code}")
        for text in cautions:
            # The caller of `render`.
            warnings.warn(text, SceneWarning, stacklevel=3)
        output.seek(0)
        return output.read()


def _listen(lines, progress):
    """Reads all messages. Returns the errors, and the warnings."""
    prose, errors, cautions = [], [], []
    for line in lines:
        event = _event(line)
        kind = event.get("event")
        if kind is None:
            prose.append(line.rstrip())
        elif kind == "error":
            errors.append(event["text"])
        elif kind == "warning":
            cautions.append(event["text"])
        elif kind == "progress" and progress is not None:
            progress(event["fraction"])
    # The parser of the command line, and a processor that is too old, are reported in prose.
    return errors or [line.removeprefix("error: ") for line in prose if line], cautions


def _event(line):
    """Returns the event of a line, or an empty one if the line is prose."""
    if not line.startswith("{"):
        return {}
    try:
        return json.loads(line)
    except ValueError:
        return {}


def _stop(child):
    """Ends the program: it cleans up at the first signal, stops at the second, and cannot outlive the third."""
    for end in (child.terminate, child.terminate, child.kill):
        end()
        try:
            child.wait(PATIENCE)
            return
        except (subprocess.TimeoutExpired, KeyboardInterrupt):
            continue
