# %% [markdown]
# # The four benchmarks
# The problems of Yuan et al. (2021) on coarse grids, against the curves that each case file holds: exact solutions,
# published tables and limit analysis. The full grids are those of the files themselves; a coarse one may miss a band
# that they meet, and says so.

# %%
import matplotlib.pyplot as plt
import numpy as np

import igimp

COARSE = {
    "column": {},
    "von_mises_slope": {"grid.cell": {"x": "1 m", "y": "0.5 m"}},
    "mohr_coulomb_slope": {"grid.cell": {"x": "2 m", "y": "1 m"}, "checks": []},
    "footing": {"grid.cell": {"x": "0.18 m", "y": "0.21 m"}, "stages.push to one width.steps": 40, "checks": []},
}
found = {}
for name, values in COARSE.items():
    found[name] = igimp.new(name).with_values(values).run(progress=False)
    print(f"{name}: {found[name].ending}", *[check.name for check in found[name].checks if not check.met])

# %% [markdown]
# Each curve with its reference, read from the case:

# %%
figure, axes = plt.subplots(2, 2, figsize=(10, 8), layout="constrained")
far = {}
for (name, results), axis in zip(found.items(), axes.flat):
    curve = igimp.new(name)["curves"][0]
    table = results.curves[curve["name"]]
    x, y = (table[column] for column in list(table)[:2])
    axis.plot(x, y, label="igimp, coarse grid")
    axis.set(title=name, xlabel=list(table)[0], ylabel=list(table)[1])
    if points := curve.get("reference", {}).get("points"):
        reference = np.array(points, dtype=float)
        axis.plot(*reference.T, "o", label=curve["reference"]["label"])
        order = np.argsort(x)
        inside = reference[(reference[:, 0] > 0.3 * x.max()) & (reference[:, 0] <= x.max())]
        computed = np.interp(inside[:, 0], np.array(x)[order], np.array(y)[order])
        far[name] = np.max(np.abs(computed / inside[:, 1] - 1))
    axis.legend(fontsize="small")
figure.savefig("benchmarks.svg")

# %%
for name, share in far.items():
    print(f"{name}: at most {share:.2%} from its reference")
assert far["column"] < 0.01
