"""Runs a cube of plastic undrained clay on several ranks, and models more of them.

    python benchmarks/compare/ranks.py --program target/release/igimp-mpi --cells 20 32 --ranks 1 2 4

Every run prints time and bytes by phase and memory by rank; a table of all follows, per correction of Newton's method. The model
takes the constants below, which were fitted to such tables, and the figures of a cluster that `--cluster` changes.
"""

import argparse
import math
import subprocess
import sys
from pathlib import Path

CASE = Path(__file__).parents[1] / "cases" / "undrained_cut.toml"

# Fitted to the runs of the book (docs/src/guide/mpi.md), per unknown and correction.
ASSEMBLY = 1.0e-5  # s on one thread
FACTORS = 1.3e-9  # s on one rank, times the square of the unknowns
GRIDS = 6.2e-5  # s of a solution of elastic soil by smoothed aggregation on one rank, 23 iterations (docs/src/solvers.md)
VALUES = 616.0  # bytes that rank 0 sends
HELD = 9.5e3  # bytes of particles, matrix and pattern on rank 0
FACTOR_BYTES = 6.7e3  # of factors on one rank at 25 200 unknowns, growing with their power of 4/3
# Assumptions: the share of the cores that is used is the ranks to this power, and factors grow with their root, to twice at most.
EFFICIENCY = -0.25


def settings(cells):
    cell = 4.0 / cells
    top = f'"{4 + cell:.10g}m"'
    return [
        "--set",
        f'grid.cell="{cell:.10g}m"',
        "--set",
        f'grid.domain={{x=["0m",{top}],y=["0m","4m"],z=["0m",{top}]}}',
    ]


def run(program, cells, ranks, folder):
    """A row of the table from what a run prints."""
    words = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), program, "run", str(CASE)]
    words += settings(cells) + ["--out", str(folder), "--overwrite"]
    text = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    lines = text.splitlines()
    phases = {}
    for line in lines:
        for name in ("pattern", "values", "factors or grids", "solutions"):
            if line.startswith(name + " "):
                times, seconds, sent = line[34:].split()
                phases[name] = (int(times), float(seconds), float(sent))
    rest = next(float(line.split()[-1]) for line in lines if line.startswith("assembly, particles"))
    table = lines.index(next(line for line in lines if line.startswith("rank  computer")))
    memory = [line.split()[2:] for line in lines[table + 1 : table + 1 + ranks]]
    times = phases["values"][0]
    return (
        [cells, ranks, times, rest / times]
        + [phases[name][1] / times for name in ("values", "factors or grids", "solutions")]
        + [phases["values"][2] / times, " + ".join(row[0] for row in memory), " + ".join(row[1] for row in memory)]
    )


def modelled(unknowns, ranks, cluster):
    """Seconds of a correction by part, and GiB on rank 0 and on the others."""
    computers = math.ceil(ranks / cluster.cores)
    threads = min(ranks, cluster.cores)
    speed = ranks ** (1 + EFFICIENCY)
    away = (ranks - 1) / ranks
    sent = VALUES * unknowns * away / (cluster.bandwidth * 1e9 if computers > 1 else 5e9)
    sent += ranks * cluster.latency * 1e-6
    factors = FACTOR_BYTES * unknowns * (unknowns / 25200.0) ** (1 / 3)
    share = factors / ranks * min(math.sqrt(ranks), 2.0)
    gib = 1 << 30
    return (
        ASSEMBLY * unknowns / threads,
        sent,
        FACTORS * unknowns**2 / speed,
        GRIDS * unknowns / speed,
        (HELD * unknowns + share) / gib,
        share * min(ranks, cluster.cores) / gib,
    )


def model(cluster):
    print("| unknowns | ranks | assembly [s] | values sent [s] | factors [s] | 25 iterations [s] | rank 0 [GiB] | factors on a computer [GiB] |")
    print("|---:|---:|---:|---:|---:|---:|---:|---:|")
    for unknowns in (200_000, 1_000_000, 5_000_000):
        for ranks in (1, 16, 64, 1024):
            parts = modelled(unknowns, ranks, cluster)
            print(f"| {unknowns} | {ranks} | " + " | ".join(f"{part:.3g}" for part in parts) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="target/release/igimp-mpi")
    parser.add_argument("--cells", type=int, nargs="*", default=[20])
    parser.add_argument("--ranks", type=int, nargs="*", default=[1, 2])
    parser.add_argument("--out", type=Path, default=Path("results/ranks"))
    parser.add_argument("--model", action="store_true", help="the model alone")
    parser.add_argument("--cores", type=int, default=32, help="of a computer")
    parser.add_argument("--bandwidth", type=float, default=1.2, help="of its network [GB/s]")
    parser.add_argument("--latency", type=float, default=20.0, help="of a message [us]")
    arguments = parser.parse_args()
    if not arguments.model:
        print("| cells | ranks | corrections | assembly and the rest [s] | values [s] | factors [s] | solution [s] | values [MiB] | peak by rank [MiB] | MUMPS by rank [MB] |")
        print("|---:|---:|---:|---:|---:|---:|---:|---:|---|---|", flush=True)
        for cells in arguments.cells:
            for ranks in arguments.ranks:
                row = run(arguments.program, cells, ranks, arguments.out)
                words = [f"{part:.3g}" if isinstance(part, float) else str(part) for part in row]
                print("| " + " | ".join(words) + " |", flush=True)
    model(arguments)
    return 0


if __name__ == "__main__":
    sys.exit(main())
