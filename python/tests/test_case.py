"""GOAL: a case is read, changed, checked and explained as by the program, with its messages."""

import copy
import pickle
import subprocess
import sys

import pytest

import igimp


def test_values_are_set_with_units_and_read_back(slope):
    slope["materials.clay.cohesion"] = "12 kPa"
    slope["stages.run-out.steps"] = 20
    slope["boundaries.left"] = "fixed"
    assert slope["materials.clay.cohesion"] == "12 kPa"
    assert slope["stages.run-out.steps"] == 20
    keys = slope._ipython_key_completions_()
    assert {"grid.cell", "materials.clay.cohesion", "stages.run-out.steps"} <= set(keys)
    assert all(slope[key] is not None for key in keys)
    assert slope["grid.cell"] == {"x": "5 m", "y": "2 m"}
    assert slope["bodies.0.name"] == "slope"
    assert slope.settings["materials.clay.cohesion"] == '"12 kPa"'
    with pytest.raises(KeyError):
        slope["materials.sand"]


def test_a_wrong_value_is_refused_where_it_is_set(slope):
    before = slope.to_toml()
    with pytest.raises(igimp.InputError, match="did you mean `cohesion`") as caught:
        slope["materials.clay.cohesoin"] = "12 kPa"
    assert caught.value.exit_code == 2
    first = caught.value.diagnostics[0]
    assert first["is_error"] and "cohesoin" in first["message"] and first["setting"] == 1
    with pytest.raises(igimp.InputError):
        slope["materials.clay.cohesion"] = "12 kg"
    with pytest.raises(TypeError):
        slope["materials.clay.cohesion"] = object()
    assert slope.to_toml() == before


def test_copies_do_not_know_of_each_other(slope):
    other = slope.with_values({"materials.clay.cohesion": "5 kPa"})
    third = copy.copy(other)
    third["materials.clay.cohesion"] = "6 kPa"
    assert slope["materials.clay.cohesion"] == "20 kPa"
    assert other["materials.clay.cohesion"] == "5 kPa"
    assert pickle.loads(pickle.dumps(third)).to_toml() == third.to_toml()


def test_text_file_and_dict_state_the_same_case(slope, tmp_path):
    text = slope.to_toml()
    slope.save(tmp_path / "slope.toml")
    from_file = igimp.Case.from_file(tmp_path / "slope.toml")
    from_text = igimp.Case.from_string(text)
    from_dict = igimp.Case.from_dict(slope.to_dict())
    assert from_file.to_toml() == from_text.to_toml() and slope.explain() == text
    assert from_file.to_dict() == from_dict.to_dict() == slope.to_dict()


@pytest.mark.parametrize("name", igimp.templates())
def test_every_template_goes_through_a_dict(name):
    case = igimp.new(name)
    assert igimp.Case.from_dict(case.to_dict()).to_dict() == case.to_dict()


def test_numbers_of_numpy_are_numbers(slope):
    import numpy

    slope["materials.clay.poisson"] = numpy.float64(0.25)
    slope["grid.refine"] = numpy.int64(1)
    assert slope["materials.clay.poisson"] == 0.25


def test_names_that_are_not_there_are_told(tmp_path):
    with pytest.raises(igimp.InputError, match="did you mean `slope`"):
        igimp.new("slop")
    with pytest.raises(igimp.FileError, match="nothing.toml") as caught:
        igimp.Case.from_file(tmp_path / "nothing.toml")
    assert caught.value.exit_code == 4 and isinstance(caught.value, OSError)
    (tmp_path / "study.toml").write_text("igimp_sweep = 1\n")
    with pytest.raises(igimp.InputError, match="is a sweep, not a case"):
        igimp.Case.from_file(tmp_path / "study.toml")


def test_the_size_of_a_case_is_told(slope):
    cost = slope.check()
    assert "slope.toml is fine" in str(cost) and "factor of safety" in str(cost)
    assert cost.particles > 100 and cost.bytes > 0 and cost.seconds > 0
    assert slope.dimensions == 2 and slope.materials == ("clay", "rock")
    assert slope.stages == ("initial stresses", "factor of safety", "run-out")
    assert "<table>" in slope._repr_html_() and "<pre>" in cost._repr_html_()


def test_a_study_of_the_mesh_is_told_with_all_its_meshes(slope):
    alone, study = slope.check(), slope.with_values({"mesh_study.meshes": 3}).check()
    assert study.seconds > 2 * alone.seconds and study.bytes > 2 * alone.bytes
    assert study.particles == alone.particles


def test_nothing_is_imported_that_is_not_needed():
    """Importing brings in no package that is not needed."""
    code = "import igimp, sys; assert not {'pandas', 'pyvista', 'matplotlib', 'IPython'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
