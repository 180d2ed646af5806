"""Assembly and solution of an elastic cube in Kratos MPM and in igimp, in one run.

    pip install KratosMultiphysics KratosMPMApplication KratosLinearSolversApplication
    python benchmarks/compare/kratos.py --cells 12 20

A cube of 10 m of elastic soil under its own weight on as many hexahedra as it has cells, eight
material points in each, held at its base and on rollers at its sides. It prints, on one thread, the
processor time of an assembly of the tangent (element by element, a material point is an element) in
microseconds for each point, and of a solution with the conjugate gradients and smoothed aggregation
of AMGCL that Kratos takes by default, and with the sparse LU of Eigen. As a check: the largest
settlement, whose exact value for small strains is told.

igimp has as many cells and particles, deformed so that a GIMP domain touches 15 nodes (the cube of
`space.py`): its assembly of stress, forces and tangent, the least of three as Kratos' is, by the
clock; and solutions to the same 1e-8 by multigrid and by factors with their set-up, the factors made
once before, so that memory is at hand as in a Newton iteration.
"""

import argparse
import json
import os
import subprocess
import time

import libraries
import space

os.environ.update(libraries.environment(1))

import KratosMultiphysics as Kratos  # noqa: E402
import KratosMultiphysics.MPMApplication as Mpm  # noqa: E402
from KratosMultiphysics.MPMApplication.mpm_static_solver import MPMStaticSolver  # noqa: E402

SIDE = 10.0
SETTINGS = """{
    "domain_size": 3,
    "model_part_name": "MPM_Material",
    "analysis_type": "non_linear",
    "convergence_criterion": "residual_criterion",
    "max_iteration": 1,
    "time_stepping": {"time_step": 1.0},
    "grid_model_import_settings": {"input_type": "use_input_model_part"},
    "model_import_settings": {"input_type": "use_input_model_part"},
    "linear_solver_settings": SOLVER
}"""
AMGCL = """{
    "solver_type": "amgcl", "smoother_type": "ilu0", "krylov_type": "cg",
    "coarsening_type": "smoothed_aggregation", "max_iteration": 1000, "tolerance": 1e-8,
    "verbosity": 1, "use_block_matrices_if_possible": true, "coarse_enough": 1000, "scaling": false
}"""
SOLVERS = {
    "AMGCL, smoothed aggregation": AMGCL,
    "Eigen, sparse LU": '{"solver_type": "LinearSolversApplication.sparse_lu"}',
}


def fill(part, cells, element):
    """Nodes and hexahedra of a cube."""
    material = part.CreateNewProperties(1) if part.NumberOfProperties() == 0 else part.GetProperties(1)
    per_side = cells + 1
    h = SIDE / cells
    number = lambda x, y, z: 1 + x + per_side * (y + per_side * z)  # noqa: E731
    for z in range(per_side):
        for y in range(per_side):
            for x in range(per_side):
                part.CreateNewNode(number(x, y, z), x * h, y * h, z * h)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    made = 0
    for z in range(cells):
        for y in range(cells):
            for x in range(cells):
                made += 1
                nodes = [number(x + a, y + b, z + c) for a, b, c in corners]
                part.CreateNewElement(element, made, nodes, material)
    return material


def solver_of(cells, linear):
    """The solver of Kratos with a cube in it, ready for its first step."""
    model = Kratos.Model()
    settings = Kratos.Parameters(SETTINGS.replace("SOLVER", linear))
    solver = MPMStaticSolver(model, settings)
    solver.AddVariables()
    grid = model["Background_Grid"]
    body = model["Initial_MPM_Material"]
    fill(grid, cells, "Element3D8N")
    grid_body = body.CreateSubModelPart("body")
    material = fill(grid_body, cells, "MPMUpdatedLagrangian3D8N")
    material.SetValue(Kratos.DENSITY, 2000.0)
    material.SetValue(Kratos.YOUNG_MODULUS, 1e7)
    material.SetValue(Kratos.POISSON_RATIO, 0.3)
    material.SetValue(Mpm.MATERIAL_POINTS_PER_ELEMENT, 8)
    material.SetValue(Kratos.CONSTITUTIVE_LAW, Mpm.HyperElasticNeoHookean3DLaw())
    for sub in (body, grid):
        Kratos.VariableUtils().SetFlag(Kratos.ACTIVE, True, sub.Elements)
    solver.ImportModelPart()
    solver.PrepareModelPart()
    solver.AddDofs()
    for node in grid.Nodes:
        sides = [abs(x) < 1e-9 or abs(x - SIDE) < 1e-9 for x in (node.X, node.Y)]
        base = abs(node.Z) < 1e-9
        for held, component in zip([*sides, False], "XYZ"):
            if held or base:
                node.Fix(getattr(Kratos, f"DISPLACEMENT_{component}"))
    solver.Initialize()
    points = model["MPM_Material"]
    gravity = Kratos.Vector(3)
    gravity[2] = -9.81
    for point in points.Elements:
        point.SetValuesOnIntegrationPoints(Mpm.MP_VOLUME_ACCELERATION, [gravity], points.ProcessInfo)
    return solver, points


def measure(cells, name):
    """Number of points, seconds of an assembly and of a solution, largest displacement."""
    solver, points = solver_of(cells, SOLVERS[name])
    solver.AdvanceInTime(0.0)
    solver.Predict()
    solver.InitializeSolutionStep()
    strategy = solver._GetSolutionStrategy()
    builder, scheme = solver._GetBuilderAndSolver(), solver._GetSolutionScheme()
    matrix, rhs = strategy.GetSystemMatrix(), strategy.GetSystemVector()
    space = Kratos.UblasSparseSpace()
    best = float("inf")
    for _ in range(3):
        space.SetToZeroMatrix(matrix)
        space.SetToZeroVector(rhs)
        clock = time.process_time()
        builder.Build(scheme, points, matrix, rhs)
        best = min(best, time.process_time() - clock)
    change = strategy.GetSolutionVector()
    builder.ApplyDirichletConditions(scheme, points, matrix, change, rhs)
    clock = time.process_time()
    builder.SystemSolve(matrix, change, rhs)
    seconds = time.process_time() - clock
    return points.NumberOfElements(), best, seconds, max(abs(own) for own in change)


def igimp_rows(target, cells):
    """igimp's rows for the same cube."""
    programs, system = target / "release", target / f"bench/matrices/kratos-{cells}"

    def told(*command):
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    assembly = told(programs / "cube_system", system, "--cells", str(cells))
    assembly = assembly.split("µs")[0].split()[-1]
    for solver in ("multigrid", "auto"):
        line = told(programs / "linear", system, "--solver", solver, "--asked", "1e-8")
        row = json.loads(line.splitlines()[-1])
        seconds = row["analysis_cpu"] + row["factor_cpu"] + row["solve_cpu"]
        yield f"| {cells}³ | {8 * cells**3} | igimp, {row['solver']} | {assembly} | {seconds:.2f} | |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--cells", type=int, nargs="+", default=[12])
    parser.add_argument("--solvers", nargs="+", choices=SOLVERS, help="these only")
    chosen = parser.parse_args()
    target = space.build()
    Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
    modulus = 1e7 * 0.7 / (1.3 * 0.4)
    print(f"settlement for small strains: {2000.0 * 9.81 * SIDE**2 / (2.0 * modulus):.4f} m")
    print("| cells | points | solver | assembly [µs a point] | solution [s] | settlement [m] |")
    print("|---:|---:|---|---:|---:|---:|")
    for cells in chosen.cells:
        for row in igimp_rows(target, cells):
            print(row, flush=True)
        for name in chosen.solvers or SOLVERS:
            try:
                points, assembly, solution, settlement = measure(cells, name)
            except Exception as error:
                print(f"{name}: {error}")
                continue
            row = f"| {cells}³ | {points} | {name} | {1e6 * assembly / points:.2f}"
            print(f"{row} | {solution:.2f} | {settlement:.4f} |", flush=True)


if __name__ == "__main__":
    main()
