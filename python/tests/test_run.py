"""GOAL: runs give what the program gives, in memory and in a folder; they can be watched, stopped and gone on with."""

import json
import os
import signal
import sys
import threading
import time
import warnings

import numpy as np
import pytest

import igimp


def test_memory_and_folder_hold_the_same(column, tmp_path):
    kept = column.run(progress=False)
    written = column.run(out=tmp_path / "column", progress=False)
    assert kept.exit_code == written.exit_code == 0 and kept.ending == "done"
    assert [check.met for check in kept.checks] == [check.met for check in written.checks]
    for name in ("x", "sigma", "displacement", "eps_p_eq", "number"):
        assert np.array_equal(getattr(kept.body, name), getattr(written.body, name))
    read = igimp.open(tmp_path / "column")
    assert np.array_equal(read.body.sigma, kept.body.sigma)
    assert read.summary == json.loads(json.dumps(written.summary))
    assert str(read) == str(kept) and "checks" in str(kept)
    assert set(read.sections) == set(kept.sections)
    for name in kept.sections:
        assert list(read.sections[name]) == list(kept.sections[name])
        assert np.allclose(read.sections[name], kept.sections[name], rtol=1e-8)


def test_arrays_have_their_shapes_and_signs(column):
    body = column.run(progress=False).body
    n = len(body)
    assert body.x.shape == (n, 2) and body.sigma.shape == (n, 3, 3) and body.law.shape == (n,)
    assert body.sigma.flags.writeable and body.mean_stress.max() < 0 < body.q.max()
    assert np.allclose(body.total_stress, body.sigma)
    assert np.isclose(body.volume.sum(), (body.volume0 * np.linalg.det(body.def_grad)).sum())
    assert set(body.material) <= set(column.materials)
    frame = body.to_frame()
    assert len(frame) == n and "sigma_yy [Pa] tension +" in frame


def test_any_number_of_threads_gives_the_same_bits(first):
    one, two = (first.run(threads=threads, progress=False).body for threads in (1, 2))
    assert np.array_equal(one.sigma, two.sigma)


def test_a_factor_of_safety_is_an_interval(folder):
    stable, failed = folder.factor_of_safety_interval
    assert 1.2 < stable < folder.factor_of_safety < failed < 1.5
    stage = folder.stages[1]
    assert stage.kind == "strength-reduction" and stage.details["safety"]["path"]["points"]
    assert folder.stages[stage.name] is stage and stage.name in folder.stages._ipython_key_completions_()
    with pytest.raises(KeyError, match="there is no stage 'weight'; stages: "):
        folder.stages["weight"]
    assert folder.checks[0].met and folder.checks[0].band == "1.2 … 1.45"
    assert folder.raise_for_failure() is folder


def test_pictures_report_and_frames_are_found(folder):
    assert folder.report.exists()
    assert folder.figures and all(figure.svg.exists() and figure.png.exists() for figure in folder.figures.values())
    assert "<img" in folder.figures._repr_html_() and "factor of safety" in folder._repr_html_()
    assert folder.frames and folder.frames[-1][1].exists()
    history = folder.monitors["crest"]
    assert any("displacement" in column for column in history)
    pyvista = pytest.importorskip("pyvista")
    assert isinstance(folder.frame(-1), pyvista.DataSet)


def test_a_run_in_memory_says_what_it_lacks(column):
    kept = column.run(progress=False)
    for what in ("report", "figures", "frames"):
        with pytest.raises(igimp.InputError, match="in memory"):
            getattr(kept, what)
    assert "in memory" in kept._repr_html_()


def test_results_of_another_case_are_not_replaced(column, slope, tmp_path):
    column.run(out=tmp_path, progress=False)
    with pytest.raises(igimp.InputError, match="overwrite=True"):
        slope.run(out=tmp_path, progress=False)
    with pytest.raises(igimp.FileError):
        igimp.open(tmp_path / "nothing")


def test_want_of_equilibrium_is_a_result(column):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        weak = column.with_values({"solver.max_iterations": 1, "solver.step_cutting.times": 0})
        found = weak.run(progress=False)
    assert found.exit_code == 3 and found.failure and found.ending == "not converged"
    with pytest.raises(igimp.NotConverged):
        found.raise_for_failure()
    # A check of a stage that did not come to its end is told as the program tells it.
    asked = {check.name: check for check in found.checks}["height over initial height"]
    assert asked.verdict == "not reached" and asked.standing == "not-reached" and not asked.met
    assert str(found).count("NOT REACHED") == sum(check.verdict == "not reached" for check in found.checks)
    assert "NOT REACHED" in found._repr_html_()


def test_a_check_is_told_in_the_unit_of_its_case():
    # By hand: 1 kPa is 1000 Pa.
    stated = {"quantity": "q", "expected": 45e3, "source": "s", "unit": {"name": "kPa", "in_si": 1000.0}}

    def check(measured, band, **row):
        return igimp.Check.of({"check": {**stated, "measured": measured, "band": band}, **row})

    held = check(44e3, {"between": [40e3, 50e3]}, **{"pass": True}, standing="held")
    assert (held.value, held.reference, held.verdict) == (44e3, 45e3, "met")
    assert str(held) == "q: 44 kPa, expected 45 kPa, 40 … 50 kPa (s)"
    lost = check(None, {"at-most": 50e3}, **{"pass": False}, standing="not-reached")
    assert (lost.verdict, lost.printed, lost.band) == ("not reached", "-", "≤ 50 kPa")
    safe = check(1.6e8, {"at-least": 45e3}, **{"pass": True}, standing="nothing-fails")
    assert (safe.verdict, safe.printed) == ("met", "> 1000")
    # Summaries of before say neither.
    old = {"quantity": "q", "expected": 2.0, "source": "s", "measured": 3.0, "band": {"relative": 0.01}}
    old = igimp.Check.of({"check": old, "pass": False})
    assert (old.verdict, old.printed, old.band, old.unit) == ("missed", "3", "± 1 %", "")


def test_a_missed_reference_is_told(column):
    column["checks.0.expected"] = 0.6
    found = column.run(progress=False)
    assert found.exit_code == 1 and not found.checks[0].met and found.ending == "reference missed"
    with pytest.raises(igimp.ReferenceMissed, match="height over initial height"):
        found.raise_for_failure()


def test_steps_are_seen_and_may_end_the_run(slope):
    seen = []

    def look(step):
        seen.append(step)
        return len(seen) < 4

    found = slope.run(progress=False, callback=look)
    assert len(seen) == 4 and found.interrupted and found.ending == "interrupted"
    assert [step.number for step in seen] == [1, 2, 3, 4] and seen[0].stage == "initial stresses"
    assert seen[-1].residual < 1e-6 and seen[-1].body.x.shape[1] == 2
    assert seen[0].load_factor < seen[-1].load_factor <= 1


def test_what_a_callback_raises_ends_the_run(slope, tmp_path):
    def fail(step):
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        slope.run(out=tmp_path / "r", progress=False, callback=fail)
    left = igimp.open(tmp_path / "r")
    assert left.interrupted and left.stages[0].steps == 1 and left.body.displacement.any()


def test_a_march_is_step_by_step(slope):
    march = slope.march()
    depth = []
    for step in march:
        depth.append(step.body.displacement[:, 1].min())
        if step.stage != "initial stresses" or step.number == 6:
            march.stop()
    assert len(depth) == 6 and depth == sorted(depth, reverse=True)
    assert march.results.interrupted


def test_leaving_the_loop_ends_the_run_and_it_can_go_on(first, tmp_path):
    case = first.with_values({"output.checkpoint.every": 1})
    for step in case.march(out=tmp_path / "stopped", bodies=False):
        assert step.body is None
        if step.number == 3:
            break
    # The folder is free at once.
    resumed = case.run(out=tmp_path / "stopped", resume=True, progress=False)
    whole = case.run(out=tmp_path / "whole", progress=False)
    assert resumed.exit_code == 0
    assert np.array_equal(resumed.body.sigma, whole.body.sigma)
    for file in ("monitors/crest.csv", "convergence.csv"):
        assert (tmp_path / "stopped" / file).read_bytes() == (tmp_path / "whole" / file).read_bytes()


def test_ways_to_begin_exclude_each_other(column, tmp_path):
    for ways in ({"resume": True, "overwrite": True}, {"resume": True, "from_stage": "x"}):
        with pytest.raises(ValueError, match="exclude each other"):
            column.run(out=tmp_path / "r", **ways)


def test_threads_that_no_computer_uses_are_refused(column):
    with pytest.raises(igimp.InputError, match="100000 threads are too many: at most"):
        column.run(threads=100_000)
    with pytest.raises(ValueError, match="threads = -1"):
        column.run(threads=-1)


def test_ctrl_c_ends_the_run_after_its_step(slope, tmp_path):
    def interrupt(step):
        if step.number == 2:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0.01)

    with pytest.raises(igimp.Interrupted, match="resume=True") as caught:
        slope.run(out=tmp_path / "r", progress=False, callback=interrupt)
    assert caught.value.results.interrupted and isinstance(caught.value, KeyboardInterrupt)
    assert slope.run(out=tmp_path / "r", progress=False, resume=True).exit_code == 0


def test_python_goes_on_while_the_engine_computes(slope):
    counts = []

    def count():
        while not done.is_set():
            counts.append(None)
            time.sleep(0.001)

    done = threading.Event()
    other = threading.Thread(target=count)
    other.start()
    slope.run(progress=False)
    done.set()
    other.join()
    assert len(counts) > 20


def test_progress_is_lines_or_a_bar(column, capsys):
    column.run(progress="lines")
    assert "stage 1/" in capsys.readouterr().out
    column.run(progress=True)
    captured = capsys.readouterr()
    assert "[=" in captured.err and not captured.out
    column.run()
    assert capsys.readouterr() == ("", "")


def test_a_study_of_the_mesh_is_an_object(column):
    found = column.run(meshes=2, progress=False)
    study = found.mesh_study
    assert study.meshes == ("h", "h/2") and all(len(result.values) == 2 for result in study)
    assert "<table>" in study._repr_html_()


def test_tables_are_dicts_of_arrays_without_pandas(folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    history = folder.monitors["crest"]
    assert isinstance(history, dict) and all(isinstance(column, np.ndarray) for column in history.values())


def test_a_motion_has_velocity_energy_and_times(tmp_path):
    """GOAL: what moves in time is read by name. ORACLE: ½ Σ m v² of the arrays is the kinetic energy of the table."""
    case = igimp.new("column_collapse").with_values({"grid.cell": "2 cm", "stages.collapse.duration": "0.1 s"})
    short = case.with_values({"stages.collapse.steps": 5, "output.paraview": {"every": 1}})
    results = short.run(out=tmp_path / "results", progress=False)
    body, energy = results.body, results.energy
    assert body.velocity.shape == body.acceleration.shape == body.x.shape
    kinetic = 0.5 * (body.mass * body.speed**2).sum()
    last = np.asarray(energy["kinetic_[J/m]"])[-1]
    assert last > 0 and abs(kinetic - last) < 1e-8 * last
    times = [seconds for seconds, _ in results.motion("collapse")]
    assert np.allclose(times, [0, 0.02, 0.04, 0.06, 0.08, 0.1])
    assert all(file.exists() for _, file in results.motion())
    with pytest.raises(igimp.InputError):
        results.motion("another")


def test_a_body_at_rest_has_no_velocity(tmp_path):
    results = igimp.new("column").run(out=tmp_path / "results", progress=False)
    assert not results.body.velocity.any() and results.energy is None
    assert not any(name.startswith("v_") for name in results.body.to_frame().columns)
