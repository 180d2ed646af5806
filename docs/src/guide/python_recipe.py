"""Reads a results folder of igimp: python3 python_recipe.py results/slope"""

import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd

folder = Path(sys.argv[1])

# The outcome.
summary = json.loads((folder / "summary.json").read_text())
for stage in summary["stages"]:
    print(f"{stage['name']}: {stage['outcome']}, {stage['reason']}")
    if stage["safety"]:
        safety = stage["safety"]
        print(f"  factor of safety between {safety['stable']} and {safety['failed']}")
        trials = pd.DataFrame(safety["trials"])
        print(trials[["srf", "stable", "displacement"]].to_string(index=False))

# Histories: one row a step.
crest = pd.read_csv(folder / "monitors" / "crest.csv")
last = crest[crest["stage"] == crest["stage"].max()]
print(f"crest: {last['displacement_[m]'].iloc[-1]:.3f} m after {len(last)} steps")

# A section, stresses compression positive.
table = sorted((folder / "sections").glob("A-A__1-*.csv"))[0]
section = pd.read_csv(table)
stress = section["sigma_yy_[Pa]_compression_+"]
weight = 20e3 * (section["y_[m]"].max() - section["y_[m]"])
print(f"{table.stem}: sigma_yy up to {stress.max() / 1e3:.0f} kPa, "
      f"unit weight times depth {weight.max() / 1e3:.0f} kPa")

# The state at the end of a stage: arrays by particle, tension positive.
state = folder / "checkpoint" / "stage-01-end" / "current"
x, sigma, mass, law = (np.load(state / f"{name}.npy") for name in ("x", "sigma", "mass", "law"))
assert x.shape == (len(mass), 2) and sigma.shape == (len(mass), 3, 3)
p = -np.trace(sigma, axis1=1, axis2=2) / 3
s = sigma + p[:, None, None] * np.eye(3)
q = np.sqrt(1.5 * np.einsum("nij,nij->n", s, s))
lowest = np.argmin(x[:, 1])
print(f"{len(mass)} particles, {mass.sum() * 9.81 / 1e3:.0f} kN/m; "
      f"at the base p = {p[lowest] / 1e3:.0f} kPa, q = {q[lowest] / 1e3:.0f} kPa")

# Newton's residuals of one step.
residuals = pd.read_csv(folder / "convergence.csv")
one = residuals[(residuals["stage"] == "initial stresses") & (residuals["step"] == 10)]
print("residuals:", " ".join(f"{r:.0e}" for r in one["relative_out_of_balance"]))

# A picture, if matplotlib is installed.
try:
    import matplotlib
except ImportError:
    print("no picture: matplotlib is not installed")
    sys.exit()
matplotlib.use("Agg")
import matplotlib.pyplot as plt

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
left.plot(stress / 1e3, section["y_[m]"])
left.set(xlabel="vertical stress [kPa], compression positive", ylabel="y [m]")
points = right.scatter(x[:, 0], x[:, 1], c=q / 1e3, s=2)
right.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
figure.colorbar(points, label="q [kPa]")
figure.savefig(folder / "python.png", dpi=150)
print(f"picture in {folder / 'python.png'}")
