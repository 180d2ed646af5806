"""GOAL: parameters are found from Python as by `igimp fit`: values, errors, correlations, curves, report, places.

ORACLE: least squares of SciPy on the closed form of the test, with Student's t; the slope of a line by numpy.
"""

import numpy as np
import pytest
from scipy.optimize import curve_fit
from scipy.stats import t as student

import igimp

SAND = {
    "model": "mohr-coulomb",
    "unit_weight": "18 kN/m3",
    "young": "20 MPa",
    "poisson": 0.3,
    "cohesion": "2 kPa",
    "friction": "30 deg",
}
STRAINS = np.array([0.1, 0.2, 0.4, 0.8, 1.5, 2.5, 4, 6])
SIDES = np.array([50.0, 100.0, 200.0])
AXIAL = "strain_yy, compression positive [%]"
KEYS = ["young", "cohesion", "friction"]


def strength(side, cohesion, friction):
    """σ_3 (K_p - 1) + 2 c √K_p."""
    passive = (1 + np.sin(np.radians(friction))) / (1 - np.sin(np.radians(friction)))
    return side * (passive - 1) + 2 * cohesion * np.sqrt(passive)


def curve(places, young, cohesion, friction):
    """q [kPa] at strains [%] under cell pressures [kPa]: elastic up to the strength."""
    strain, side = places
    return np.minimum(10 * young * strain, strength(side, cohesion, friction))


@pytest.fixture(scope="module")
def measured():
    scatter = np.random.default_rng(7).normal(0, 2, (len(SIDES), len(STRAINS)))
    return np.array([curve((STRAINS, side), 30, 5, 34) for side in SIDES]) + scatter


def cells_of(measured):
    tests = zip(SIDES, measured)
    return [{"stress": f"{side} kPa", "data": {"strain_yy [%]": STRAINS, "q [kPa]": q}} for side, q in tests]


def test_values_errors_and_correlations_are_those_of_scipy(measured):
    fit = igimp.fit(SAND, KEYS, cells_of(measured), small_strain=True)
    places = np.array([(strain, side) for side in SIDES for strain in STRAINS]).T
    best, covariance = curve_fit(curve, places, measured.ravel(), p0=[25, 4, 32], xtol=1e-12, ftol=1e-12)
    errors = np.sqrt(np.diag(covariance))
    assert list(fit.parameters) == KEYS and not fit.has_kink
    np.testing.assert_allclose([fit[key] for key in KEYS], best, rtol=1e-5)
    np.testing.assert_allclose([row.error for row in fit.parameters.values()], errors, rtol=1e-4)
    np.testing.assert_allclose(fit.correlation, covariance / np.outer(errors, errors), atol=1e-4)
    young = fit.parameters["young"]
    assert young.unit == "MPa" and young.start == 20
    for row in fit.parameters.values():
        half = student.ppf(0.975, measured.size - len(KEYS)) * row.error
        np.testing.assert_allclose(row.interval, [row.value - half, row.value + half], rtol=1e-6)
    # The curves go through the computed values that stand beside the measurements.
    for side, q, test in zip(SIDES, measured, fit.tests):
        np.testing.assert_allclose(np.asarray(test.data["measured: q [kPa]"]), q, rtol=1e-12)
        computed = np.asarray(test.data["computed: q [kPa]"])
        np.testing.assert_allclose(computed, curve((STRAINS, side), *best), rtol=1e-4)
        along, up = (np.asarray(test.table[name], dtype=float) for name in (AXIAL, "q [kPa]"))
        np.testing.assert_allclose(np.interp(STRAINS, along, up), computed, rtol=1e-9)


def test_a_line_has_the_error_of_its_slope():
    elastic = {"model": "elastic", "unit_weight": "18 kN/m3", "young": "15 MPa", "poisson": 0.3}
    strain = np.array([0.2, 0.4, 0.6, 0.8, 1.0])
    stress = np.array([29.0, 53.0, 84.0, 105.0, 137.0])
    data = {"strain_yy [%]": strain, "sigma_yy [kPa]": 50 + stress}
    test = {"test": "oedometer", "stress": "50 kPa", "data": data, "steps": 1}
    fit = igimp.fit(elastic, "young", test, small_strain=True)
    slope = strain @ stress / (strain @ strain) / 10  # MPa
    error = np.sqrt(np.sum((stress - 10 * slope * strain) ** 2) / 4 / (strain @ strain)) / 10
    share = 1.3 * 0.4 / 0.7
    assert fit["young"] == pytest.approx(slope * share, rel=1e-7)
    assert fit.parameters["young"].error == pytest.approx(error * share, rel=1e-6)


def test_data_are_files_dicts_and_frames_alike(measured, tmp_path):
    pandas = pytest.importorskip("pandas")
    columns = {"strain_yy [%]": STRAINS, "q [kPa]": measured[1]}
    pandas.DataFrame(columns).to_csv(tmp_path / "cell.csv", index=False)
    (tmp_path / "sand.toml").write_text(
        "igimp = 1\n[materials.sand]\n" + "".join(f"{key} = {value!r}\n".replace("'", '"') for key, value in SAND.items())
    )
    of_file = igimp.fit(tmp_path / "sand.toml", ["young"], {"data": "cell.csv"}, steps=20, small_strain=True)
    for data in (columns, pandas.DataFrame(columns)):
        found = igimp.fit(SAND, ["young"], {"data": data}, steps=20, small_strain=True)
        assert found["young"] == of_file["young"]
    # What was found drives the same curve, by the keys of a file.
    found = of_file.values("sand")
    again = igimp.element(tmp_path / "sand.toml", values=found, strain=0.06, steps=20, small_strain=True)
    peak = np.asarray(again.table["q [kPa]"], dtype=float).max()
    assert peak == pytest.approx(np.asarray(of_file.tests[0].table["q [kPa]"], dtype=float).max(), rel=1e-9)


def test_what_is_not_known_has_no_number(measured):
    one = cells_of(measured)[1]
    fit = igimp.fit(SAND, ["cohesion", "friction"], one, values={"materials.soil.young": "30 MPa"}, small_strain=True)
    cohesion = fit.parameters["cohesion"]
    assert cohesion.known == "not determined" and cohesion.traded_for == ("friction",)
    assert np.isnan(cohesion.value) and cohesion.error is None and np.isnan(fit.correlation).all()
    assert fit.values("sand") == {}
    bounds = {"friction": ("25 deg", "31 deg")}
    held = igimp.fit(SAND, bounds, one, small_strain=True).parameters["friction"]
    assert held.known == "at its upper bound" and held.value == pytest.approx(31)


def test_a_fit_is_saved_as_a_report(measured, tmp_path):
    fit = igimp.fit(SAND, KEYS, cells_of(measured), small_strain=True, steps=20)
    pictures = fit.save(tmp_path)
    assert {"test-1/stress-strain", "test-3/residuals"} <= set(pictures)
    page = (tmp_path / "report.html").read_text()
    for part in ("Parameters", "Correlations", "Differences", "Test 3", "For the case file", "data:image/svg+xml"):
        assert part in page
    for name in ("fit.csv", "correlation.csv", "fit.toml", "test-2/data.csv"):
        assert (tmp_path / name).is_file()
    assert str(fit).startswith("soil: Mohr–Coulomb, 3 parameters from 3 tests, 24 values")


def test_what_makes_no_sense_is_refused_with_its_place(measured):
    good = cells_of(measured)[0]
    columns = good["data"]

    def refused(match, vary="young", test=good, **more):
        with pytest.raises(igimp.InputError, match=match):
            igimp.fit(SAND, vary, [good, test], **more)

    refused("no value of `colour` to begin with", vary="colour")
    refused("no parameter is sought", vary=[])
    refused("no parameter is sought", vary={})
    refused("test 2: the duration is -1", test={**good, "duration": -1.0})
    refused("`friction` begins at 30 deg, which is not between", vary={"friction": ("40 deg", "50 deg")})
    refused("bounds of `friction` are '40 deg'", vary={"friction": "40 deg"})
    refused("test 2: there is no argument `cell`", test={**good, "cell": 50})
    refused("test 2: there are no data", test={"stress": "50 kPa"})
    refused("test 2: there is no test `squeeze`", test={**good, "test": "squeeze"})
    refused("test 2: `stress`", test={**good, "stress": "50 m"})
    refused("test 2: columns of the data differ in length", test={"data": {**columns, "p [kPa]": [1]}})
    slip = {"strain_yy [%]": [1, 2], "q [kPa]": [40, "many"]}
    refused(r"test 2: data, line 3, column `q \[kPa\]`: `many` is no number", test={"data": slip})
    refused("nothing was measured at any strain", test={"data": {"strain_yy [%]": [0], "q [kPa]": [0]}})
    refused("`scatter`: `colour` is no quantity", scatter={"colour": "2 kPa"})
    refused("`scatter`: `2 m` is no standard deviation of `q`", scatter={"q": "2 m"})
    with pytest.raises(igimp.InputError, match="2 values were measured, and 2 parameters"):
        two = {"data": {"strain_yy [%]": [1, 2], "q [kPa]": [40, 60]}}
        igimp.fit(SAND, ["young", "friction"], two)
