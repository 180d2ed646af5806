# %% [markdown]
# # How likely is failure?
# Cohesion and friction scatter. Draws run side by side in processes of joblib; each gets a case, which can be
# pickled, and one thread. Sixteen draws show how; a probability wants thousands of them, and a sweep.

# %%
import warnings

import numpy as np
from joblib import Parallel, delayed

import igimp

slope = igimp.new("slope").with_values({"grid.cell": {"x": "5 m", "y": "2 m"}})
search = {"name": "F", "type": "strength-reduction", "path": "gravity", "steps": 5, "tolerance": 0.02}
search |= {"materials": ["clay"], "bracket": [0.5, 2.5], "geometry": "given"}
slope = slope.with_values({"stages": [search], "curves": [], "checks": []})


def factor(case, cohesion, friction):
    """Factor of safety of a draw; cohesion in kPa, friction in degrees."""
    case = case.with_values(
        {"materials.clay.cohesion": f"{cohesion} kPa", "materials.clay.friction": f"{friction} deg"}
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", igimp.CaseWarning)  # a factor below 1 is a result here
        return case.run(threads=1, progress=False).factor_of_safety


# %%
random = np.random.default_rng(2021)
cohesion = random.lognormal(np.log(14), 0.25, 16)
friction = random.normal(18, 2, 16)
factors = np.array(Parallel(n_jobs=2)(delayed(factor)(slope, c, phi) for c, phi in zip(cohesion, friction)))

print(f"F = {factors.mean():.2f} ± {factors.std(ddof=1):.2f}; {np.mean(factors < 1):.0%} of the draws fail")
assert np.corrcoef(cohesion, factors)[0, 1] > 0.5
