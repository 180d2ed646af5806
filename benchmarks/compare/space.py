"""Times direct and iterative solvers side by side on cubes of soil, in one run.

    python benchmarks/compare/space.py --cells 20 30          two sizes: ten minutes, 5 GiB
    python benchmarks/compare/space.py --cells 20 --docs      and rewrites the table of the book

The states are those of `igimp-benchmarks`' program `iteration`: half of the particles are plastic where the
soil can be. One thread, processor time, relative residual 1e-8 where a method iterates. As in `compare.py` each
method runs in a process of its own and what is not installed is skipped. `--petsc` names the interpreter that
has petsc4py, /usr/bin/python3 for Debian's package.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import compare
import libraries
import matrices
import report

ASKED = "1e-8"
# By what they are called in the table: igimp's solver by name, or a library.
METHODS = {
    "igimp, direct": "auto",
    "igimp, single": "single",
    "igimp, multigrid": "multigrid",
    "PARDISO": None,
    "PETSc GAMG": None,
    "PETSc GAMG, points": None,
}
# Systems beyond this many cells a side: factors in double precision take more memory than most have.
LARGEST_DIRECT = 30
BEGIN, END = "<!-- compare-space:begin -->", "<!-- compare-space:end -->"
HEADER = (
    "| state | unknowns | method | iterations | set-up [s] | solution [s] | memory [GiB] | residual |\n"
    "|---|---:|---|---:|---:|---:|---:|---:|\n"
)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--cells", type=int, nargs="+", default=[20], help="cells along a side")
    parser.add_argument("--states", nargs="+", choices=matrices.CUBES, help="these states only")
    parser.add_argument("--methods", nargs="+", choices=METHODS, help="these methods only")
    parser.add_argument("--petsc", default=sys.executable, help="interpreter that has petsc4py")
    parser.add_argument("--docs", action="store_true", help="rewrite the table of the book")
    return parser.parse_args()


def build():
    """Builds the programs; the folder of the build."""
    command = ["cargo", "build", "--release", "--package", "igimp-benchmarks"]
    command += ["--bin", "cube_system", "--bin", "linear"]
    subprocess.run(command, cwd=compare.ROOT, check=True)
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1"]
    text = subprocess.run(command, cwd=compare.ROOT, check=True, capture_output=True, text=True)
    return Path(json.loads(text.stdout)["target_directory"])


def measure(method, folder, programs, petsc):
    """One method on one system in a process of its own: its line, or what went wrong."""
    solver = METHODS[method]
    if solver:
        command = [programs / "linear", folder, "--solver", solver, "--asked", ASKED]
    else:
        interpreter = petsc if method.startswith("PETSc") else sys.executable
        command = [interpreter, compare.HERE / "libraries.py", method, folder]
    environment = libraries.environment(1)
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        return {"failed": f"ends with {done.returncode}: {last}"}
    return json.loads(done.stdout.splitlines()[-1])


def line(state, method, row):
    """A row of the table."""
    iterates = METHODS[method] in ("single", "multigrid") or method.startswith("PETSc")
    cells = [
        state,
        f"{row['unknowns']:,}".replace(",", " "),
        method,
        str(row["refinements"]) if iterates else "–",
        report.number(row["analysis_cpu"] + row["factor_cpu"]),
        report.number(row["solve_cpu"]),
        report.number(row["memory_mib"] / 1024),
        f"{row['residual']:.0e}",
    ]
    return f"| {' | '.join(cells)} |\n"


def main():
    chosen = arguments()
    target = build()
    systems = target / "bench/matrices"
    systems.mkdir(parents=True, exist_ok=True)
    text, versions = HEADER, {}
    for state in chosen.states or matrices.CUBES:
        for cells in chosen.cells:
            cube = target / "release/cube_system"
            folder = matrices.make_cube(cube, systems, state, cells)
            for method in chosen.methods or METHODS:
                if cells > LARGEST_DIRECT and method in ("igimp, direct", "PARDISO"):
                    continue
                row = measure(method, folder, target / "release", chosen.petsc)
                told = row.get("missing") or row.get("failed")
                if told:
                    print(f"{method} on {state}, {cells} cells: {told}", flush=True)
                    continue
                versions[row.get("version")] = None
                text += line(state, method, row)
                print(line(state, method, row), end="", flush=True)
    about = f"Measured on {report.machine()}; igimp at commit {report.revision(compare.ROOT)}"
    text = "; ".join([about, *filter(None, versions)]) + ".\n\n" + text
    (target / "bench/compare-space.md").write_text(text)
    if chosen.docs:
        report.into_book(compare.ROOT / "docs/src/solvers.md", text, BEGIN, END)


if __name__ == "__main__":
    main()
