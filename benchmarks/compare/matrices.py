"""Tangents of the two slopes of the paper, exported by `igimp run` at several sizes of cell."""

import json
import shutil
import subprocess
from pathlib import Path

# Two load steps of gravity; the second correction of the last one is exported.
QUIET = [
    "checks=[]",
    "curves=[]",
    "output.report=false",
    "output.figures=[]",
    "output.paraview.every=never",
    "solver.tolerance=1e-6",
    "solver.step_cutting={ times = 1, factor = 0.5 }",
]
SIZES = [20_000, 80_000, 320_000, 500_000]


def von_mises(cells):
    """The von Mises slope at half its weight with so many cells per metre: K is symmetric."""
    return [
        f"grid.cell=1/{cells} m",
        f"grid.domain={{ x = ['0 m', '40 m'], y = ['0 m', '{15 * cells + 1}/{cells} m'] }}",
        "stages.0.steps=2",
        "stages.0.factor=0.5",
    ]


def mohr_coulomb(cells):
    """The Mohr-Coulomb slope, psi = 0, at 0.8 of its weight with so many cells per 2 m: K is not
    symmetric."""
    return [
        f"grid.cell=2/{cells} m",
        f"grid.domain={{ x = ['0 m', '36 m'], y = ['0 m', '{10 * cells + 2}/{cells} m'] }}",
        "stages=[{ name = 'own weight', type = 'gravity', factor = 0.8, steps = 2 }]",
    ]


# By kind: the case, its settings, and the cells for each size.
KINDS = {
    "symmetric": ("von_mises_slope", von_mises, [5, 10, 20, 25]),
    "unsymmetric": ("mohr_coulomb_slope", mohr_coulomb, [14, 27, 54, 67]),
}


def make(igimp, cases, folder, kind, size):
    """The folder of a system of about `size` unknowns; it is made if it does not exist."""
    name, settings, cells = KINDS[kind]
    system = folder / f"{kind}-{size}" / "stage-01"
    about = system / "matrix.json"
    if about.is_file() and json.loads(about.read_text())["symmetric"] == (kind == "symmetric"):
        return system
    print(f"making {kind}-{size} with igimp run ...", flush=True)
    results = folder / "run"
    command = [igimp, "run", Path(cases) / f"{name}.toml", "--quiet", "--out", results]
    command += ["--export-matrix", system.parent]
    for setting in settings(cells[SIZES.index(size)]) + QUIET:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"igimp run ends with {done.returncode}:\n{done.stderr}{done.stdout}")
    shutil.rmtree(results)
    return system


# Cubes of soil, by what they are called: soil and Poisson's ratio of the program `cube_system`.
CUBES = {
    "elastic, ν = 0.3": ("hencky-elastic", 0.3),
    "elastic, ν = 0.49": ("hencky-elastic", 0.49),
    "von Mises, ν = 0.3": ("von-mises", 0.3),
    "von Mises, ν = 0.49": ("von-mises", 0.49),
    "Mohr–Coulomb, ψ = 0": ("mohr-coulomb", 0.3),
}


def make_cube(program, folder, kind, cells):
    """The folder of the system of a cube; it is made if it does not exist."""
    soil, poisson = CUBES[kind]
    system = folder / f"cube-{soil}-{poisson}-{cells}"
    if not (system / "matrix.json").is_file():
        print(f"making a cube, {kind}, {cells} cells a side ...", flush=True)
        command = [program, system, "--cells", str(cells), "--soil", soil]
        subprocess.run([*command, "--poisson", str(poisson)], check=True)
    return system
