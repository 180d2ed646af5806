"""The engine; use the package ``igimp``."""

from os import PathLike
from typing import Any, final

from numpy.typing import NDArray

__version__: str

@final
class CaseFile:
    """A case file that was found right."""

    @staticmethod
    def read(path: str | PathLike[str], settings: list[str]) -> CaseFile:
        """Reads a file, changed by settings ``KEY=VALUE``."""

    @staticmethod
    def parse(name: str | PathLike[str], text: str, settings: list[str]) -> CaseFile:
        """Parses a text; files that it names lie beside the file of this name."""

    @property
    def title(self) -> str: ...
    @property
    def dimensions(self) -> int: ...
    @property
    def materials(self) -> list[str]: ...
    @property
    def stages(self) -> list[tuple[str, str, int]]: ...
    @property
    def folder(self) -> str | PathLike[str]: ...
    @property
    def source(self) -> str: ...
    @property
    def completed(self) -> str: ...
    @property
    def warnings(self) -> str: ...
    @property
    def diagnostics(self) -> str: ...
    def check(self) -> tuple[str, str]:
        """What the case will cost: its text, and its numbers as JSON."""

@final
class March:
    """A run in a thread of its own, which waits for Python after every event."""

    def __new__(
        cls,
        case: CaseFile,
        out: str | PathLike[str] | None,
        start: tuple[str, int],
        threads: int | None,
        overwrite: bool,
        date: str | None,
        with_body: bool,
        laws: list[tuple[str, Any]],
    ) -> March: ...
    def next(self, seconds: float) -> tuple[str, dict[str, NDArray[Any]] | None] | None:
        """Lets the run go on to its next event: JSON and arrays, an empty text if there was none, None at the end."""

    def stop(self) -> None:
        """Ends the run after its step."""

    def leave(self) -> None:
        """Listens no more."""

    def is_own_thread(self) -> bool:
        """Whether this is the thread of the run."""

    def found(self) -> dict[str, Any]:
        """Waits for the end and hands over what was found, once."""

@final
class ElementTest:
    """A test of a law, as it was made."""

    @property
    def text(self) -> str: ...
    @property
    def failure(self) -> str | None: ...
    def table(self) -> list[tuple[str, list[str], NDArray[Any]]]: ...
    def data(self) -> list[tuple[str, list[str], NDArray[Any]]]: ...
    def write(self, folder: str | PathLike[str]) -> list[str]: ...

@final
class Fit:
    """Parameters that were found."""

    @property
    def text(self) -> str: ...
    @property
    def block(self) -> str: ...
    @property
    def deviation(self) -> float: ...
    @property
    def has_kink(self) -> bool: ...
    def parameters(
        self,
    ) -> list[tuple[str, str, float, float, str, float | None, tuple[float, float] | None, list[str]]]: ...
    def correlation(self) -> list[list[float]]: ...
    def tests(self) -> list[ElementTest]: ...
    def write(self, folder: str | PathLike[str]) -> list[str]: ...

def element(
    source: tuple[str | PathLike[str], str, list[str], str | None],
    asked: dict[str, Any],
    law: Any,
) -> ElementTest: ...
def fit(
    source: tuple[str | PathLike[str], str, list[str], str | None],
    vary: list[tuple[str, list[str] | None]],
    tests: list[dict[str, Any]],
    scatter: list[tuple[str, str]],
) -> Fit: ...
def shipped() -> list[tuple[str, str]]: ...
def template(name: str) -> tuple[str | PathLike[str], str]: ...
def verdict(summary: str) -> tuple[str, str, int]: ...
