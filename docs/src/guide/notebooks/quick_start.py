# %% [markdown]
# # Quick start
# A slope that comes with igimp, on a coarse grid so that it runs in seconds.

# %%
import igimp

case = igimp.new("slope")
case["grid.cell"] = {"x": "5 m", "y": "2 m"}
case["materials.clay.cohesion"] = "18 kPa"
print(case.check())

# %%
results = case.run(out="results/slope")
print(f"F = {results.factor_of_safety:.2f}")
results

# %% [markdown]
# Pictures of the run, as in its report:

# %%
results.figures

# %% [markdown]
# The state is arrays by particle, stresses tension positive; tables are data frames.

# %%
body = results.body
print(f"{len(body)} particles, q up to {body.q.max() / 1e3:.0f} kPa")
crest = results.monitors["crest"]
crest.tail(3)

# %% [markdown]
# A run is also a loop over its steps. Leaving the loop ends the run, with everything saved.

# %%
march = case.march()
for step in march:
    print(f"{step.stage} {step.number}: residual {step.residual:.0e}, {step.body.displacement[:, 1].min():.4f} m")
    if step.number == 5:
        break
