# %% [markdown]
# # A clay that consolidates
# A fill lies on five metres of clay. The table of a curve against Terzaghi's series, and what another permeability changes.

# %%
import igimp
import matplotlib.pyplot as plt
import numpy as np

case = igimp.new("consolidation")
results = case.run(out="results/consolidation", progress=False)
for check in results.checks:
    print(f"{check.name}: {check.value:.4f}, by the series {check.reference:.4f}")

# %% [markdown]
# Terzaghi's series: the degree of consolidation at T = c_v t / H², with c_v = k M / γ_w.


# %%
def degree(time_factor):
    odd = np.pi * (np.arange(200) + 0.5)
    return 1 - (2 / odd**2 * np.exp(-(odd**2) * time_factor[:, None])).sum(axis=1)


k, modulus, height, load = 5e-11, 24e6, 5.0, 10e3
c_v = k * modulus / 9.81e3
days = np.geomspace(3, 3650, 60)
exact = 1e3 * load * height / modulus * degree(c_v * 86400 * days / height**2)


# %%
def settlement(results):
    """Days above zero, and settlements [mm]."""
    table = results.curves["settlement"]
    days, settled = (np.asarray(table[name]) for name in ("time [d]", "settlement [mm]"))
    return days[days > 0], settled[days > 0]


# %% [markdown]
# A clay ten times as permeable is done in a year.

# %%
fast = case.with_values({"materials.clay.permeability": "5e-10 m/s"}).run(progress=False)
plt.semilogx(*settlement(results), "o", markersize=4, label="igimp")
plt.semilogx(*settlement(fast), "s", markersize=4, label="k ten times as large")
plt.semilogx(days, exact, "k--", label="Terzaghi")
plt.xlim(1, 4000)
plt.xlabel("time [d]")
plt.ylabel("settlement [mm]")
plt.legend()

# %%
first = np.interp(365.25, *settlement(results))
assert abs(first - np.interp(365.25, days, exact)) < 0.01 * exact[-1]
print(f"settlement after a year: {first:.3f} mm of {exact[-1]:.3f} mm")
