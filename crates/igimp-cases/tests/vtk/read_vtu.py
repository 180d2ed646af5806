"""Opens what igimp wrote for ParaView with VTK, PyVista and meshio, and compares it with
expected.json in the same folder.

usage: read_vtu.py FOLDER
"""

import json
import sys
from pathlib import Path

import meshio
import numpy as np
import pyvista
import vtk
from vtk.util.numpy_support import vtk_to_numpy


class Errors:
    """Collects what a VTK reader complains about: it raises nothing."""

    def __init__(self, reader):
        self.found = []
        for event in ("ErrorEvent", "WarningEvent"):
            reader.AddObserver(event, lambda *_: self.found.append(event))


def compare(what, found, expected):
    assert found == expected, f"{what}: {found} instead of {expected}"


def compare_numbers(what, found, expected):
    found = np.asarray(found, dtype=float)
    expected = np.asarray(expected, dtype=float).reshape(found.shape)
    assert np.array_equal(found, expected, equal_nan=True), f"{what}: the numbers differ"


def check_array(what, array, expected):
    compare(f"{what}: components", array.GetNumberOfComponents(), expected["components"])
    names = [array.GetComponentName(k) for k in range(array.GetNumberOfComponents())]
    compare(f"{what}: component names", names, expected["component_names"] or [None])
    compare(f"{what}: type", array.GetDataTypeAsString(), expected["type"])
    compare_numbers(what, vtk_to_numpy(array), expected["values"])


def check_with_vtk(path, expected):
    reader = vtk.vtkXMLUnstructuredGridReader()
    errors = Errors(reader)
    reader.SetFileName(str(path))
    reader.Update()
    compare(f"{path.name}: complaints", errors.found, [])
    grid = reader.GetOutput()
    compare("points", grid.GetNumberOfPoints(), len(expected["points"]))
    compare("cells", grid.GetNumberOfCells(), expected["cells"])
    if expected["points"]:
        compare_numbers("points", vtk_to_numpy(grid.GetPoints().GetData()), expected["points"])
    for cell in range(grid.GetNumberOfCells()):
        compare("cell type", grid.GetCellType(cell), expected["cell_type"])
    if expected["cells"]:
        connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
        compare_numbers("connectivity", connectivity, expected["connectivity"])
        quality = vtk.vtkCellSizeFilter()
        quality.SetInputData(grid)
        quality.Update()
        measure = {3: "Length", 9: "Area", 12: "Volume"}[expected["cell_type"]]
        sizes = vtk_to_numpy(quality.GetOutput().GetCellData().GetArray(measure))
        assert np.all(sizes > 0), f"{path.name}: a cell is turned inside out"
        assert np.isclose(sizes.sum(), expected["size"], rtol=1e-9), "size of all cells"
    for data, arrays in ((grid.GetPointData(), "point_data"), (grid.GetCellData(), "cell_data")):
        names = [data.GetArrayName(k) for k in range(data.GetNumberOfArrays())]
        compare(f"{path.name}: {arrays}", names, [array["name"] for array in expected[arrays]])
        for array in expected[arrays]:
            check_array(array["name"], data.GetArray(array["name"]), array)
    times = grid.GetFieldData().GetArray("TimeValue")
    compare("TimeValue", vtk_to_numpy(times).tolist(), [expected["time"]])


def check_with_pyvista(path, expected):
    grid = pyvista.read(path)
    compare("points", grid.n_points, len(expected["points"]))
    compare("cells", grid.n_cells, expected["cells"])
    for array in expected["cell_data"]:
        compare_numbers(array["name"], grid.cell_data[array["name"]], array["values"])
    for array in expected["point_data"]:
        compare_numbers(array["name"], grid.point_data[array["name"]], array["values"])


def check_with_meshio(path, expected):
    if not expected["cells"]:
        return "skipped: meshio opens no file without cells"
    mesh = meshio.read(path)
    compare("points", len(mesh.points), len(expected["points"]))
    compare("cells", sum(len(block.data) for block in mesh.cells), expected["cells"])
    for array in expected["point_data"]:
        compare_numbers(array["name"], mesh.point_data[array["name"]], array["values"])
    kind = {3: "line", 9: "quad", 12: "hexahedron"}[expected["cell_type"]]
    compare("cell blocks", [block.type for block in mesh.cells], [kind])
    compare_numbers("connectivity", mesh.cells[0].data.ravel(), expected["connectivity"])
    for array in expected["cell_data"]:
        compare_numbers(array["name"], mesh.cell_data[array["name"]][0], array["values"])


def check_collection(path, expected):
    reader = pyvista.PVDReader(path)
    compare(f"{path.name}: times", list(reader.time_values), expected["times"])
    for k, cells in enumerate(expected["cells"]):
        reader.set_active_time_point(k)
        compare(f"{path.name}: frame {k}", reader.read()[0].n_cells, cells)


def main():
    folder = Path(sys.argv[1])
    expected = json.loads((folder / "expected.json").read_text())
    for name, grid in expected["grids"].items():
        for check in (check_with_vtk, check_with_pyvista, check_with_meshio):
            outcome = check(folder / name, grid) or "ok"
            print(f"{check.__name__} {name}: {outcome}")
    for name, collection in expected["collections"].items():
        check_collection(folder / name, collection)
        print(f"check_collection {name}: ok")


main()
