"""Laws on their own: tests of the laboratory."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _igimp as engine
from . import _toml
from ._errors import InputError
from ._results import Figure, Figures, Tables

if TYPE_CHECKING:
    from ._law import Law


class ElementTest:
    """A test of a law: one piece of soil under uniform strain.

    Attributes
    ----------
    text : str
        What ``igimp element`` prints of it.
    failure : str or None
        Why it ended early, where soil cannot bear what is prescribed.
    """

    def __init__(self, made: engine.ElementTest) -> None:
        self._made = made
        self.text, self.failure = made.text, made.failure

    @cached_property
    def table(self) -> Any:
        """A row a step, compression positive: a data frame where pandas is installed, else arrays by column."""
        return Tables({name: (header, values) for name, header, values in self._made.table()})["element"]

    @cached_property
    def data(self) -> Any:
        """A row a measurement: measured, computed and the difference, as ``table``; None without data."""
        made = {name: (header, values) for name, header, values in self._made.data()}
        return Tables(made)["data"] if made else None

    def save(self, folder: str | os.PathLike[str]) -> Figures:
        """Writes ``report.html``, table and pictures into a folder; the pictures, which a notebook shows."""
        folder = Path(folder)
        names = [name for name in self._made.write(folder) if name.endswith(".svg")]
        stems = [name.removesuffix(".svg") for name in names]
        figures = {stem: Figure(folder / f"{stem}.svg", folder / f"{stem}.png", stem.replace("-", " ")) for stem in stems}
        return Figures(figures)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<igimp.ElementTest: {self.text.splitlines()[0]}>"

    def _repr_html_(self) -> str:
        from ._html import preformatted

        return preformatted(self.text)


def source_of(
    source: str | os.PathLike[str] | Mapping[str, Any], material: str | None, values: Mapping[str, Any] | None
) -> tuple[Path, str, list[str], str | None]:
    """A file of materials as the engine takes it: name, text, settings, and the material that is meant."""
    if isinstance(source, Mapping):
        name, text = Path("material.toml"), _toml.document({"igimp": 1, "materials": {material or "soil": source}})
    else:
        name, text = Path(source), Path(source).read_text(encoding="utf-8")
    settings = [f"{key}={_toml.value(value)}" for key, value in (values or {}).items()]
    return name, text, settings, material


# What a test may be asked, with what holds where nothing is said.
DEFAULTS: dict[str, Any] = {
    "test": "triaxial-drained",
    "path": None,
    "stress": "100 kPa",
    "side_stress": None,
    "strain": None,
    "steps": 200,
    "duration": 0.0,
    "small_strain": False,
    "data": None,
}


def asked_of(place: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """A test as the engine takes it; `place` is where it stands, for messages."""
    for name in given:
        if name not in DEFAULTS:
            known = ", ".join(DEFAULTS)
            raise InputError(f"error: {place}: there is no argument `{name}`\n  help: arguments: {known}")
    asked = {**DEFAULTS, **given}
    if asked["path"] is not None:
        asked["path"] = Path(asked["path"])
    asked["data"] = measured(place, asked["data"])
    return asked


def measured(place: str, data: Any) -> Any:
    """Measurements as the engine takes them: a file, or columns as CSV with a name."""
    if data is None or isinstance(data, (str, os.PathLike)):
        return None if data is None else Path(data)
    columns = {str(name): list(data[name]) for name in data}
    if len({len(column) for column in columns.values()}) > 1:
        lengths = ", ".join(f"`{name}` {len(column)}" for name, column in columns.items())
        raise InputError(f"error: {place}: columns of the data differ in length: {lengths}")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    for row in zip(*columns.values()):
        writer.writerow("" if value is None or value != value else value for value in row)
    return "data", text.getvalue()


def element(
    source: str | os.PathLike[str] | Mapping[str, Any],
    test: str = "triaxial-drained",
    *,
    material: str | None = None,
    path: str | os.PathLike[str] | None = None,
    stress: str | float = "100 kPa",
    side_stress: str | float | None = None,
    strain: float = 0.2,
    steps: int = 200,
    duration: str | float = 0.0,
    small_strain: bool = False,
    data: str | os.PathLike[str] | Mapping[str, Any] | None = None,
    values: Mapping[str, Any] | None = None,
    law: Law | None = None,
) -> ElementTest:
    """Drives a law on its own, as ``igimp element`` does.

    Parameters
    ----------
    source : path or dict
        A case file, a file with materials alone, or the keys of one material.
    test : str
        ``triaxial-drained``, ``triaxial-undrained``, ``oedometer``, ``simple-shear-drained``, ``simple-shear-undrained``,
        ``plane-strain-drained`` or ``plane-strain-undrained``.
    material : str, optional
        Name of the material; needed where there are several.
    path : path, optional
        A CSV file with a path of one's own in place of a test.
    stress, side_stress : str or float
        Initial effective stress along the axis and at the sides, compression positive: with a unit, or in Pa.
    strain : float
        Natural axial strain at the end [-], compression positive, or shear strain.
    steps : int
        Steps of the test, or of a leg of a path.
    duration : str or float
        How long the test takes: with a unit, or in s.
    small_strain : bool
        Linear strain, and stress per initial area.
    data : path or dict, optional
        Measurements in a CSV file, or their columns as a dict or a data frame, laid over the curves.
    values : dict, optional
        Other values by key, such as ``{"materials.clay.cu": "40 kPa"}``.
    law : Law, optional
        A law that is written in Python, in place of the model of the material.

    Raises
    ------
    InputError
        For materials, paths and data that make no sense.

    Examples
    --------
    >>> import igimp
    >>> clay = {"model": "tresca", "unit_weight": "18 kN/m3", "young": "10 MPa", "poisson": 0.49, "cu": "30 kPa"}
    >>> test = igimp.element(clay, "triaxial-undrained", strain=0.05)
    >>> round(float(test.table["q [kPa]"].to_numpy()[-1]), 3)
    60.0
    """
    asked = {
        "test": test,
        "path": path,
        "stress": stress,
        "side_stress": side_stress,
        "strain": strain,
        "steps": steps,
        "duration": duration,
        "small_strain": small_strain,
        "data": data,
    }
    return ElementTest(engine.element(source_of(source, material, values), asked_of("the test", asked), law))
