# %% [markdown]
# # A parameter study
# Cohesion and friction of a slope: one run a pair, side by side in threads, because the engine computes without
# Python's lock. A sweep file does the same from a shell, and for a thousand runs.

# %%
from concurrent.futures import ThreadPoolExecutor
from itertools import product

import pandas as pd

import igimp

slope = igimp.new("slope").with_values({"grid.cell": {"x": "5 m", "y": "2 m"}})
# Without the run-out; the check of the template is for its own strength.
slope = slope.with_values({"stages": slope["stages"][:2], "curves": [], "checks": []})


def factor(cohesion, friction):
    """Factor of safety; cohesion in kPa, friction in degrees."""
    case = slope.with_values(
        {"materials.clay.cohesion": f"{cohesion} kPa", "materials.clay.friction": f"{friction} deg"}
    )
    return cohesion, friction, case.run(threads=1, progress=False).factor_of_safety


# %%
pairs = list(product([15, 20, 25], [15, 20]))
with ThreadPoolExecutor(2) as pool:
    rows = list(pool.map(factor, *zip(*pairs)))

table = pd.DataFrame(rows, columns=["cohesion [kPa]", "friction [deg]", "factor of safety [-]"])
chart = table.pivot(index="cohesion [kPa]", columns="friction [deg]", values="factor of safety [-]")
assert (chart.diff().iloc[1:] > 0).all().all() and (chart[20] > chart[15]).all()
chart
