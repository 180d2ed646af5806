"""The four benchmarks in igimp and in Kratos MPM, in one run, one after the other.

    pip install KratosMultiphysics KratosMPMApplication KratosLinearSolversApplication
    python benchmarks/peers/compare.py --igimp target/release/igimp

Prints a table in Markdown: seconds of the processor on one thread, steps, results. Times of both come from the same
minutes of the same computer: their ratio says something, each alone does not.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
CASES = HERE.parents[1] / "crates/igimp-input/cases"
PLAIN = ["output.figures=[]", "output.report=false", 'output.paraview={ every = "never" }']

# Name; words for Kratos; case file and settings for igimp; what of its summary is compared.
ROWS = [
    ("column, 64 cells, E = 1 MPa", ["column", "--young", "1e6"], "column", ["materials.soft.young=1 MPa"]),
    ("column, 64 cells, E = 10 kPa", ["column"], "column", []),
    ("the same, Neo-Hooke in Kratos", ["column", "--law", "neo-hooke"], "column", []),
    ("slope, von Mises, E = 1 MPa", ["von_mises_slope"], "von_mises_slope", []),
    (
        "slope, von Mises, E = 100 MPa",
        ["von_mises_slope", "--young", "1e8"],
        "von_mises_slope",
        ["materials.clay.young=100 MPa"],
    ),
    ("slope, Mohr-Coulomb, at its strength", ["mohr_coulomb_slope", "--factors", "1.0"], "at its strength", []),
    ("slope, Mohr-Coulomb, all factors", ["mohr_coulomb_slope"], "mohr_coulomb_slope", []),
    (
        "footing to 0.05 B",
        ["footing"],
        "footing",
        [
            'stages."push to one width".bodies=[{ body = "footing", y = "-0.05 m" }]',
            'stages."push to one width".steps=4',
        ],
    ),
]


def kratos(words, patience):
    words = [sys.executable, str(HERE / "kratos.py"), *words]
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=patience, check=False)
    except subprocess.TimeoutExpired:
        return {"seconds": None, "reason": f"not done after {patience} s"}
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    return json.loads(lines[-1]) if lines else {"seconds": None, "reason": done.stderr.strip()[-200:]}


def text_of(case):
    """A case file; the slope at its own strength is the one with Mohr-Coulomb soil, under its weight alone."""
    if case != "at its strength":
        return (CASES / f"{case}.toml").read_text()
    text = (CASES / "mohr_coulomb_slope.toml").read_text()
    before, rest = text.split("[[stages]]", 1)
    stage = '[[stages]]\nname = "own weight"\ntype = "gravity"\nsteps = 5\n[solver]'
    return before + stage + rest.split("[solver]", 1)[1].split("[[curves]]", 1)[0] + "[output]\n"


def igimp(program, case, settings):
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "case.toml").write_text(text_of(case))
        words = [program, "run", "case.toml", "--out", "out", "--threads", "1", "--quiet"]
        for setting in PLAIN + settings:
            words += ["--set", setting]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        if not (folder / "out/summary.json").exists():
            return {"seconds": None, "reason": done.stderr.strip()[-300:]}
        summary = json.loads((folder / "out/summary.json").read_text())
        stage = summary["stages"][-1]
        found = {"steps": stage["steps"], "largest displacement [m]": stage["largest_displacement"]}
        if stage["safety"]:
            found["factor of safety"] = [stage["safety"]["stable"], stage["safety"]["failed"]]
        return {"seconds": summary["cpu_seconds"], "found": found, "curves": ends(folder / "out/curves")}


def ends(folder):
    """The last row of each curve."""
    rows = {}
    for path in sorted(folder.glob("*.csv")):
        lines = [line for line in path.read_text().splitlines() if line and not line.startswith("#")]
        rows[path.stem] = lines[-1]
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--igimp", default="igimp", help="the program")
    parser.add_argument("--patience", type=float, default=300.0, help="seconds for a run of Kratos")
    parser.add_argument("--only", default="", help="rows whose name holds this")
    chosen = parser.parse_args()
    print("| benchmark | igimp [s] | Kratos [s] | ratio | igimp | Kratos |\n|---|---|---|---|---|---|")
    for name, words, case, settings in ROWS:
        if chosen.only not in name:
            continue
        own = igimp(chosen.igimp, case, settings)
        other = kratos(words, chosen.patience)
        both = own["seconds"] and other["seconds"]
        ratio = f"{other['seconds'] / own['seconds']:.1f}" if both else ""
        print(f"| {name} | {own['seconds']} | {other['seconds']} | {ratio} | {own} | {other} |", flush=True)


if __name__ == "__main__":
    main()
