"""What a run found."""

from __future__ import annotations

import csv
import json
import math
import os
import warnings
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, SupportsIndex, overload

import numpy as np

from . import _html, _toml
from . import _igimp as engine
from ._body import Body
from ._errors import CLASSES, CaseWarning, Error, FileError, InputError

if TYPE_CHECKING:
    from ._case import Case

NO_UNIT: dict[str, Any] = {"name": "", "in_si": 1.0}


@dataclass(frozen=True)
class Check:
    """A result held against an outside value.

    Attributes
    ----------
    name : str
        What is measured.
    value, reference : float
        What was computed, and the outside value, in SI units.
    band : str
        What is accepted, such as ``± 2 %``, in the unit of the case.
    met : bool
        Whether the band is met; never where the check was not reached.
    source : str
        Where the outside value comes from.
    standing : str
        What the value is worth: ``held``, ``not-reached`` where the stage of the check did not come to its end (the
        value is then one on the way, or none), or ``nothing-fails`` for a factor of safety above 1000.
    unit : str
        The unit in which the case states what is accepted; empty for plain numbers.
    in_si : float
        Its value in the SI unit.
    """

    name: str
    value: float
    reference: float
    band: str
    met: bool
    source: str
    standing: str = "held"
    unit: str = ""
    in_si: float = 1.0

    @classmethod
    def of(cls, row: dict[str, Any]) -> Check:
        """A check of ``summary.json``."""
        check = row["check"]
        value = float("nan") if check["measured"] is None else check["measured"]
        unit = check.get("unit") or NO_UNIT
        return cls(
            name=check["quantity"],
            value=value,
            reference=check["expected"],
            band=_band(check["band"], unit),
            met=row["pass"],
            source=check["source"],
            standing=row.get("standing", "held"),
            unit=unit["name"],
            in_si=unit["in_si"],
        )

    @property
    def verdict(self) -> str:
        """``met``, ``missed`` or ``not reached``, as the program says it."""
        if self.standing == "not-reached":
            return "not reached"
        return "met" if self.met else "missed"

    @property
    def printed(self) -> str:
        """The value as the program prints it, in the unit of the case."""
        return "> 1000" if self.standing == "nothing-fails" else self._printed(self.value)

    def _printed(self, value: float) -> str:
        return "-" if math.isnan(value) else f"{value / self.in_si:.4g} {self.unit}".rstrip()

    def __str__(self) -> str:
        return f"{self.name}: {self.printed}, expected {self._printed(self.reference)}, {self.band} ({self.source})"


def _band(band: dict[str, Any], unit: dict[str, Any]) -> str:
    ((kind, value),) = band.items()
    if kind == "relative":
        return f"± {100 * value:.4g} %"
    ends = [f"{one / unit['in_si']:.4g}" for one in (value if kind == "between" else [value])]
    sign = {"between": "", "at-most": "≤ ", "at-least": "≥ "}[kind]
    return f"{sign}{' … '.join(ends)} {unit['name']}".rstrip()


@dataclass(frozen=True)
class Stage:
    """How a stage went.

    Attributes
    ----------
    name, kind : str
        Name, and kind such as ``gravity``.
    outcome : str
        ``completed``, ``stopped`` (as the case wanted), ``not-converged`` or ``interrupted``.
    reason : str
        Why, in words.
    steps, iterations, cuts : int
        Accepted steps, corrections in them, steps that were cut.
    seconds : float
        Wall-clock time [s].
    largest_displacement : float or None
        Largest displacement of a particle at the end [m]. None for a search, which leaves the body as it was found.
    interval : tuple of float or None
        Of a strength reduction: largest factor found stable, smallest found failed [-].
    details : dict
        All that ``summary.json`` has, trials of a strength reduction among it.
    """

    name: str
    kind: str
    outcome: str
    reason: str
    steps: int
    iterations: int
    cuts: int
    seconds: float
    largest_displacement: float | None
    interval: tuple[float | None, float | None] | None
    details: dict[str, Any] = field(repr=False)

    @classmethod
    def of(cls, row: dict[str, Any]) -> Stage:
        """A stage of ``summary.json``."""
        safety = row.get("safety")
        names = ("name", "kind", "outcome", "reason", "steps", "iterations", "cuts", "seconds", "largest_displacement")
        interval = None if safety is None else (safety["stable"], safety["failed"])
        return cls(**{name: row[name] for name in names}, interval=interval, details=row)


class Stages(tuple[Stage, ...]):
    """Stages in the order they ran, by number or by name."""

    @overload
    def __getitem__(self, key: SupportsIndex | str) -> Stage: ...

    @overload
    def __getitem__(self, key: slice) -> tuple[Stage, ...]: ...

    def __getitem__(self, key: SupportsIndex | str | slice) -> Stage | tuple[Stage, ...]:
        if not isinstance(key, str):
            return super().__getitem__(key)
        for stage in self:
            if stage.name == key:
                return stage
        raise KeyError(f"there is no stage {key!r}; stages: {', '.join(repr(stage.name) for stage in self)}")

    def _ipython_key_completions_(self) -> list[str]:
        return [stage.name for stage in self]


@dataclass(frozen=True)
class MeshResult:
    """One result on all meshes of a study of the mesh error.

    Attributes
    ----------
    name : str
        Name with unit.
    kind : str
        ``factor-of-safety``, ``limit-load`` or ``check``.
    values, half_widths : tuple of float
        By mesh from coarse to fine, and half the interval in which a search left each; None where there is none.
    early : tuple of bool
        By mesh, whether the run ended before it came to the value, which is then not extrapolated.
    extrapolated, uncertainty : float or None
        What the values say together, and how far that may be off.
    unit : str
        Of a check the unit in which the case states what is accepted; empty for plain numbers. Numbers are in SI units.
    in_si : float
        Its value in the SI unit.
    """

    name: str
    kind: str
    values: tuple[float | None, ...]
    half_widths: tuple[float, ...]
    early: tuple[bool, ...]
    extrapolated: float | None
    uncertainty: float | None
    unit: str = ""
    in_si: float = 1.0

    def _row(self) -> list[Any]:
        name = f"{self.name} [{self.unit}]" if self.unit else self.name
        numbers = (*self.values, self.extrapolated, self.uncertainty)
        return [name, *(None if x is None else x / self.in_si for x in numbers)]


@dataclass(frozen=True)
class MeshStudy:
    """A case on several meshes, and what they say together; iterate over it for its results.

    Attributes
    ----------
    meshes : tuple of str
        Cells from coarse to fine, such as ``h`` and ``h/2``.
    endings : tuple of str
        How the run on each ended.
    results : tuple of MeshResult
        Factors of safety, limit loads and checks.
    """

    meshes: tuple[str, ...]
    endings: tuple[str, ...]
    results: tuple[MeshResult, ...]

    def __iter__(self) -> Iterator[MeshResult]:
        return iter(self.results)

    @classmethod
    def of(cls, study: dict[str, Any]) -> MeshStudy:
        """The study of ``summary.json``."""

        def result(one: dict[str, Any]) -> MeshResult:
            found = one["estimate"] or {"value": None, "uncertainty": None}
            values, widths, early = (tuple(one[key]) for key in ("values", "half_widths", "early"))
            unit = one.get("unit") or NO_UNIT
            return MeshResult(
                one["name"],
                one["kind"],
                values,
                widths,
                early,
                found["value"],
                found["uncertainty"],
                unit["name"],
                unit["in_si"],
            )

        parts = [mesh["parts"] for mesh in study["meshes"]]
        return cls(
            meshes=tuple("h" if one == 1 else f"h/{one}" for one in parts),
            endings=tuple(mesh["ending"] for mesh in study["meshes"]),
            results=tuple(map(result, study["results"])),
        )

    def _repr_html_(self) -> str:
        header = ["result", *self.meshes, "extrapolated", "uncertainty"]
        return _html.rows(header, [result._row() for result in self])


@dataclass(frozen=True)
class Figure:
    """A picture of a results folder; a notebook shows it.

    Attributes
    ----------
    svg, png : Path
        Its files.
    caption : str
        Caption.
    """

    svg: Path
    png: Path
    caption: str

    def _repr_html_(self) -> str:
        return _html.picture(self.svg.read_text(encoding="utf-8"), self.caption)


class Figures(Mapping[str, Figure]):
    """Pictures by name, in the order of the report; a notebook shows all."""

    def __init__(self, figures: dict[str, Figure]) -> None:
        self._figures = figures

    def __getitem__(self, name: str) -> Figure:
        return self._figures[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._figures)

    def __len__(self) -> int:
        return len(self._figures)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    def _repr_html_(self) -> str:
        return "".join(table._repr_html_() for table in self.values())


class Tables(Mapping[str, Any]):
    """Tables by name: data frames where pandas is installed, else dicts of arrays by column."""

    def __init__(self, tables: dict[str, tuple[list[str], Any]]) -> None:
        self._tables = tables

    def __getitem__(self, name: str) -> Any:
        header, values = self._tables[name]
        columns = {column: values[:, k] for k, column in enumerate(header)}
        try:
            import pandas as pd
        except ImportError:
            return columns
        return pd.DataFrame(columns)

    def __iter__(self) -> Iterator[str]:
        return iter(self._tables)

    def __len__(self) -> int:
        return len(self._tables)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    def __repr__(self) -> str:
        return f"<tables: {', '.join(self) or 'none'}>"


class Results:
    """What a run found, in memory or in its results folder.

    Attributes
    ----------
    summary : dict
        All that ``summary.json`` has.
    ending : str
        ``done``, ``reference missed``, ``not converged`` or ``interrupted``.
    exit_code : int
        What the program would end with.
    failure : str or None
        The message of the step that found no equilibrium, if one ended the run.
    lost : list of str
        Why meshes of a study could not be run.
    folder : Path or None
        Results folder; None for a run that was kept in memory.
    """

    def __init__(
        self,
        summary: dict[str, Any],
        *,
        folder: Path | None,
        materials: tuple[str, ...],
        exit_code: int | None = None,
        failure: str | None = None,
        lost: list[str] | None = None,
        tables: dict[str, Tables] | None = None,
        body: Body | None = None,
    ) -> None:
        self.summary = summary
        text, self.ending, code = engine.verdict(json.dumps(summary))
        self._text = text
        self.exit_code = code if exit_code is None else exit_code
        self.failure = failure
        self.lost = lost or []
        self.folder = folder
        self._materials = materials
        self._tables = tables or {}
        self._body = body

    @classmethod
    def _of(cls, found: dict[str, Any], case: Case, folder: Path | None) -> Results:
        kinds = ("curves", "monitors", "sections")
        return cls(
            json.loads(found["summary"]),
            folder=folder,
            materials=case.materials,
            exit_code=found["exit_code"],
            failure=found["failure"],
            lost=found["lost"],
            tables={kind: Tables({name: (header, values) for name, header, values in found[kind]}) for kind in kinds},
            body=Body(found["body"], case.materials),
        )

    @classmethod
    def open(cls, folder: str | os.PathLike[str]) -> Results:
        """Opens a results folder, of this package or of the program.

        Raises
        ------
        FileError
            For a folder without results.
        """
        root = Path(folder)
        try:
            summary = json.loads((root / "summary.json").read_text(encoding="utf-8"))
            text = (root / "case.completed.toml").read_text(encoding="utf-8")
        except OSError as error:
            raise FileError(f"error: {root} holds no results of igimp\n  because: {error}") from error
        materials = tuple(_toml.loads(text).get("materials", {}))
        code = 3 if summary.get("failure") else None
        return cls(summary, folder=root, materials=materials, failure=summary.get("failure"), exit_code=code)

    # What was found.

    @property
    def title(self) -> str:
        """Title of the case."""
        return str(self.summary["title"])

    @property
    def interrupted(self) -> bool:
        """Whether the run was stopped and can go on."""
        return bool(self.summary["interrupted"])

    @property
    def warnings(self) -> list[str]:
        """The narration of the run."""
        return list(self.summary["warnings"])

    @cached_property
    def stages(self) -> Stages:
        """Stages in the order they ran, by number or by name."""
        return Stages(map(Stage.of, self.summary["stages"]))

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """Checks of the case."""
        return tuple(map(Check.of, self.summary["checks"]))

    @cached_property
    def mesh_study(self) -> MeshStudy | None:
        """The study of the mesh error, if one was asked for."""
        study = self.summary.get("mesh_study")
        return None if study is None else MeshStudy.of(study)

    @property
    def factor_of_safety_interval(self) -> tuple[float | None, float | None]:
        """Of the last strength reduction: largest factor found stable, smallest found failed [-]."""
        found = [stage.interval for stage in self.stages if stage.interval is not None]
        return found[-1] if found else (None, None)

    @property
    def factor_of_safety(self) -> float | None:
        """The middle of that interval [-]; None where nothing was searched for, or one end is missing."""
        stable, failed = self.factor_of_safety_interval
        return None if stable is None or failed is None else (stable + failed) / 2

    def raise_for_failure(self) -> Results:
        """Raises what the exit code says, if it is not 0; else hands back the results.

        Raises
        ------
        NotConverged
            If no equilibrium was found, or the run was interrupted.
        ReferenceMissed
            If a check is missed, or was not reached.
        """
        if self.exit_code:
            unmet = "\n".join(f"{check.verdict}: {check}" for check in self.checks if not check.met)
            text = self.failure or "\n".join(self.lost) or unmet or f"error: the run was {self.ending}"
            raise CLASSES.get(self.exit_code, Error)(text)
        return self

    # Tables and arrays.

    def _table(self, kind: str) -> Tables:
        if kind not in self._tables:
            files = sorted((self._need(kind) / kind).glob("*.csv"))
            self._tables[kind] = Tables({path.stem: _read(path) for path in files})
        return self._tables[kind]

    @property
    def curves(self) -> Tables:
        """Curves of the case by name; a table's columns carry units and signs."""
        return self._table("curves")

    @property
    def monitors(self) -> Tables:
        """Histories of points by name, a row a step."""
        return self._table("monitors")

    @property
    def sections(self) -> Tables:
        """Fields along lines by ``SECTION__STAGE``; stresses compression positive, as the columns say."""
        return self._table("sections")

    @property
    def energy(self) -> Any:
        """Where the work of stages that move in time went, a row a step, as ``energy.csv`` has it; columns carry units.

        None where nothing moves in time.
        """
        path = self._need("energy") / "energy.csv"
        return Tables({"energy": _read(path)})["energy"] if path.exists() else None

    @property
    def body(self) -> Body:
        """The particles at the end of the run; stresses tension positive."""
        if self._body is None:
            root = self._need("states of the particles")
            ends = sorted((root / "checkpoint").glob("stage-*-end/current"))
            ends += sorted((root / "last-converged").glob("**/current"))
            if self.interrupted:
                ends += sorted((root / "checkpoint").glob("step-*/current"))
            if not ends:
                raise FileError(f"error: {root} holds no state of the particles")
            self._body = Body.load(ends[-1], self._materials)
        return self._body

    # Files.

    def _need(self, what: str) -> Path:
        if self.folder is None:
            raise InputError(
                f"error: a run in memory has no {what}\n  help: give it a folder, as in case.run(out='results')"
            )
        return self.folder

    @property
    def report(self) -> Path:
        """``report.html``."""
        return self._need("report") / "report.html"

    @property
    def figures(self) -> Figures:
        """Pictures by name."""
        root = self._need("pictures")
        found = {}
        for note in self.summary["figures"]:
            path = root / note["file"]
            figure = Figure(path.with_name(path.name + ".svg"), path.with_name(path.name + ".png"), note["caption"])
            found[path.name] = figure
        return Figures(found)

    @property
    def frames(self) -> tuple[tuple[float, Path], ...]:
        """Frames for ParaView: pseudo-time and ``.vtu`` file of the particles."""
        return self._collection("particles.pvd")

    def motion(self, stage: str | None = None) -> tuple[tuple[float, Path], ...]:
        """Frames of a stage that moves in time, of the last one without a name: time [s] and ``.vtu`` file of the particles.

        Raises
        ------
        InputError
            If no stage of that name moves in time.
        """
        moving = [k for k, one in enumerate(self.stages, 1) if one.kind == "dynamic" and stage in (None, one.name)]
        if not moving:
            raise InputError(f"error: no stage {'' if stage is None else repr(stage) + ' '}moves in time")
        return self._collection(f"stage-{moving[-1]:02}.pvd")

    def _collection(self, name: str) -> tuple[tuple[float, Path], ...]:
        folder = self._need("frames") / "paraview"
        if not (folder / name).exists():
            return ()
        sets = ElementTree.parse(folder / name).iter("DataSet")
        return tuple((float(frame.get("timestep", "nan")), folder / frame.get("file", "")) for frame in sets)

    def frame(self, number: int = -1) -> Any:
        """A frame as a PyVista mesh; the last one by default."""
        import pyvista

        frames = self.frames
        if not frames:
            raise FileError(
                "error: the run wrote no frames\n  help: ask for them with the key output.paraview of the case"
            )
        return pyvista.read(frames[number][1])

    # Texts.

    def _warn(self) -> None:
        for text in self.warnings:
            warnings.warn(text, CaseWarning, stacklevel=4)

    def __str__(self) -> str:
        """Stages and checks as the program prints them."""
        return "\n".join(filter(None, [self._text.rstrip(), self.failure, *self.lost]))

    def __repr__(self) -> str:
        return f"<igimp.Results: {self.title}, {self.ending}>"

    def _repr_html_(self) -> str:
        return _html.results(self)


def _read(path: Path) -> tuple[list[str], Any]:
    """Header and numbers of a table; what is no number is NaN."""

    def number(text: str) -> float:
        try:
            return float(text)
        except ValueError:
            return float("nan")

    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    values = np.array([[number(text) for text in row] for row in rows], dtype=float)
    return header, values.reshape(len(rows), len(header))
