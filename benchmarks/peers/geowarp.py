"""Column and slope in von Mises soil in GeoWarp.

    git clone https://github.com/choo-group/GeoWarp && pip install -r GeoWarp/requirements.txt
    python benchmarks/peers/geowarp.py GeoWarp column --cells 64
    python benchmarks/peers/geowarp.py GeoWarp von_mises_slope

Its class quasi_static_solver_2d is called and nothing of it is changed. It fills rectangles: the points of the slope are
put in their place. Its plane solver has elastic and von Mises soil, and holds nodes where they are: neither a slope of
Mohr-Coulomb soil nor a footing that is pushed can be stated. Lengths in metres, forces in kN.

Prints one line of JSON, as kratos.py does.
"""

import argparse
import json
import math
import sys
import time

import numpy as np


def solver_of(shape, spacing, box, count, material, unit_weight, per_side):
    import warp
    from solvers.quasi_static_solver_2d import quasi_static_solver_2d

    columns, rows = shape
    # A cell of margin at the left and below, as in its own examples.
    start, (width, height) = spacing, box
    grid = {"n_grid_x": columns, "n_grid_y": rows, "max_x": columns * spacing, "dx": spacing}
    for axis, size in (("x", width), ("y", height)):
        grid |= {f"start_{axis}": start, f"end_{axis}": start + size}
        grid |= {f"domain_min_{axis}": start, f"domain_max_{axis}": start + size}
    points = {"n_particles": count, "PPD": per_side, "p_vol": (spacing / per_side) ** 2, "p_rho": unit_weight / 10.0}
    load = dict.fromkeys(("traction_value_x", "traction_value_y", "point_load_value_x", "point_load_value_y"), 0.0)
    newton = {"n_iter": 25, "tol": 1e-8, "solver_name": "scipy"}
    return warp, quasi_static_solver_2d(grid, points, newton, material, load | {"gravity_mag": 10.0})


def hold(warp, solver, held):
    """Holds nodes: held says which components at a place."""
    flags = solver.dofStruct.boundary_flag_array.numpy()
    for node in range(solver.n_nodes):
        place = [node % (solver.n_grid_x + 1), node // (solver.n_grid_x + 1)]
        for axis, is_held in enumerate(held(*(solver.dx * np.array(place) - solver.dx))):
            flags[node + axis * solver.n_nodes] = is_held
    solver.dofStruct.boundary_flag_array = warp.from_numpy(flags, dtype=warp.bool)


def march(solver, steps):
    begun = time.process_time()
    for step in range(steps):
        solver.advance_one_step(step, steps)
        if not np.isfinite(solver.x_particles.numpy()).all():
            return time.process_time() - begun, step
    return time.process_time() - begun, steps


def column(cells):
    h = 50.0 / cells
    material = {"material_name": "Hencky elasticity", "youngs_modulus": 10.0, "poisson_ratio": 0.0}
    warp, solver = solver_of((6, cells + 3), h, (h, 50.0), 4 * cells, material, 0.8, 2)
    hold(warp, solver, lambda x, y: (True, y < 1e-9))
    before = solver.x_particles.numpy()[:, 1] - h
    seconds, done = march(solver, 40)
    stress = solver.particle_Cauchy_stress_array.numpy()[:, 1, 1]
    error = np.mean(np.abs(stress + 0.8 * (50.0 - before))) / (0.8 * 50.0)
    return seconds, done, 40, {"stress error": error}


def von_mises_slope(_):
    h = 0.5
    rows = np.arange(h / 4, 15.0, h / 2)
    columns = np.arange(h / 4, 40.0, h / 2)
    places = np.array([[x, y] for x in columns for y in rows if y < 5.0 or x < 30.0 - y]) + h
    material = {"material_name": "J2", "youngs_modulus": 1e3, "poisson_ratio": 0.49, "kappa": math.sqrt(2.0) * 45.0}
    # A box whose cells hold as many points; they are then put in their place.
    count = len(places)
    warp, solver = solver_of((84, 36), h, (40.0, 15.0), 80 * 30 * 4, material, 20.0, 2)
    solver.n_particles = count
    for name in ("x_particles", "x0"):
        setattr(solver, name, warp.from_numpy(places, dtype=warp.vec2d))
    hold(warp, solver, lambda x, y: (x < 1e-9 or x > 40.0 - 1e-9 or y < 1e-9, y < 1e-9))
    seconds, done = march(solver, 10)
    moved = np.linalg.norm(solver.x_particles.numpy() - places, axis=1)
    return seconds, done, 10, {"largest displacement [m]": moved.max()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("folder", help="of a copy of GeoWarp")
    parser.add_argument("benchmark", choices=["column", "von_mises_slope"])
    parser.add_argument("--cells", type=int, default=64, help="of the column")
    chosen = parser.parse_args()
    sys.path.insert(0, chosen.folder)
    own = {"column": column, "von_mises_slope": von_mises_slope}[chosen.benchmark]
    seconds, done, planned, found = own(chosen.cells)
    result = {"benchmark": chosen.benchmark, "seconds": round(seconds, 3), "steps": done, "of": planned}
    print(json.dumps(result | {"found": {name: float(value) for name, value in found.items()}}))


if __name__ == "__main__":
    main()
