"""Reads the checkpoint that igimp wrote with numpy, changes it as a user would, and writes arrays
of its own for igimp to read.

usage: numpy_arrays.py FOLDER
"""

import hashlib
import json
import sys
from pathlib import Path

import numpy as np

folder = Path(sys.argv[1])
checkpoint = folder / "checkpoint" / "end"
meta = json.loads((checkpoint / "meta.json").read_text())
state = meta["states"][0]
arrays = {}
for name, entry in state["files"].items():
    path = checkpoint / state["name"] / f"{name}.npy"
    content = path.read_bytes()
    assert len(content) == entry["bytes"], name
    assert hashlib.sha256(content).hexdigest() == entry["sha256"], name
    arrays[name] = np.load(path, allow_pickle=False)
    assert arrays[name].flags.c_contiguous and len(content) % 64 == arrays[name].nbytes % 64, name
    again = folder / "again.npy"
    np.save(again, arrays[name])
    assert again.read_bytes() == content, f"{name}: numpy writes other bytes"

n = state["particles"]
compare = {name: (array.dtype.str, array.shape) for name, array in arrays.items()}
assert compare["sigma"] == ("<f8", (n, 3, 3)), compare
assert compare["x"] == ("<f8", (n, 2)), compare
assert compare["law"] == ("<u8", (n,)), compare
assert compare["regime"] == ("|u1", (n,)), compare

# A user who doubles all stresses.
path = checkpoint / state["name"] / "sigma.npy"
np.save(path, 2.0 * arrays["sigma"])
content = path.read_bytes()
state["files"]["sigma"] = {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
meta["sha256"] = ""
text = json.dumps(meta)
own = hashlib.sha256(text.encode()).hexdigest()
text = f'"sha256": "{own}"'.join(text.rsplit('"sha256": ""', 1))
(checkpoint / "meta.json").write_text(text)

np.save(folder / "i32.npy", np.arange(-3, 3, dtype=np.int32).reshape(2, 3))
np.save(folder / "f32.npy", np.ones(3, dtype=np.float32))
np.save(folder / "fortran.npy", np.asfortranarray(np.ones((2, 3))))
np.save(folder / "nothing.npy", np.empty((0, 2)))
np.save(folder / "number.npy", np.float64(2.5))
print("ok")
