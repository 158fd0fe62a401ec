"""Exceptions. Each has the message of the program, and its exit code."""


class Error(RuntimeError):
    """The program failed. `code` is its exit code."""

    def __init__(self, message, code):
        super().__init__(message)
        self.code = code

    def __reduce__(self):
        return type(self), (self.args[0], self.code)


class UsageError(Error, ValueError):
    """An argument is wrong, or the scene lacks what it asks for."""


class SceneError(Error):
    """The scene cannot be read, or is invalid."""


class OutputError(Error):
    """The image cannot be written."""


class SceneWarning(UserWarning):
    """The image may differ from the one that the scene describes."""


def of_code(code, message):
    """Returns the exception for an exit code of the program."""
    kind = {2: UsageError, 3: SceneError, 4: OutputError}.get(code, Error)
    return kind(message, code)
