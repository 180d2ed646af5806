# %% [markdown]
# # Tests of the laboratory
# Soil is tried before it is built upon: three clays of one kind that were loaded more in the past, sheared without drainage, and a sand
# whose parameters are fitted to its tests.

# %%
import igimp
import matplotlib.pyplot as plt
import numpy as np

clay = {"model": "modified-cam-clay", "unit_weight": "16 kN/m3", "lambda": 0.1, "kappa": 0.02, "critical_ratio": 1.0, "shear": "4 MPa"}

# %% [markdown]
# A clay with the ratio of overconsolidation R has, by the law's own equations, the undrained strength
# $s_u = \frac12 M p_0 (R/2)^\Lambda$ with $\Lambda = 1 - \kappa/\lambda$, where the shear modulus is a constant.

# %%
plt.figure()
for ratio in (1, 2, 8):
    test = igimp.element(clay | {"ocr": float(ratio)}, "triaxial-undrained", stress="100 kPa", strain=0.3)
    p, q = (np.asarray(test.table[name]) for name in ("p effective, compression positive [kPa]", "q [kPa]"))
    strength, exact = 0.5 * q[-1], 0.5 * 100 * (ratio / 2) ** 0.8
    print(f"R = {ratio}: s_u = {strength:.2f} kPa, in closed form {exact:.2f} kPa")
    assert abs(strength / exact - 1) < 2e-3
    plt.plot(p, q, label=f"R = {ratio}")
plt.plot([0, 160], [0, 160], "k:", label="critical state")
plt.xlabel("p [kPa]")
plt.ylabel("q [kPa]")
plt.legend()

# %% [markdown]
# The sand was compressed under three pressures. Its stiffness and its angle come from all tests at once, each with the interval in which
# it lies with 95 %.

# %%
sand = {"model": "mohr-coulomb", "unit_weight": "18 kN/m3", "young": "20 MPa", "poisson": 0.3, "cohesion": "5 kPa", "friction": "30 deg"}
strains = [0.1, 0.2, 0.4, 0.8, 1.5, 2.5, 4, 6]
measured = {
    "50 kPa": [27.4, 58.8, 120.7, 144.2, 143.2, 142.2, 146.7, 145.0],
    "100 kPa": [28.4, 57.7, 114.8, 239.9, 270.4, 272.1, 275.2, 271.5],
    "200 kPa": [29.5, 61.6, 119.3, 240.0, 447.5, 524.2, 522.8, 528.0],
}
tests = [{"stress": stress, "data": {"strain_yy [%]": strains, "q [kPa]": q}} for stress, q in measured.items()]
fit = igimp.fit(sand, {"young": None, "friction": ("20 deg", "45 deg")}, tests, small_strain=True)
for name, found in fit.parameters.items():
    print(f"{name}: {found.value:.2f} ± {found.error:.2f} {found.unit}")
assert abs(fit["friction"] - 34) < 0.3 and abs(fit["young"] - 30) < 0.5

# %% [markdown]
# Curves of the fitted law and what was measured, side by side.

# %%
plt.figure()
for (stress, q), own in zip(measured.items(), fit.tests):
    (line,) = plt.plot(own.table["strain_yy, compression positive [%]"], own.table["q [kPa]"], label=stress)
    plt.plot(strains, q, "o", color=line.get_color())
plt.xlabel("axial strain [%]")
plt.ylabel("q [kPa]")
plt.legend()
