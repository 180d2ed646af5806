# %% [markdown]
# # Collapse of a column
# A column of dry sand is let go: its outline in time, and where its energy goes. On a coarse grid, so that it runs in seconds.

# %%
import igimp
import matplotlib.pyplot as plt
import numpy as np

case = igimp.new("column_collapse")
case["grid.cell"] = "2 cm"
case["output.paraview"] = {"every": 3}
results = case.run(out="results/collapse", progress=False)
print(results.stages[0].reason)

# %% [markdown]
# Particles at the end: they rest, on a heap whose toe ran out.

# %%
body = results.body
print(f"fastest particle {body.speed.max():.3f} m/s, toe at {body.x[:, 0].max():.2f} m")
plt.figure(figsize=(7, 2.5))
plt.scatter(*(100 * body.x.T), c=100 * np.linalg.norm(body.displacement, axis=1), s=12)
plt.colorbar(label="displacement [cm]")
plt.xlabel("x [cm]")
plt.ylabel("y [cm]")
plt.axis("equal")

# %% [markdown]
# The table of energy is read by the names of its columns: what gravity did is moving, then lost to plastic work.

# %%
energy = results.energy
plt.figure()
for name in ("loads", "kinetic", "plastic_work"):
    plt.plot(energy["time_[s]"], energy[f"{name}_[J/m]"], label=name.replace("_", " "))
plt.xlabel("time [s]")
plt.ylabel("energy [J/m]")
plt.legend()

# %% [markdown]
# Frames have their times in seconds; `results.frame(n)` reads one with PyVista, with `velocity [m/s]` among its arrays.

# %%
for seconds, file in results.motion():
    print(f"{seconds:.2f} s: {file.name}")
