"""Reads exported linear systems with numpy and scipy, and solves them anew."""

import json
import sys
from pathlib import Path

import numpy
import scipy.sparse
import scipy.sparse.linalg

for about_file in sorted(Path(sys.argv[1]).glob("*/*/matrix.json")):
    folder = about_file.parent
    about = json.loads(about_file.read_text())
    load = {path.stem: numpy.load(path) for path in folder.glob("*.npy")}
    n = about["unknowns"]
    matrix = scipy.sparse.csc_matrix(
        (load["values"], load["row_idx"], load["col_ptr"]), shape=(n, n)
    )
    assert matrix.has_sorted_indices and matrix.nnz == about["stored"]
    rhs, solution = load["rhs"], load["solution"]
    residual = numpy.abs(matrix @ solution - rhs).max() / numpy.abs(rhs).max()
    assert residual < 1e-9, residual
    again = scipy.sparse.linalg.splu(matrix).solve(rhs)
    difference = numpy.abs(again - solution).max() / numpy.abs(solution).max()
    assert difference < 1e-7, difference
    skew = abs(matrix - matrix.T).max() / abs(matrix).max()
    assert (skew < 1e-12) == about["symmetric"], skew
    places = load["places"]
    assert places.shape == (n, 3) and set(places[:, 2]) == {0, 1}
    assert len({tuple(place) for place in places}) == n
    entries = matrix.tocoo()
    apart = numpy.abs(places[entries.row, :2] - places[entries.col, :2]).max()
    assert apart == about["reach"], apart
    print(f"{folder.name}: {n} unknowns, residual {residual:.1e}, skew {skew:.1e}")
