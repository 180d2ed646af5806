"""Sparse direct solvers behind one interface, measured one at a time in a process of its own.

    python libraries.py NAME FOLDER

times the library NAME on the system in FOLDER (written by `igimp run --export-matrix`) and prints
one line of JSON. A library is a class with

    Library(matrix, symmetric)   what has to be done to the input first; not timed
    analyse(), factor()          ordering and symbolic work; numeric factorisation, repeatable
    solve(rhs)                   the solution
    entries()                    entries of the factors, None if the library does not tell
    VERSION                      of the library, where it tells
    place(places)                before the others, where it wants to know node and component of each unknown
    iterations                   of the last solution, where there were any

The number of threads comes from the environment (see `environment`).
"""

import ctypes
import ctypes.util
import json
import os
import sys
import time
from pathlib import Path


def environment(threads):
    """Variables that set the number of threads of every library here."""
    names = ["MKL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "RAYON_NUM_THREADS"]
    return {**os.environ, **{name: str(threads) for name in names}, "MKL_DYNAMIC": "FALSE"}


class Missing(Exception):
    """A library that is not installed, with how to install it."""


class Pardiso:
    """MKL PARDISO, METIS ordering: symmetric positive definite, or structurally symmetric."""

    SYMMETRIC, UNSYMMETRIC = 2, 1
    ANALYSE, FACTOR, SOLVE = 11, 22, 33

    def __init__(self, matrix, symmetric):
        import numpy
        import scipy.sparse

        try:
            from pypardiso import PyPardisoSolver
        except ImportError as error:
            raise Missing("pip install pypardiso") from error
        mkl = ctypes.CDLL(PyPardisoSolver().libmkl._name)
        self.VERSION = self.version_of(mkl)
        self.call = mkl.pardiso
        self.call.restype = None
        half = scipy.sparse.triu(matrix, format="csr") if symmetric else matrix.tocsr()
        half.sort_indices()
        self.kind = self.SYMMETRIC if symmetric else self.UNSYMMETRIC
        self.values = half.data
        self.starts = half.indptr.astype(numpy.int32)
        self.columns = half.indices.astype(numpy.int32)
        self.handle = numpy.zeros(64, dtype=numpy.int64)
        self.settings = numpy.zeros(64, dtype=numpy.int32)
        self.settings[0] = 1  # the settings below count
        self.settings[1] = 2  # METIS
        self.settings[9] = 8 if symmetric else 13  # perturbation of small pivots
        self.settings[17] = -1  # tell the entries of the factors
        self.settings[34] = 1  # numbers from 0
        self.none = numpy.zeros(1)

    @staticmethod
    def version_of(mkl):
        text = ctypes.create_string_buffer(200)
        mkl.mkl_get_version_string(text, 200)
        return text.value.decode().strip()

    def run(self, phase, rhs, solution):
        def integer(value):
            return ctypes.byref(ctypes.c_int32(value))

        def pointer(array):
            return ctypes.c_void_p(array.ctypes.data)

        error = ctypes.c_int32(0)
        self.call(
            pointer(self.handle), integer(1), integer(1), integer(self.kind), integer(phase),
            integer(len(self.starts) - 1), pointer(self.values), pointer(self.starts),
            pointer(self.columns), pointer(self.none), integer(1), pointer(self.settings),
            integer(0), pointer(rhs), pointer(solution), ctypes.byref(error),
        )  # fmt: skip
        if error.value:
            raise RuntimeError(f"PARDISO ends with error {error.value} in phase {phase}")

    def analyse(self):
        self.run(self.ANALYSE, self.none, self.none)

    def factor(self):
        self.run(self.FACTOR, self.none, self.none)

    def solve(self, rhs):
        solution = rhs.copy()
        self.run(self.SOLVE, rhs, solution)
        return solution

    def entries(self):
        return int(self.settings[17])


class GeneralPardiso(Pardiso):
    """MKL PARDISO, METIS ordering, general matrix with scaling and matching."""

    UNSYMMETRIC = 11

    def __init__(self, matrix, symmetric):
        super().__init__(matrix, symmetric)
        self.settings[10] = self.settings[12] = 1


class Cholmod:
    """CHOLMOD of SuiteSparse, supernodal, METIS ordering."""

    def __init__(self, matrix, symmetric):
        try:
            import sksparse
            import sksparse.cholmod
        except ImportError as error:
            raise Missing(
                "apt-get install libsuitesparse-dev libopenblas0-pthread; pip install scikit-sparse "
                "(==0.4.16 for SuiteSparse 5)"
            ) from error
        if not symmetric:
            raise ValueError("CHOLMOD is for symmetric matrices")
        from importlib.metadata import version

        self.VERSION = f"scikit-sparse {version('scikit-sparse')}"
        self.matrix = matrix
        self.cholmod = sksparse.cholmod
        self.factors = None

    def analyse(self):
        settings = {"mode": "supernodal", "ordering_method": "metis"}
        self.factors = self.cholmod.analyze(self.matrix, **settings)

    def factor(self):
        self.factors.cholesky_inplace(self.matrix)

    def solve(self, rhs):
        return self.factors.solve_A(rhs)

    def entries(self):
        return None


class Umfpack:
    """UMFPACK of SuiteSparse, symmetric strategy, METIS ordering, through its C interface."""

    CONTROL, INFO = 20, 90
    STRATEGY, ORDERING = 5, 10
    SYMMETRIC, METIS = 3, 3
    ENTRIES = (43, 44)

    def __init__(self, matrix, _symmetric):
        import numpy

        name = ctypes.util.find_library("umfpack")
        if name is None:
            raise Missing("apt-get install libsuitesparse-dev libopenblas0-pthread")
        self.library = ctypes.CDLL(name)
        self.VERSION = f"UMFPACK {Path(name).suffix.lstrip('.')}"
        self.matrix = matrix
        self.starts = matrix.indptr.astype(numpy.int32)
        self.rows = matrix.indices.astype(numpy.int32)
        self.control = numpy.zeros(self.CONTROL)
        self.info = numpy.zeros(self.INFO)
        self.library.umfpack_di_defaults(self.pointer(self.control))
        self.control[self.STRATEGY] = self.SYMMETRIC
        self.control[self.ORDERING] = self.METIS
        self.symbolic, self.numeric = ctypes.c_void_p(), ctypes.c_void_p()

    @staticmethod
    def pointer(array):
        return ctypes.c_void_p(array.ctypes.data)

    def arrays(self):
        return [self.pointer(array) for array in (self.starts, self.rows, self.matrix.data)]

    def report(self):
        return [self.pointer(self.control), self.pointer(self.info)]

    def check(self, status, what):
        if status < 0:
            raise RuntimeError(f"UMFPACK ends with status {status} in {what}")

    def analyse(self):
        n = self.matrix.shape[0]
        symbolic = ctypes.byref(self.symbolic)
        call = self.library.umfpack_di_symbolic
        self.check(call(n, n, *self.arrays(), symbolic, *self.report()), "analysis")

    def factor(self):
        if self.numeric:
            self.library.umfpack_di_free_numeric(ctypes.byref(self.numeric))
        numeric = ctypes.byref(self.numeric)
        call = self.library.umfpack_di_numeric
        self.check(call(*self.arrays(), self.symbolic, numeric, *self.report()), "factorisation")

    def solve(self, rhs):
        solution = rhs.copy()
        vectors = [self.pointer(solution), self.pointer(rhs)]
        call = self.library.umfpack_di_solve
        self.check(call(0, *self.arrays(), *vectors, self.numeric, *self.report()), "solution")
        return solution

    def entries(self):
        return int(sum(self.info[index] for index in self.ENTRIES))


class SuperLu:
    """SuperLU in scipy, minimum degree on the structure of K + Kᵀ; analysis is not apart."""

    def __init__(self, matrix, _symmetric):
        import scipy
        import scipy.sparse.linalg

        self.VERSION = f"SuperLU of scipy {scipy.__version__}"
        self.matrix = matrix
        self.splu = scipy.sparse.linalg.splu
        self.factors = None

    def analyse(self):
        pass

    def factor(self):
        options = {"SymmetricMode": True}
        order = "MMD_AT_PLUS_A"
        self.factors = self.splu(
            self.matrix, permc_spec=order, diag_pivot_thresh=0.01, options=options
        )

    def solve(self, rhs):
        return self.factors.solve(rhs)

    def entries(self):
        return int(self.factors.nnz)


class Gamg:
    """Conjugate gradients or GMRES of PETSc with its algebraic multigrid: smoothed aggregation with the
    six rigid body modes, blocks of three, Chebyshev smoothing with the blocks of nodes."""

    OPTIONS = {
        "pc_type": "gamg",
        "pc_gamg_type": "agg",
        "pc_gamg_agg_nsmooths": 1,
        "pc_gamg_threshold": 0.0,
        "mg_levels_ksp_type": "chebyshev",
        "mg_levels_pc_type": "pbjacobi",
        "ksp_rtol": 1e-8,
        "ksp_max_it": 1000,
        "ksp_norm_type": "unpreconditioned",
    }

    def __init__(self, matrix, symmetric):
        try:
            import petsc4py
        except ImportError as error:
            raise Missing("apt-get install python3-petsc4py-real python3-scipy") from error
        petsc4py.init([])
        from petsc4py import PETSc

        self.petsc, self.matrix, self.symmetric = PETSc, matrix, symmetric
        self.VERSION = "PETSc " + ".".join(str(part) for part in PETSc.Sys.getVersion())

    def place(self, places):
        """Gives every node three unknowns; those that are held get an equation of their own."""
        import numpy
        import scipy.sparse

        nodes, node = numpy.unique(places[:, :3], axis=0, return_inverse=True)
        self.slot = 3 * node.ravel() + places[:, 3]
        n = 3 * len(nodes)
        old = self.matrix.tocoo()
        held = numpy.setdiff1d(numpy.arange(n), self.slot)
        diagonal = numpy.full(len(held), abs(self.matrix.diagonal()).mean())
        rows = numpy.concatenate([self.slot[old.row], held])
        columns = numpy.concatenate([self.slot[old.col], held])
        values = numpy.concatenate([old.data, diagonal])
        # Whole blocks, also where PETSc would drop what is zero.
        full = scipy.sparse.csr_matrix((values, (rows, columns)), shape=(n, n))
        full.sort_indices()
        petsc = self.petsc
        arrays = (full.indptr.astype(petsc.IntType), full.indices.astype(petsc.IntType), full.data)
        self.operator = petsc.Mat().createAIJ(size=(n, n), bsize=3, csr=arrays)
        places_of_nodes = petsc.Vec().createWithArray(nodes.astype(float).ravel().copy(), bsize=3)
        modes = petsc.NullSpace().createRigidBody(places_of_nodes)
        self.operator.setNearNullSpace(modes)
        self.matrix = None

    def analyse(self):
        pass

    def factor(self):
        options = self.petsc.Options()
        kind = "cg" if self.symmetric else "gmres"
        for name, value in {**self.OPTIONS, "ksp_type": kind}.items():
            options[name] = value
        if not self.symmetric:
            options["ksp_pc_side"] = "right"
            options["ksp_gmres_restart"] = 50
        self.method = self.petsc.KSP().create()
        self.method.setOperators(self.operator)
        self.method.setFromOptions()
        self.method.setUp()

    def solve(self, rhs):
        right, solution = self.operator.createVecs()
        right.set(0.0)
        right.setValues(self.slot.astype(self.petsc.IntType), rhs)
        right.assemble()
        self.method.solve(right, solution)
        self.iterations = self.method.getIterationNumber()
        return solution.getArray()[self.slot]

    def entries(self):
        return None


class GamgByPoints(Gamg):
    """The same smoothed with single entries of the diagonal: blocks of a coarser grid can be singular."""

    OPTIONS = {**Gamg.OPTIONS, "mg_levels_pc_type": "jacobi"}


LIBRARIES = {
    "PETSc GAMG": Gamg,
    "PETSc GAMG, points": GamgByPoints,
    "PARDISO": Pardiso,
    "PARDISO general": GeneralPardiso,
    "CHOLMOD": Cholmod,
    "UMFPACK": Umfpack,
    "SuperLU": SuperLu,
}


def load(folder):
    """The matrix, the right-hand side, and what `matrix.json` says."""
    import numpy
    import scipy.sparse

    about = json.loads((folder / "matrix.json").read_text())
    values, rows, starts, rhs = (
        numpy.load(folder / f"{name}.npy") for name in ("values", "row_idx", "col_ptr", "rhs")
    )
    shape = (about["unknowns"], about["unknowns"])
    return scipy.sparse.csc_matrix((values, rows, starts), shape=shape), rhs, about


def resident(name):
    """A line of the system's account of this process [MiB], None where there is none."""
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
    except OSError:
        return None
    return next(float(line.split()[1]) / 1024 for line in lines if line.startswith(name))


def forget_peak():
    """Gives back what the input needed, and counts the peak of the memory anew."""
    try:
        ctypes.CDLL(None).malloc_trim(0)
        Path("/proc/self/clear_refs").write_text("5")
    except (AttributeError, OSError):
        pass


def measure(name, folder):
    """Analyses, factorises twice and solves; the second factorisation counts, as for igimp."""
    import numpy

    matrix, rhs, about = load(folder)
    library = LIBRARIES[name](matrix, about["symmetric"])
    if hasattr(library, "place"):
        library.place(numpy.load(folder / "places.npy"))
    forget_peak()
    before = resident("VmRSS:")
    times, processor = {}, {}
    for phase in ("analyse", "factor", "factor", "solve"):
        clock, start = time.perf_counter(), time.process_time()
        found = library.solve(rhs) if phase == "solve" else getattr(library, phase)()
        times[phase] = time.perf_counter() - clock
        processor[phase] = time.process_time() - start
    peak = resident("VmHWM:")
    residual = numpy.abs(matrix @ found - rhs).max() / numpy.abs(rhs).max()
    return {
        "solver": name,
        "version": library.VERSION,
        "unknowns": about["unknowns"],
        "symmetric": about["symmetric"],
        "analysis": times["analyse"],
        "factor": times["factor"],
        "solve": times["solve"],
        "analysis_cpu": processor["analyse"],
        "factor_cpu": processor["factor"],
        "solve_cpu": processor["solve"],
        "refinements": getattr(library, "iterations", None),
        "entries": library.entries(),
        "memory_mib": None if peak is None else peak - before,
        "residual": float(residual),
    }


if __name__ == "__main__":
    try:
        print(json.dumps(measure(sys.argv[1], Path(sys.argv[2]))))
    except Missing as missing:
        print(json.dumps({"missing": str(missing)}))
    except ImportError as error:
        print(json.dumps({"missing": f"pip install numpy scipy ({error})"}))
