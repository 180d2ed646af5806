"""GOAL: a law is driven on its own from Python, one of the engine or one written in Python.

ORACLE: closed forms of failure; von Mises of the engine against von Mises in Python.
"""

import numpy as np
import pytest
from test_law import VonMises

import igimp

SAND = {
    "model": "mohr-coulomb",
    "unit_weight": "18 kN/m3",
    "young": "40 MPa",
    "poisson": 0.3,
    "cohesion": "5 kPa",
    "friction": "30 deg",
    "dilation": "0 deg",
}
CLAY = {"model": "von-mises", "unit_weight": "18 kN/m3", "young": "10 MPa", "poisson": 0.49, "cu": "30 kPa"}


def column(test, name):
    return np.asarray(test.table[name], dtype=float)


def test_failure_has_its_closed_form():
    test = igimp.element(SAND, stress="100 kPa", strain=0.05, small_strain=True)
    assert test.failure is None
    # σ_1 = K_p σ_3 + 2 c √K_p with K_p = 3.
    assert column(test, "q [kPa]")[-1] == pytest.approx(2 * 100 + 2 * 5 * 3**0.5, rel=1e-9)
    twice = igimp.element(SAND, stress=200e3, strain=0.05, small_strain=True)
    assert column(twice, "q [kPa]")[-1] == pytest.approx(2 * 200 + 2 * 5 * 3**0.5, rel=1e-9)


def test_a_law_in_python_is_driven():
    ours = igimp.element(CLAY, "simple-shear-undrained", strain=0.05, steps=20, small_strain=True)
    law = VonMises(30e3)
    given = igimp.element(CLAY, "simple-shear-undrained", strain=0.05, steps=20, small_strain=True, law=law)
    ours, theirs = column(ours, "tau_xy [kPa]"), column(given, "tau_xy [kPa]")
    assert ours[-1] == pytest.approx(30, rel=1e-6)
    # What is told is of the law that is driven.
    assert given.text.startswith("soil: law in Python, simple shear undrained")
    assert "VonMises(" in given.text and "closed form" not in given.text
    np.testing.assert_allclose(theirs, ours, rtol=1e-8, atol=1e-8)


def test_an_error_of_a_law_comes_through():
    class Broken(igimp.Law):
        def return_map(self, strain, eps_p_eq, elastic):
            raise RuntimeError("no stress today")

    with pytest.raises(RuntimeError, match="no stress today"):
        igimp.element(CLAY, law=Broken())


def test_files_values_and_pictures(tmp_path):
    file = tmp_path / "soils.toml"
    igimp.new("slope").save(file)
    stronger = igimp.element(file, material="clay", values={"materials.clay.cohesion": "25 kPa"}, strain=0.05)
    weaker = igimp.element(file, material="clay", strain=0.05)
    assert column(stronger, "q [kPa]")[-1] > column(weaker, "q [kPa]")[-1]
    pictures = stronger.save(tmp_path / "results")
    assert set(pictures) >= {"stress-strain", "stress-path"}
    assert all(picture.svg.is_file() and picture.png.is_file() for picture in pictures.values())
    assert (tmp_path / "results" / "element.csv").is_file()
    assert "triaxial drained" in str(stronger)


def test_what_makes_no_sense_is_refused(tmp_path):
    with pytest.raises(igimp.InputError, match="there is no test `squeeze`"):
        igimp.element(SAND, "squeeze")
    with pytest.raises(igimp.InputError, match="stress"):
        igimp.element(SAND, stress="100 m")
    for values, match in [
        ({"strain": float("nan")}, "the strain is NaN"),
        ({"strain": float("inf")}, "the strain is inf"),
        ({"strain": 20.0}, "the strain is 20"),
        ({"stress": float("nan")}, "the axial stress is NaN"),
        ({"side_stress": float("inf")}, "the stress at the sides is inf"),
        ({"duration": float("nan")}, "the duration is NaN"),
        ({"duration": -1.0}, "the duration is -1"),
    ]:
        with pytest.raises(igimp.InputError, match=match):
            igimp.element(SAND, **values)
    with pytest.raises(igimp.InputError, match="unknown field `colour`"):
        igimp.element({**SAND, "colour": "red"})
    file = tmp_path / "soils.toml"
    igimp.new("embankment").save(file)
    with pytest.raises(igimp.InputError, match="several materials"):
        igimp.element(file)
