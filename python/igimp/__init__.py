"""Large-deformation geotechnics by quasi-static implicit GIMP.

A case is what a case file says: grid, materials, bodies, stages. It is read, changed by keys, checked and run::

    import igimp

    case = igimp.new("slope")
    case["materials.clay.cohesion"] = "15 kPa"
    results = case.run(out="results/slope")
    print(results.factor_of_safety)

Numbers without a unit are in SI units where the case file takes them so. Stresses of the state (``body.sigma``)
are tension positive; tables, pictures and reports print compression positive and say so in their labels.
"""

from ._body import Body
from ._case import Case, Estimate, new, templates
from ._element import ElementTest, element
from ._errors import CaseWarning, Error, FileError, InputError, Interrupted, NotConverged, ReferenceMissed
from ._fit import Fit, Parameter, fit
from ._igimp import __version__
from ._law import Elasticity, Law
from ._march import March, Step
from ._results import Check, Figure, MeshResult, MeshStudy, Results, Stage

__all__ = [
    "Body",
    "Case",
    "CaseWarning",
    "Check",
    "Elasticity",
    "ElementTest",
    "Error",
    "Estimate",
    "Figure",
    "FileError",
    "Fit",
    "InputError",
    "Interrupted",
    "Law",
    "March",
    "MeshResult",
    "MeshStudy",
    "NotConverged",
    "Parameter",
    "ReferenceMissed",
    "Results",
    "Stage",
    "Step",
    "__version__",
    "element",
    "fit",
    "new",
    "open",
    "templates",
]

open = Results.open

# Messages name what users import.
for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = "igimp"
