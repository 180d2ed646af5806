"""Exceptions: one class for each exit code of the program, with the text that the program prints."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._results import Results


class Error(Exception):
    """Something that igimp cannot do; its text is that of the program.

    Attributes
    ----------
    exit_code : int
        What the program ``igimp`` would end with.
    diagnostics : list of dict
        What is wrong with a case file, problem by problem: ``message``, ``help``, ``is_error``, ``setting`` (number
        of the changed key, None for the file) and ``bytes`` (where in its text).
    """

    exit_code: int = 0

    def __init__(self, text: str, diagnostics: list[dict[str, Any]] | None = None) -> None:
        super().__init__(text)
        self.diagnostics = diagnostics or []


class ReferenceMissed(Error):
    """A check of the case is missed (exit code 1)."""

    exit_code = 1


class InputError(Error, ValueError):
    """A case that makes no sense, or cannot be set up (exit code 2)."""

    exit_code = 2


class NotConverged(Error):
    """No equilibrium was found, or the run was interrupted (exit code 3)."""

    exit_code = 3


class FileError(Error, OSError):
    """Files, memory or a folder in use: what the system does not give (exit code 4)."""

    exit_code = 4


class Interrupted(KeyboardInterrupt):
    """A run that Ctrl-C ended after its step, with everything saved.

    Attributes
    ----------
    results : Results
        What was computed until then.
    """

    def __init__(self, text: str, results: Results) -> None:
        super().__init__(text)
        self.results = results


class CaseWarning(UserWarning):
    """Something in a case, or about its run, that its author should know."""


CLASSES: dict[int, type[Error]] = {error.exit_code: error for error in (ReferenceMissed, InputError, NotConverged, FileError)}


def raised(code: int, text: str, diagnostics: str = "[]") -> Error:
    """The exception for an exit code of the program."""
    return CLASSES.get(code, Error)(text, json.loads(diagnostics))
