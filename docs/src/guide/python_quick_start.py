import igimp

case = igimp.new("slope")                            # or igimp.Case.from_file("slope.toml")
case["materials.clay.cohesion"] = "18 kPa"           # any key of the case file, with its unit
case["grid.cell"] = {"x": "5 m", "y": "2 m"}         # coarse: seconds
print(case.check())                                  # particles, memory, time

results = case.run(out="results/slope")              # in memory without out=
print(f"F = {results.factor_of_safety:.2f}; checks met: {[check.met for check in results.checks]}")
print(f"{len(results.body)} particles, q up to {results.body.q.max() / 1e3:.0f} kPa")
