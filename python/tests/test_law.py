"""GOAL: a law that is written in Python is asked as the laws of the engine are.

ORACLE: the laws of the engine.
"""

import sys

import numpy as np
import pytest

import igimp


class Elastic(igimp.Law):
    """Hencky elasticity."""

    symmetric = True
    yields = False

    def return_map(self, strain, eps_p_eq, elastic):
        return elastic.stress(strain), np.broadcast_to(elastic.tangent, (len(strain), 3, 3))


class VonMises(igimp.Law):
    """Perfectly plastic von Mises with undrained strength ``c_u`` in plane strain [Pa]."""

    symmetric = True

    def __init__(self, c_u):
        self.c_u = c_u

    def return_map(self, strain, eps_p_eq, elastic):
        trial = elastic.stress(strain)
        s = trial - trial.mean(axis=1, keepdims=True)
        norm = np.linalg.norm(s, axis=1)
        radius = np.sqrt(2) * self.c_u
        over = norm > radius
        share = np.where(over, radius / np.where(over, norm, 1), 1)[:, None]
        tau = trial - s + share * s
        n = s / np.where(norm > 0, norm, 1)[:, None]
        deviator = np.eye(3) - 1 / 3
        soft = 2 * elastic.shear * share[:, :, None] * (deviator - over[:, None, None] * n[:, :, None] * n[:, None, :])
        return tau, elastic.bulk * np.ones((3, 3)) + soft

    def reduced(self, srf):
        return VonMises(self.c_u / srf)


@pytest.fixture
def clay():
    """A von Mises slope on a coarse grid, loaded until it yields."""
    return igimp.new("von_mises_slope").with_values({"grid.cell": {"x": "1 m", "y": "0.5 m"}})


def test_an_elastic_law_gives_what_the_engine_gives(column):
    built_in = column.run(progress=False).body
    name = column.materials[0]
    law = column.with_laws({name: Elastic()}).run(progress=False).body
    assert np.allclose(law.sigma, built_in.sigma, rtol=1e-9, atol=1e-9 * abs(built_in.sigma).max())
    assert law.regime.max() == 0


def test_a_plastic_law_takes_the_steps_of_the_engine(clay):
    steps = {"engine": [], "python": []}
    cases = {"engine": clay, "python": clay.with_laws({"clay": VonMises(45e3)})}
    found = {}
    for who, case in cases.items():
        march = case.march()
        for step in march:
            steps[who].append(step.iterations)
        found[who] = march.results.body
    assert steps["engine"] == steps["python"]
    assert np.allclose(found["python"].x, found["engine"].x, atol=1e-9)
    assert np.allclose(found["python"].eps_p_eq, found["engine"].eps_p_eq, atol=1e-9)


def test_results_tell_of_the_law_that_ran(column, tmp_path):
    (name,) = column.materials
    found = column.with_laws({name: Elastic()}).run(out=tmp_path / "r", progress=False)
    (materials,) = [part for part in found.summary["setup"] if part["title"] == "Materials"]
    assert materials["rows"][0][1] == "law in Python" and "Elastic()" in materials["rows"][0][5]
    assert "law in Python" in (tmp_path / "r" / "report.html").read_text()


def test_strength_of_a_law_is_reduced(short):
    found = short.with_laws({"clay": VonMises(60e3)}).run(progress=False)
    assert found.factor_of_safety > 1


def test_what_a_law_raises_is_raised(column):
    class Broken(Elastic):
        def return_map(self, strain, eps_p_eq, elastic):
            raise ZeroDivisionError("in the law")

    class Narrow(Elastic):
        def return_map(self, strain, eps_p_eq, elastic):
            return strain[:, :2], np.zeros((len(strain), 3, 3))

    class Alone(Elastic):
        def return_map(self, strain, eps_p_eq, elastic):
            return elastic.stress(strain)

    class Skew(Elastic):
        symmetric = True

        def return_map(self, strain, eps_p_eq, elastic):
            tau, tangent = super().return_map(strain, eps_p_eq, elastic)
            tangent = np.array(tangent)
            tangent[:, 0, 1] += 0.1 * tangent[:, 0, 0]
            return tau, tangent

    name = column.materials[0]
    with pytest.raises(ValueError, match="return_map of Alone must answer stress and tangent"):
        column.with_laws({name: Alone()}).run(progress=False)
    with pytest.raises(ValueError, match="return_map of Skew says symmetric = True"):
        column.with_laws({name: Skew()}).run(progress=False)
    with pytest.raises(ZeroDivisionError, match="in the law") as caught:
        column.with_laws({name: Broken()}).run(progress=False)
    if sys.version_info >= (3, 11):
        [note] = caught.value.__notes__
        assert "raised by the law" in note and "Broken" in note
        assert note.endswith(f'of material "{name}" in return_map')
    with pytest.raises(ValueError, match="must answer arrays of shape"):
        column.with_laws({name: Narrow()}).run(progress=False)
    with pytest.raises(KeyError, match="there is no material"):
        column.with_laws({"sand": Elastic()})


def test_a_run_goes_on_with_the_same_law_only(clay, tmp_path):
    def begun(c_u):
        return clay.with_laws({"clay": VonMises(c_u)})

    march = begun(45e3).march(out=tmp_path, bodies=False)
    next(march)
    march.close()
    with pytest.raises(igimp.InputError, match="other case or to other input"):
        begun(46e3).run(out=tmp_path, resume=True, progress=False)
    assert len(begun(45e3).run(out=tmp_path, resume=True, progress=False).stages) == 1
