"""The state of the particles as arrays."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

REGIMES = (
    "elastic",
    "smooth part",
    "right edge",
    "left edge",
    "apex",
    "tension plane",
    "tension-shear edge",
    "tension edge",
    "tension corner",
    "tension apex",
)


# Shapes of a particle's entry in arrays that are handed over where something uses them, and zero else; None: as of x.
OPTIONAL: dict[str, tuple[int, ...] | None] = {
    "internal": (4,),
    "velocity": None,
    "acceleration": None,
    "hoop_strain": (),
}


class Body:
    """The particles of a body: one entry a particle in every array, ``d`` being 2 or 3.

    Stresses are **tension positive**, pressures of water compression positive. The arrays are the memory of the
    engine, handed over without a copy; changing them changes nothing that was computed.

    Attributes
    ----------
    x : ndarray (n, d)
        Position of the centre [m].
    displacement : ndarray (n, d)
        Displacement since the start, or since the last stage that reset it [m].
    velocity, acceleration : ndarray (n, d)
        Velocity [m/s] and acceleration [m/s^2] of a body that moves in time, else zero.
    sigma : ndarray (n, 3, 3)
        Cauchy stress that the law answers, tension positive; effective where there is water [Pa].
    def_grad : ndarray (n, d, d)
        Deformation gradient [-].
    hoop_strain : ndarray (n,)
        Strain around the axis of a body of revolution, else zero [-].
    b_e : ndarray (n, 3, 3)
        Elastic left Cauchy-Green tensor [-].
    eps_p_eq : ndarray (n,)
        Accumulated plastic strain [-].
    internal : ndarray (n, 4)
        Internal variables of the law, zero beyond those that it has [by law].
    half_length, half_length0 : ndarray (n, d)
        Half-lengths of the domain, now and as seeded [m].
    centroid : ndarray (n, d)
        Centroid of its soil within the domain as seeded, from the middle, over half-lengths [-].
    volume0 : ndarray (n,)
        Volume as seeded [m^3/m in plane strain, m^3 of whole bodies].
    mass : ndarray (n,)
        Mass [kg/m in plane strain, kg of whole bodies].
    pore_pressure, excess : ndarray (n,)
        Given pore pressure, and what soil made itself; compression positive [Pa].
    law : ndarray (n,)
        Number of the law: that of the material, counted from 0 in the order of the case.
    regime : ndarray (n,)
        Where on the yield surface the last return ended; names in ``igimp._body.REGIMES``.
    number : ndarray (n,)
        The number that a particle keeps, whatever others come and go.
    ratios : ndarray (n, 3)
        Strength, friction and stiffness over those of the law [-].
    """

    x: NDArray[np.float64]
    displacement: NDArray[np.float64]
    velocity: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    sigma: NDArray[np.float64]
    def_grad: NDArray[np.float64]
    hoop_strain: NDArray[np.float64]
    b_e: NDArray[np.float64]
    eps_p_eq: NDArray[np.float64]
    internal: NDArray[np.float64]
    half_length: NDArray[np.float64]
    half_length0: NDArray[np.float64]
    centroid: NDArray[np.float64]
    volume0: NDArray[np.float64]
    mass: NDArray[np.float64]
    pore_pressure: NDArray[np.float64]
    excess: NDArray[np.float64]
    law: NDArray[np.uint64]
    regime: NDArray[np.uint8]
    number: NDArray[np.uint64]
    ratios: NDArray[np.float64]

    def __init__(self, arrays: Mapping[str, NDArray[Any]], materials: tuple[str, ...] = ()) -> None:
        self.__dict__.update(arrays)
        for name, shape in OPTIONAL.items():
            if name not in arrays:
                extent = self.x.shape[1:] if shape is None else shape
                self.__dict__[name] = np.zeros((len(self.x), *extent))
        self.materials = materials

    @classmethod
    def load(cls, folder: str | Path, materials: tuple[str, ...] = ()) -> Body:
        """Reads the arrays of a checkpoint, such as ``results/slope/checkpoint/stage-01-end/current``."""
        files = {name: Path(folder) / f"{name}.npy" for name in cls.__annotations__ if name != "materials"}
        files = {name: file for name, file in files.items() if name not in OPTIONAL or file.exists()}
        return cls({name: np.load(file) for name, file in files.items()}, materials)

    def __len__(self) -> int:
        return len(self.x)

    def __repr__(self) -> str:
        return f"<igimp.Body: {len(self)} particles, {self.x.shape[1]}D>"

    @property
    def volume(self) -> NDArray[np.float64]:
        """Volume now [m^3/m in plane strain, m^3 of whole bodies]."""
        return self.volume0 * np.linalg.det(self.def_grad) * (1 + self.hoop_strain)

    @property
    def speed(self) -> NDArray[np.float64]:
        """Length of the velocity [m/s]."""
        return np.linalg.norm(self.velocity, axis=1)

    @property
    def total_stress(self) -> NDArray[np.float64]:
        """Total Cauchy stress, tension positive (n, 3, 3) [Pa]."""
        return self.sigma - (self.pore_pressure + self.excess)[:, None, None] * np.eye(3)

    @property
    def mean_stress(self) -> NDArray[np.float64]:
        """Mean of the stress that the law answers, tension positive [Pa]."""
        return np.trace(self.sigma, axis1=1, axis2=2) / 3

    @property
    def q(self) -> NDArray[np.float64]:
        """Deviator stress, sqrt(3/2) times the norm of the deviator [Pa]."""
        s = self.sigma - self.mean_stress[:, None, None] * np.eye(3)
        return np.sqrt(1.5 * np.einsum("nij,nij->n", s, s))

    @property
    def material(self) -> NDArray[Any]:
        """Name of the material of each particle."""
        return np.asarray(self.materials)[self.law.astype(int) % max(len(self.materials), 1)]

    def to_frame(self) -> Any:
        """A pandas data frame, a row a particle.

        Columns carry their units; stresses are tension positive, as in the arrays.
        """
        import pandas as pd

        axes = "xyz"[: self.x.shape[1]]
        columns: dict[str, Any] = {f"{a} [m]": self.x[:, k] for k, a in enumerate(axes)}
        columns |= {f"u_{a} [m]": self.displacement[:, k] for k, a in enumerate(axes)}
        if self.velocity.any() or self.acceleration.any():
            columns |= {f"v_{a} [m/s]": self.velocity[:, k] for k, a in enumerate(axes)}
            columns |= {f"a_{a} [m/s2]": self.acceleration[:, k] for k, a in enumerate(axes)}
        for i, a in enumerate("xyz"):
            for j, b in enumerate("xyz"[i:], start=i):
                columns[f"sigma_{a}{b} [Pa] tension +"] = self.sigma[:, i, j]
        columns |= {"eps_p_eq [-]": self.eps_p_eq, "volume": self.volume}
        if self.materials:
            columns["material"] = self.material
        return pd.DataFrame(columns)
