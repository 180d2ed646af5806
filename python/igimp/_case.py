"""Cases: read, changed, checked, explained and run."""

from __future__ import annotations

import datetime
import os
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _igimp as engine
from . import _toml
from ._errors import CaseWarning
from ._law import Law
from ._march import March, Step, finish
from ._progress import of as progress_of

if TYPE_CHECKING:
    from ._results import Results

import json


@dataclass(frozen=True)
class Estimate:
    """What a case will cost; printed, it is what ``igimp check`` prints.

    Attributes
    ----------
    particles, cells, unknowns : int
        Size of the model, on its own grid.
    bytes : float
        Memory [bytes]; for a study of the mesh error that of its meshes as they run.
    most_bytes : float
        The same where an iteration is given up for factors [bytes].
    seconds : float
        Time of all planned steps [s], for a study of the mesh error on all its meshes; an upper bound if ``open_ended``.
    threads : int
        Threads that the time holds for.
    solver : str
        How linear systems will be solved, and why.
    warnings : str
        Warnings of the case file; empty when there are none.
    """

    particles: int
    cells: int
    unknowns: int
    bytes: float
    most_bytes: float
    seconds: float
    open_ended: bool
    threads: int
    solver: str
    warnings: str
    text: str

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        from ._html import preformatted

        return preformatted(self.text)


class Case:
    """A problem as a case file states it.

    Keys are those of the case file, with dots: ``case["materials.clay.cohesion"] = "12 kPa"``. A value is what the
    file could hold: a text with its unit, a number where the file takes one, a list, a dict. Everything is checked
    at once, with the messages of the program.

    Make one with :meth:`from_file`, :meth:`from_string`, :meth:`from_dict` or :func:`igimp.new`.
    """

    def __init__(
        self,
        *,
        path: Path | None = None,
        text: str = "",
        name: str = "case.toml",
        settings: Mapping[str, str] | None = None,
        laws: Mapping[str, Law] | None = None,
    ) -> None:
        self._path, self._text, self._name = path, text, name
        self._settings = dict(settings or {})
        self._laws = dict(laws or {})
        self._file = self._read(self._settings)
        self._completed: dict[str, Any] | None = None

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Case:
        """Reads a case file.

        Raises
        ------
        InputError
            For a file that states no case, with every problem and its place.
        FileError
            For a file that cannot be read.
        """
        return cls(path=Path(path))

    @classmethod
    def from_string(cls, text: str, name: str | os.PathLike[str] = "case.toml") -> Case:
        """Reads the text of a case file; files that it names lie beside the file of this name."""
        return cls(text=text, name=os.fspath(name))

    @classmethod
    def from_dict(cls, case: Mapping[str, Any], name: str | os.PathLike[str] = "case.toml") -> Case:
        """A case from a dict with the keys of a case file."""
        return cls.from_string(_toml.document(case), name)

    def _read(self, settings: Mapping[str, str]) -> engine.CaseFile:
        lines = [f"{key}={value}" for key, value in settings.items()]
        if self._path is not None:
            return engine.CaseFile.read(self._path, lines)
        return engine.CaseFile.parse(self._name, self._text, lines)

    def __reduce__(self) -> Any:
        return _again, (self._path, self._text, self._name, self._settings, self._laws)

    def copy(self) -> Case:
        """The same case, to be changed by itself."""
        return _again(self._path, self._text, self._name, self._settings, self._laws)

    __copy__ = copy

    # Values.

    def __setitem__(self, key: str, value: Any) -> None:
        settings = {path: text for path, text in self._settings.items() if path != key}
        settings[key] = _toml.value(value)
        self._file = self._read(settings)
        self._settings, self._completed = settings, None

    def __getitem__(self, key: str) -> Any:
        value: Any = self.to_dict()
        for part in _parts(key):
            if isinstance(value, Mapping) and part in value:
                value = value[part]
            elif isinstance(value, list):
                value = _item(value, part, key)
            else:
                raise KeyError(key)
        return value

    def _ipython_key_completions_(self) -> list[str]:
        return list(_keys(self.to_dict()))

    def with_values(self, values: Mapping[str, Any]) -> Case:
        """A copy with other values by key, checked together.

        Examples
        --------
        >>> import igimp
        >>> slope = igimp.new("slope").with_values({"materials.clay.cohesion": "12 kPa"})
        >>> slope["materials.clay.cohesion"]
        '12 kPa'
        """
        settings = {path: text for path, text in self._settings.items() if path not in values}
        settings |= {key: _toml.value(value) for key, value in values.items()}
        return _again(self._path, self._text, self._name, settings, self._laws)

    def with_laws(self, laws: Mapping[str, Law]) -> Case:
        """A copy whose materials of these names have laws that are written in Python.

        The material keeps its unit weight, ``young`` and ``poisson``; its model and strength in the file count no more.
        """
        for name in laws:
            if name not in self.materials:
                raise KeyError(f"there is no material {name!r}; materials: {', '.join(self.materials)}")
        return _again(self._path, self._text, self._name, self._settings, self._laws | dict(laws))

    # What it says.

    @property
    def title(self) -> str:
        """Title."""
        return self._file.title

    @property
    def dimensions(self) -> int:
        """2 in plane strain, 3 in space."""
        return self._file.dimensions

    @property
    def materials(self) -> tuple[str, ...]:
        """Names of the materials, in the order that ``body.law`` counts."""
        return tuple(self._file.materials)

    @property
    def stages(self) -> tuple[str, ...]:
        """Names of the stages in order."""
        return tuple(name for name, _, _ in self._file.stages)

    @property
    def folder(self) -> Path:
        """The results folder that the file names; ``run(out=case.folder)`` writes there."""
        return Path(self._file.folder)

    @property
    def settings(self) -> dict[str, str]:
        """What was changed beside the file, as TOML by key."""
        return dict(self._settings)

    @property
    def warnings(self) -> str:
        """Warnings, as the program prints them; empty when there are none."""
        return self._file.warnings

    def explain(self) -> str:
        """The case with every default written out, commented, as ``igimp explain`` prints it."""
        return self._file.completed

    def to_toml(self) -> str:
        """A case file that states this case, changes and defaults included."""
        return self._file.completed

    def to_dict(self) -> dict[str, Any]:
        """The case with every default, as a dict."""
        if self._completed is None:
            self._completed = _toml.loads(self._file.completed)
        return self._completed

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes :meth:`to_toml` to a file."""
        Path(path).write_text(self.to_toml(), encoding="utf-8")

    def check(self) -> Estimate:
        """What the case will cost: particles, unknowns, memory, time, solver; as ``igimp check`` tells.

        Raises
        ------
        InputError
            For a case that cannot be set up.
        """
        text, numbers = self._file.check()
        return Estimate(**json.loads(numbers), warnings=self.warnings, text=text)

    def __repr__(self) -> str:
        return f"<igimp.Case: {self.title}>"

    def _repr_html_(self) -> str:
        from ._html import case

        return case(self)

    # Runs.

    def run(
        self,
        out: str | os.PathLike[str] | None = None,
        *,
        progress: bool | str | None = None,
        callback: Callable[[Step], object] | None = None,
        threads: int | None = None,
        resume: bool = False,
        from_stage: str | None = None,
        overwrite: bool = False,
        meshes: int | None = None,
    ) -> Results:
        """Runs the case through its stages.

        Want of equilibrium is a result, as for the program: ``results.failure`` tells, and
        ``results.raise_for_failure()`` makes an exception of it. The GIL is released while the engine computes.

        Parameters
        ----------
        out : path, optional
            Results folder. Without one the run is kept in memory: there are then no pictures, report, frames and
            checkpoints, and it cannot be resumed.
        progress : bool or "lines", optional
            A bar, nothing, or the lines of the program. By default a bar where somebody looks, in a terminal or a
            notebook.
        callback : callable, optional
            Called with a :class:`Step` after every accepted step, also those of trials. If it returns ``False`` the
            run ends there; what it raises ends the run and is raised again.
        threads : int, optional
            Threads of this run; by default those of the processor. Results are the same bits for any number.
        resume : bool
            Go on at the newest checkpoint of the folder.
        from_stage : str, optional
            Begin with this stage, at the saved end of the one that it starts from.
        overwrite : bool
            Replace results of another case, and of a run that could go on.
        meshes : int, optional
            Compute the case on so many meshes, of h, h/2 and h/4, for the error of the mesh.

        Returns
        -------
        Results

        Raises
        ------
        Interrupted
            After Ctrl-C: the run ends after its step, everything is saved, the message says how to go on.
        InputError, FileError
            For what the program ends with exit codes 2 and 4 for.
        """
        case = self if meshes is None else self.with_values({"mesh_study.meshes": meshes})
        march = case.march(
            out,
            threads=threads,
            resume=resume,
            from_stage=from_stage,
            overwrite=overwrite,
            bodies=callback is not None,
        )
        shown = progress_of(progress)
        return finish(march, shown, callback)

    def march(
        self,
        out: str | os.PathLike[str] | None = None,
        *,
        threads: int | None = None,
        resume: bool = False,
        from_stage: str | None = None,
        overwrite: bool = False,
        bodies: bool = True,
    ) -> March:
        """Runs the case step by step: ``for step in case.march(): ...``.

        The engine waits after every accepted step until the next one is asked for. Leaving the loop ends the run
        cleanly, with everything saved; ``march.results`` has what it found.

        Parameters
        ----------
        bodies : bool
            Whether steps carry the state of the body; it is copied after every step.
        out, threads, resume, from_stage, overwrite
            As for :meth:`run`.
        """
        if self.warnings.strip():
            warnings.warn(self.warnings.strip(), CaseWarning, stacklevel=2)
        if (resume or from_stage is not None) and out is None:
            raise ValueError("a run goes on in its results folder: give it as out=...")
        if threads is not None and threads < 0:
            raise ValueError(f"threads = {threads}: give a number of threads, or none for all")
        if sum([resume, overwrite, from_stage is not None]) > 1:
            raise ValueError("resume, from_stage and overwrite exclude each other: give one of them")
        start = ("resume", 0) if resume else ("afresh", 0)
        if from_stage is not None:
            if from_stage not in self.stages:
                raise KeyError(f"there is no stage {from_stage!r}; stages: {', '.join(map(repr, self.stages))}")
            start = ("stage", self.stages.index(from_stage))
        folder = None if out is None else Path(out)
        begun = engine.March(self._file, folder, start, threads, overwrite, _now(), bodies, list(self._laws.items()))
        return March(begun, self, folder)


def new(template: str) -> Case:
    """A case that comes with igimp, such as ``"slope"``; :func:`templates` lists them.

    Raises
    ------
    InputError
        For a name that there is not, with the nearest one.
    """
    name, text = engine.template(template)
    return Case(text=text, name=os.fspath(name))


def templates() -> dict[str, str]:
    """Names of the cases that come with igimp, and what each is."""
    return dict(engine.shipped())


def _again(path: Path | None, text: str, name: str, settings: Mapping[str, str], laws: Mapping[str, Law]) -> Case:
    return Case(path=path, text=text, name=name, settings=settings, laws=laws)


def _keys(value: Any, before: str = "") -> Iterator[str]:
    """The keys of values within a table or a list of tables, things in lists by their names."""
    if isinstance(value, list):
        named = {row["name"]: row for row in value if isinstance(row, Mapping) and "name" in row}
    else:
        named = value if isinstance(value, Mapping) else {}
    for name, row in named.items():
        part = f'"{name}"' if "." in name else name
        yield before + part
        yield from _keys(row, f"{before}{part}.")


def _parts(key: str) -> Iterator[str]:
    """The parts of a key, which may be quoted."""
    part, quote = "", ""
    for letter in key:
        if letter == quote:
            quote = ""
        elif not quote and letter in "\"'":
            quote = letter
        elif not quote and letter == ".":
            yield part
            part = ""
        else:
            part += letter
    yield part


def _item(items: list[Any], part: str, key: str) -> Any:
    """The item of a list by its name, or by its number."""
    for item in items:
        if isinstance(item, Mapping) and item.get("name") == part:
            return item
    if part.isdigit() and int(part) < len(items):
        return items[int(part)]
    raise KeyError(key)


def _now() -> str:
    """Day and time for the head of a report; ``SOURCE_DATE_EPOCH`` takes the place of the clock."""
    fixed = os.environ.get("SOURCE_DATE_EPOCH")
    zone = datetime.timezone.utc
    now = datetime.datetime.now(zone) if fixed is None else datetime.datetime.fromtimestamp(int(fixed), zone)
    return now.strftime("%Y-%m-%d %H:%M UTC")
