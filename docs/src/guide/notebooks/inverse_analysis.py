# %% [markdown]
# # Inverse analysis of a slope
# A slope has failed, so that its factor of safety was 1. Which cohesion had it, if its friction is known? A root
# finder of SciPy asks igimp for the factor. Every trial raises gravity on an undeformed slope (`path = "gravity"`), so
# that factors below 1 are found as well.

# %%
import warnings

from scipy.optimize import brentq

import igimp

warnings.simplefilter("ignore", igimp.CaseWarning)  # a factor below 1 is what is looked for

slope = igimp.new("slope").with_values({"grid.cell": {"x": "5 m", "y": "2 m"}})
search = {"name": "F", "type": "strength-reduction", "path": "gravity", "steps": 5, "tolerance": 0.02}
search |= {"materials": ["clay"], "bracket": [0.8, 1.6], "geometry": "given"}
slope = slope.with_values({"stages": [search], "curves": [], "checks": []})
asked = []


def excess(cohesion):
    """Factor of safety less 1 at a cohesion [kPa]."""
    case = slope.with_values({"materials.clay.cohesion": f"{cohesion} kPa"})
    found = case.run(progress=False).factor_of_safety
    asked.append((cohesion, found))
    return found - 1


# %% [markdown]
# The factor is an interval of a search (`tolerance = 0.02`): a root is not known better than that, and the root
# finder is told so.

# %%
cohesion = brentq(excess, 6, 20, xtol=0.2)
for at, found in asked:
    print(f"c = {at:5.2f} kPa: F = {found:.3f}")
print(f"the slope failed with c = {cohesion:.1f} kPa")
assert abs(excess(cohesion)) < 0.03
