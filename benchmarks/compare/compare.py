"""Times igimp's linear solvers and those of other libraries side by side, in one run.

    python benchmarks/compare/compare.py            all sizes: a quarter of an hour
    python benchmarks/compare/compare.py --quick    20 000 and 80 000 unknowns: two minutes

It builds igimp, makes the matrices if they are not there yet, and measures every library in a
process of its own, in turn, several rounds. `target/bench/compare.csv` has every measurement,
`target/bench/compare.md` the medians; --docs puts the latter into docs/src/solvers.md as well.
Packages: requirements.txt. A library that is not installed is skipped, and how to get it is said.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import libraries
import matrices
import report

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
OURS = "igimp"
LARGE = 100_000  # beyond, SuperLU takes minutes, and others than PARDISO have one round
ROUNDS = {20_000: 5, 80_000: 5, 320_000: 3, 500_000: 2}
RIVALS = {
    "symmetric": ["PARDISO", "CHOLMOD", "UMFPACK", "SuperLU"],
    "unsymmetric": ["PARDISO", "PARDISO general", "UMFPACK", "SuperLU"],
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--quick", action="store_true", help="20 000 and 80 000 unknowns only")
    parser.add_argument("--sizes", type=int, nargs="+", choices=matrices.SIZES, help="these sizes")
    parser.add_argument("--rounds", type=int, help="rounds, instead of 5 to 2 by size")
    parser.add_argument("--docs", action="store_true", help="rewrite the table of the book")
    return parser.parse_args()


def build():
    """Builds the programs in release mode; the folder of the build."""
    command = ["cargo", "build", "--release", "--package", "igimp"]
    command += ["--package", "igimp-benchmarks", "--bin", "igimp", "--bin", "linear"]
    subprocess.run(command, cwd=ROOT, check=True)
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1"]
    text = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return Path(json.loads(text)["target_directory"])


def libraries_for(kind, size, round_number):
    """Those to measure in a round; the large sizes leave out what takes long."""
    yield OURS
    for name in RIVALS[kind]:
        if size > LARGE and name in ("SuperLU", "PARDISO general"):
            continue
        if size > LARGE and name != "PARDISO" and round_number > 0:
            continue
        yield name


def measure(name, folder, threads, linear):
    """One library on one system in a process of its own: its line, or what went wrong."""
    if name == OURS:
        command = [linear, folder, "--threads", str(threads)]
    else:
        command = [sys.executable, HERE / "libraries.py", name, folder]
    environment = libraries.environment(threads)
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        return {"failed": f"ends with {done.returncode}: {last}"}
    return json.loads(done.stdout.splitlines()[-1])


def main():
    chosen = arguments()
    target = build()
    sizes = chosen.sizes or (matrices.SIZES[:2] if chosen.quick else matrices.SIZES)
    programs = target / "release"
    cases = ROOT / "crates/igimp-input/cases"
    systems = target / "bench/matrices"
    systems.mkdir(parents=True, exist_ok=True)
    threads = [1, 2] if (os.cpu_count() or 1) > 1 else [1]
    rows, absent, failed = [], {}, set()
    for size in sizes:
        for kind in matrices.KINDS:
            folder = matrices.make(programs / "igimp", cases, systems, kind, size)
            for number in range(chosen.rounds or ROUNDS[size]):
                for name in libraries_for(kind, size, number):
                    for count in threads if name != "SuperLU" else [1]:
                        if name in absent or (kind, size, name) in failed:
                            continue
                        line = measure(name, folder, count, programs / "linear")
                        if "missing" in line:
                            absent[name] = line["missing"]
                            print(f"{name} is not installed: {line['missing']}", flush=True)
                        elif "failed" in line:
                            failed.add((kind, size, name))
                            print(f"{name} on {kind}-{size} {line['failed']}", flush=True)
                        else:
                            row = {**line, "library": name, "kind": kind, "size": size}
                            rows.append({**row, "threads": count, "round": number + 1})
                            print(report.progress(rows[-1]), flush=True)
    if not any(row["library"] == OURS for row in rows):
        raise SystemExit("igimp's own solver could not be measured")
    text = report.markdown(rows, absent, OURS, ROOT)
    report.write(target / "bench", rows, text)
    print(f"\n{text}\nWritten to compare.md and compare.csv in {target / 'bench'}.")
    if chosen.docs:
        report.into_book(ROOT / "docs/src/solvers.md", text)


if __name__ == "__main__":
    main()
