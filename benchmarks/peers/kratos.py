"""The four benchmarks in Kratos MPM.

    pip install KratosMultiphysics KratosMPMApplication KratosLinearSolversApplication
    python benchmarks/peers/kratos.py column --cells 64
    python benchmarks/peers/kratos.py von_mises_slope
    python benchmarks/peers/kratos.py mohr_coulomb_slope --factors 1.0 1.2 1.35
    python benchmarks/peers/kratos.py footing --depth 0.05

Geometry, parameters, spacing and material points are those of the case files of igimp with the same names. Equilibrium
by the static solver with Newton's method, on one thread, with the sparse LU of Eigen. What Kratos has not, is told
where it is replaced: its soil that yields is Mohr-Coulomb, which without friction is that of Tresca; its points are
points and have no domains; a grid stays where it is.

Prints one line of JSON: seconds of the processor, steps that converged, the result that the benchmark compares, and why
it ended early.
"""

import argparse
import json
import math
import os
import time

for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import KratosMultiphysics as Kratos  # noqa: E402
import KratosMultiphysics.MPMApplication as Mpm  # noqa: E402
from KratosMultiphysics.MPMApplication.mpm_static_solver import MPMStaticSolver  # noqa: E402

SETTINGS = """{
    "domain_size": 2,
    "model_part_name": "MPM_Material",
    "analysis_type": "non_linear",
    "convergence_criterion": "residual_criterion",
    "residual_relative_tolerance": 1e-6,
    "residual_absolute_tolerance": 1e-6,
    "max_iteration": 25,
    "compute_reactions": true,
    "pressure_dofs": MIXED,
    "time_stepping": {"time_step": 1.0},
    "grid_model_import_settings": {"input_type": "use_input_model_part"},
    "model_import_settings": {"input_type": "use_input_model_part"},
    "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"}
}"""


def rows_of_quads(levels, edges):
    """Nodes and quadrilaterals of a body between x = 0 and its right edge: one row a level, so many cells a row."""
    nodes, quads = [], []
    for (low, high), (right_low, right_high, count) in zip(zip(levels, levels[1:]), edges):
        start = len(nodes)
        for y, right in ((low, right_low), (high, right_high)):
            nodes += [(right * k / count, y) for k in range(count + 1)]
        for k in range(count):
            quads.append([start + k, start + k + 1, start + count + 2 + k, start + count + 1 + k])
    return nodes, quads


def rectangle(width, height, columns, rows):
    levels = [height * k / rows for k in range(rows + 1)]
    return rows_of_quads(levels, [(width, width, columns)] * rows)


class Problem:
    """A body of one material on a grid of squares."""

    def __init__(self, grid, body, material, points, held, mixed=False):
        (width, height), (columns, rows) = grid
        self.model = Kratos.Model()
        settings = SETTINGS.replace("MIXED", "true" if mixed else "false")
        self.solver = MPMStaticSolver(self.model, Kratos.Parameters(settings))
        self.solver.AddVariables()
        self.grid = self.model["Background_Grid"]
        initial = self.model["Initial_MPM_Material"]
        spare = self.grid.CreateNewProperties(1)
        number = lambda i, j: 1 + i + (columns + 1) * j  # noqa: E731
        for j in range(rows + 1):
            for i in range(columns + 1):
                self.grid.CreateNewNode(number(i, j), width * i / columns, height * j / rows, 0.0)
        for j in range(rows):
            for i in range(columns):
                corners = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]
                self.grid.CreateNewElement("Element2D4N", 1 + i + columns * j, corners, spare)
        part = initial.CreateSubModelPart("body")
        properties = part.CreateNewProperties(1)
        for variable, value in material["values"].items():
            properties.SetValue(Kratos.KratosGlobals.GetVariable(variable), value)
        properties.SetValue(Kratos.THICKNESS, 1.0)
        properties.SetValue(Mpm.MATERIAL_POINTS_PER_ELEMENT, points)
        properties.SetValue(Kratos.CONSTITUTIVE_LAW, getattr(Mpm, material["law"])())
        nodes, quads = body
        first = self.grid.NumberOfNodes()
        for k, (x, y) in enumerate(nodes, 1):
            part.CreateNewNode(first + k, x, y, 0.0)
        kind = "MPMUpdatedLagrangianUP2D4N" if mixed else "MPMUpdatedLagrangian2D4N"
        for k, quad in enumerate(quads, 1):
            part.CreateNewElement(kind, k, [first + 1 + corner for corner in quad], properties)
        for sub in (initial, self.grid):
            Kratos.VariableUtils().SetFlag(Kratos.ACTIVE, True, sub.Elements)
        self.solver.ImportModelPart()
        self.solver.PrepareModelPart()
        self.solver.AddDofs()
        self.held = {node.Id: held(node.X, node.Y) for node in self.grid.Nodes}
        self.solver.Initialize()
        self.points = self.model["MPM_Material"]
        self.clock, self.reason = 0.0, ""

    def read(self, variable):
        """A value of every point."""
        info = self.points.ProcessInfo
        return [e.CalculateOnIntegrationPoints(variable, info)[0] for e in self.points.Elements]

    def step(self, gravity=0.0, before=None):
        """A step to equilibrium under so much gravity; whether it converged."""
        info = self.points.ProcessInfo
        pull = Kratos.Vector([0.0, -gravity, 0.0])
        for point in self.points.Elements:
            point.SetValuesOnIntegrationPoints(Mpm.MP_VOLUME_ACCELERATION, [pull], info)
        self.clock = self.solver.AdvanceInTime(self.clock)
        self.solver.Predict()
        # Nodes that no point touches have no equation.
        touched = {node.Id for point in self.points.Elements for node in point.GetNodes()}
        for node in self.grid.Nodes:
            for component, is_held in zip("XY", self.held[node.Id]):
                own = getattr(Kratos, f"DISPLACEMENT_{component}")
                if is_held or node.Id not in touched:
                    node.Fix(own)
                else:
                    node.Free(own)
        self.solver.InitializeSolutionStep()
        if before:
            before(self.grid)
        try:
            converged = self.solver.SolveSolutionStep()
        except RuntimeError as error:
            # A point turned inside out, or a matrix that is singular.
            text = " ".join(str(error).split())
            self.reason = text[:100]
            return False, 0.0
        if not converged:
            self.reason = "no convergence within 25 corrections"
        reaction = sum(
            node.GetSolutionStepValue(Kratos.REACTION_Y) for node in self.grid.Nodes if node.Is(Kratos.MARKER)
        )
        self.solver.FinalizeSolutionStep()
        return converged, reaction


def column(chosen):
    """Mean error of the vertical stress against the exact solution, which is that of every law."""
    cells, height = chosen.cells, 50.0
    h = height / cells
    material = {
        "law": "HyperElasticNeoHookeanPlaneStrain2DLaw" if chosen.law == "neo-hooke" else chosen.law,
        "values": {"DENSITY": 80.0, "YOUNG_MODULUS": chosen.young or 1e4, "POISSON_RATIO": 0.0},
    }
    if chosen.law == "hencky":
        # Mohr-Coulomb that never yields is elastic in Hencky's strain.
        material["law"] = "HenckyMCPlasticPlaneStrain2DLaw"
        angles = {"INTERNAL_FRICTION_ANGLE": 0.35, "INTERNAL_DILATANCY_ANGLE": 0.0, "COHESION": 1e9}
        material["values"].update(angles)
    problem = Problem(
        ((h, height + h), (1, cells + 1)),
        rectangle(h, height, 1, cells),
        material,
        4,
        lambda x, y: (True, y < 1e-9),
    )
    start = problem.read(Mpm.MP_COORD)
    volumes = problem.read(Mpm.MP_VOLUME)
    begun = time.process_time()
    done = 0
    for step in range(1, 41):
        converged, _ = problem.step(10.0 * step / 40)
        if not converged:
            break
        done = step
    seconds = time.process_time() - begun
    weight = 80.0 * 10.0
    error = 0.0
    for x, v, stress in zip(start, volumes, problem.read(Mpm.MP_CAUCHY_STRESS_VECTOR)):
        error += v * abs(stress[1] + weight * (height - x[1]))
    error /= weight * height * sum(volumes)
    return seconds, done, 40, {"stress error": error}, problem.reason


def von_mises_slope(chosen):
    """Largest displacement under its own weight."""
    levels = [0.5 * k for k in range(31)]
    edges = [(40.0, 40.0, 80)] * 10 + [(30.0 - y, 29.5 - y, 40) for y in levels[10:30]]
    material = tresca(45e3, chosen.young or 1e6, 0.49, 20e3 / 9.81, chosen)
    problem = Problem(
        ((40.0, 15.5), (80, 31)),
        rows_of_quads(levels, edges),
        material,
        4,
        lambda x, y: (x < 1e-9 or x > 40.0 - 1e-9 or y < 1e-9, y < 1e-9),
        chosen.mixed,
    )
    begun = time.process_time()
    done = 0
    planned = 10 * chosen.times
    for step in range(1, planned + 1):
        converged, _ = problem.step(9.81 * step / planned)
        if not converged:
            break
        done = step
    found = {"largest displacement [m]": largest(problem)}
    return time.process_time() - begun, done, planned, found, problem.reason


def mohr_coulomb_slope(chosen):
    """Dimensionless displacement for given reductions of strength, until there is no equilibrium."""
    levels = [float(k) for k in range(11)]
    edges = [(32.0 - 2.0 * y, 30.0 - 2.0 * y, 22) for y in levels[:10]]
    found, done, planned = {}, 0, 0
    begun = time.process_time()
    for factor in chosen.factors:
        material = mohr_coulomb(factor, chosen)
        problem = Problem(
            ((36.0, 11.0), (36, 11)),
            rows_of_quads(levels, edges),
            material,
            4,
            lambda x, y: (x < 1e-9 or x > 36.0 - 1e-9 or y < 1e-9, y < 1e-9),
            chosen.mixed,
        )
        steps = 5 * chosen.times
        planned += steps
        for step in range(1, steps + 1):
            converged, _ = problem.step(9.81 * step / steps)
            if not converged:
                break
            done += 1
        found[f"SRF {factor}"] = largest(problem) / 0.02 if converged else f"no equilibrium in step {step}"
    return time.process_time() - begun, done, planned, found, problem.reason


def footing(chosen):
    """Resistance of a rough footing of width 1 m, whose base is nodes of the grid, in a half model."""
    h = 0.105
    material = tresca(1e3, 1e5, 0.495, 1.0, chosen)

    def held(x, y):
        under = x < 0.5 and abs(y - 5.04) < 1e-9
        return x < 1e-9 or x > 5.04 - 1e-9 or under, y < 1e-9 or under

    problem = Problem(
        ((5.04, 6.09), (48, 58)),
        rectangle(5.04, 5.04, 48, 48),
        material,
        9,
        held,
        chosen.mixed,
    )
    under = [n for n in problem.grid.Nodes if n.X < 0.5 and abs(n.Y - 5.04) < 1e-9]
    for node in under:
        node.Set(Kratos.MARKER, True)
    steps = chosen.times * max(1, round(chosen.depth / 0.0125))
    push = chosen.depth / steps

    def prescribe(grid):
        for node in under:
            node.SetSolutionStepValue(Kratos.DISPLACEMENT_Y, -push)

    begun = time.process_time()
    done, load = 0, 0.0
    # Its edge lies at three quarters of its cell and acts as wide as it is.
    for step in range(1, steps + 1):
        converged, reaction = problem.step(0.0, prescribe)
        if not converged:
            break
        done, load = step, reaction
    seconds = time.process_time() - begun
    return seconds, done, steps, {f"N at {done * push:.4f} B": 2.0 * abs(load) / 1e3}, problem.reason


def tresca(cu, young, poisson, density, chosen):
    values = {
        "DENSITY": density,
        "YOUNG_MODULUS": young,
        "POISSON_RATIO": poisson,
        "COHESION": cu,
        # In radians; none at all makes its matrix singular.
        "INTERNAL_FRICTION_ANGLE": chosen.friction,
        "INTERNAL_DILATANCY_ANGLE": 0.0,
    }
    return {"law": plastic(chosen), "values": values}


def mohr_coulomb(factor, chosen):
    values = {
        "DENSITY": 20e3 / 9.81,
        "YOUNG_MODULUS": 1e8,
        "POISSON_RATIO": 0.3,
        "COHESION": 10e3 / factor,
        "INTERNAL_FRICTION_ANGLE": math.atan(math.tan(math.radians(20.0)) / factor),
        "INTERNAL_DILATANCY_ANGLE": 0.0,
    }
    return {"law": plastic(chosen), "values": values}


def plastic(chosen):
    mixed = "UP2D" if chosen.mixed else "2D"
    return f"HenckyMCPlasticPlaneStrain{mixed}Law"


def largest(problem):
    return max(math.hypot(u[0], u[1]) for u in problem.read(Mpm.MP_DISPLACEMENT))


BENCHMARKS = {own.__name__: own for own in (column, von_mises_slope, mohr_coulomb_slope, footing)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("benchmark", choices=BENCHMARKS)
    parser.add_argument("--cells", type=int, default=64, help="of the column")
    parser.add_argument("--law", choices=["neo-hooke", "hencky"], default="hencky", help="of the column")
    parser.add_argument("--young", type=float, help="of the column and of the slope in von Mises soil [Pa]")
    parser.add_argument("--factors", type=float, nargs="+", default=[1.0, 1.2, 1.3, 1.35, 1.4])
    parser.add_argument("--depth", type=float, default=0.05, help="of the footing, over its width")
    parser.add_argument("--friction", type=float, default=1e-3, help="of soil without friction, in radians")
    parser.add_argument("--times", type=int, default=1, help="so many times the steps of slopes and footing")
    parser.add_argument("--mixed", action="store_true", help="elements with a pressure of their own")
    chosen = parser.parse_args()
    Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
    seconds, done, planned, found, reason = BENCHMARKS[chosen.benchmark](chosen)
    result = {"benchmark": chosen.benchmark, "seconds": round(seconds, 3), "steps": done, "of": planned}
    result |= {"found": found, "reason": reason}
    print(json.dumps(result), flush=True)


if __name__ == "__main__":
    main()
