"""Parameters of laws from data of the laboratory."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from . import _html, _toml
from . import _igimp as engine
from ._element import ElementTest, asked_of, source_of
from ._errors import InputError
from ._results import Figure, Figures


@dataclass(frozen=True)
class Parameter:
    """A parameter that was sought.

    Attributes
    ----------
    key, unit : str
        Its key within the material, and the unit of all its values, that of the file.
    start, value : float
        Where the search began and ended; ``value`` is NaN where nothing determines it.
    known : str
        ``standard error``, ``at its lower bound``, ``at its upper bound``, ``least that is accepted``, ``greatest that is accepted``
        (by its law and the tests, beside the others) or ``not determined``.
    error : float or None
        Standard error by linear theory about the best values.
    interval : tuple of float or None
        Ends of the interval that holds it with 95 %, by Student's t.
    traded_for : tuple of str
        The parameters that these data do not tell it from, where it is not determined.
    """

    key: str
    unit: str
    start: float
    value: float
    known: str
    error: float | None
    interval: tuple[float, float] | None
    traded_for: tuple[str, ...]

    @property
    def text(self) -> str | float:
        """The value as a case file takes it: with its unit, or a number."""
        return f"{self.value!r} {self.unit}" if self.unit else self.value


class Fit:
    """Parameters that were found, and how well each is known.

    Attributes
    ----------
    text : str
        What ``igimp fit`` prints of it.
    block : str
        The values as TOML, for the case file.
    parameters : dict
        A :class:`Parameter` by its key, in the order in which they were asked for.
    correlation : array
        Correlation of each pair in that order; NaN where one of the two has no error.
    deviation : float
        Standard deviation of a residual over the scatter that weighs it [-].
    has_kink : bool
        Whether a measurement stands where soil begins to yield: errors are rough.
    tests : list of ElementTest
        Every test with the values found: ``table`` is its curve, ``data`` the measurements beside it.
    """

    def __init__(self, made: engine.Fit) -> None:
        self._made = made
        self.text, self.block = made.text, made.block
        self.deviation, self.has_kink = made.deviation, made.has_kink
        self.parameters: dict[str, Parameter] = {}
        for key, unit, start, value, known, error, interval, traded_for in made.parameters():
            value = float("nan") if known == "not determined" else value
            parameter = Parameter(key, unit, start, value, known, error, interval, tuple(traded_for))
            self.parameters[key] = parameter
        self.correlation = np.array(made.correlation())

    @cached_property
    def tests(self) -> list[ElementTest]:
        return [ElementTest(made) for made in self._made.tests()]

    def __getitem__(self, key: str) -> float:
        """The value of a parameter in the unit of the file."""
        return self.parameters[key].value

    def values(self, material: str) -> dict[str, Any]:
        """What is determined, by the keys of a case with this material: for ``Case.with_values``."""
        found = self.parameters.values()
        name = _toml.key(material)
        return {f"materials.{name}.{row.key}": row.text for row in found if row.known != "not determined"}

    def save(self, folder: str | os.PathLike[str]) -> Figures:
        """Writes ``report.html``, tables and pictures into a folder; the pictures by test, which a notebook shows."""
        folder = Path(folder)
        self._made.write(folder)
        figures = {}
        for at in range(1, len(self.tests) + 1):
            for svg in sorted((folder / f"test-{at}").glob("*.svg")):
                caption = f"test {at}, {svg.stem.replace('-', ' ')}"
                figures[f"test-{at}/{svg.stem}"] = Figure(svg, svg.with_suffix(".png"), caption)
        return Figures(figures)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<igimp.Fit: {self.text.splitlines()[0]}>"

    def _repr_html_(self) -> str:
        return _html.preformatted(self.text)


def fit(
    source: str | os.PathLike[str] | Mapping[str, Any],
    vary: str | Iterable[str] | Mapping[str, Sequence[Any] | None],
    tests: Mapping[str, Any] | Iterable[Mapping[str, Any]],
    *,
    material: str | None = None,
    scatter: Mapping[str, str] | None = None,
    values: Mapping[str, Any] | None = None,
    **all_tests: Any,
) -> Fit:
    """Finds parameters of a law from data of the laboratory, as ``igimp fit`` does.

    Parameters
    ----------
    source : path or dict
        A case file, a file with materials alone, or the keys of one material. The search begins with its values.
    vary : str, list or dict
        Keys of the material, such as ``["young", "softening.cu.residual"]``; with bounds as
        ``{"friction": ("20 deg", "40 deg"), "young": None}``.
    tests : dict or list of dict
        The arguments of :func:`igimp.element` by name, and ``data``: a CSV file, or the columns as a dict or a data frame,
        ``{"strain_yy [%]": [1, 2], "q [kPa]": [40, 60]}``, NaN where nothing was measured. A test goes as far as its data.
    material : str, optional
        Name of the material; needed where there are several.
    scatter : dict, optional
        Standard deviations by quantity, such as ``{"q": "2 kPa"}``. Without it the largest measured values weigh.
    values : dict, optional
        Other values to begin with, by key.
    **all_tests
        Arguments of :func:`igimp.element` that all tests share, such as ``small_strain=True``.

    Raises
    ------
    InputError
        For parameters, tests and data that make no sense; the text names test, file, line and column.
    NotConverged
        If the search does not converge.

    Examples
    --------
    >>> import igimp
    >>> clay = {"model": "tresca", "unit_weight": "18 kN/m3", "young": "10 MPa", "poisson": 0.49, "cu": "20 kPa"}
    >>> data = {"strain_yy [%]": [2, 4, 6], "q [kPa]": [59, 61, 60]}
    >>> fit = igimp.fit(clay, "cu", {"test": "triaxial-undrained", "data": data})
    >>> round(fit["cu"], 3)
    30.0
    """
    of_source = source_of(source, material, values)
    if isinstance(vary, str):
        vary = [vary]
    if not isinstance(vary, Mapping):
        vary = dict.fromkeys(vary)
    for key, bounds in vary.items():
        if bounds is not None and (isinstance(bounds, str) or len(bounds) != 2):
            help_ = 'a lower and an upper one, such as ("20 deg", "40 deg"); None for none'
            raise InputError(f"error: `vary`: bounds of `{key}` are {bounds!r}\n  help: {help_}")
    sought = [(key, None if bounds is None else [str(bound) for bound in bounds]) for key, bounds in vary.items()]
    if isinstance(tests, Mapping):
        tests = [tests]
    asked = [asked_of(f"test {at}", {**all_tests, **test}) for at, test in enumerate(tests, start=1)]
    for at, test in enumerate(asked, start=1):
        if test["data"] is None:
            raise InputError(f"error: test {at}: there are no data\n  help: `data` is a CSV file, or columns by name")
    weights = [(name, str(deviation)) for name, deviation in (scatter or {}).items()]
    return Fit(engine.fit(of_source, sought, asked, weights))
