"""Cases that run in seconds."""

import pytest

import igimp

COARSE = {"grid.cell": {"x": "5 m", "y": "2 m"}}


@pytest.fixture
def slope():
    """The slope on a coarse grid: initial stresses, factor of safety, run-out."""
    return igimp.new("slope").with_values(COARSE)


@pytest.fixture
def short(slope):
    """The slope without its run-out."""
    return slope.with_values({"stages": slope["stages"][:2], "curves": []})


@pytest.fixture
def first(slope):
    """The initial stresses of the slope alone."""
    return slope.with_values({"stages": slope["stages"][:1], "curves": [], "checks": []})


@pytest.fixture
def column():
    """An elastic column under its weight: one stage of gravity, with checks."""
    return igimp.new("column")


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    """Results of the coarse slope."""
    out = tmp_path_factory.mktemp("results") / "slope"
    case = igimp.new("slope").with_values(COARSE | {"output.paraview": {"every": 5}})
    return case.run(out=out, progress=False)
