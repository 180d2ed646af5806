"""Constitutive laws that are written in Python."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

# Entries across the diagonal of a tangent that differ by more than this share of the largest one are no round-off.
_SKEW = 1e-6


@dataclass(frozen=True)
class Elasticity:
    """Isotropic linear relation between principal elastic Hencky strain and principal Kirchhoff stress.

    Parameters
    ----------
    young : float
        Young's modulus [Pa].
    poisson : float
        Poisson's ratio [-].
    """

    young: float
    poisson: float

    @property
    def bulk(self) -> float:
        """Bulk modulus [Pa]."""
        return self.young / (3 * (1 - 2 * self.poisson))

    @property
    def shear(self) -> float:
        """Shear modulus [Pa]."""
        return self.young / (2 * (1 + self.poisson))

    @property
    def tangent(self) -> Array:
        """Derivative of principal stress by principal strain, 3 x 3 [Pa]."""
        aside = self.bulk - 2 / 3 * self.shear
        return np.full((3, 3), aside) + 2 * self.shear * np.eye(3)

    def stress(self, strain: ArrayLike) -> Array:
        """Principal stresses of principal strains, (..., 3) [Pa], tension positive."""
        return np.asarray(strain, dtype=float) @ self.tangent

    def strain(self, stress: ArrayLike) -> Array:
        """Principal strains of principal stresses, (..., 3) [-], extension positive."""
        return np.asarray(stress, dtype=float) @ np.linalg.inv(self.tangent)


class Law:
    """A law of a material, written in Python and asked for all particles of the material at once.

    Derive a class, and write :meth:`return_map`. It is the contract of the laws of the engine: a pure function from
    trial strain to stress, in principal space, isotropic, with linear Hencky elasticity of the ``young`` and
    ``poisson`` of the material. The same input must give the same output. Give it to a material with
    :meth:`igimp.Case.with_laws`.

    It is slow: every pass over the particles asks Python once, on one thread. It is meant to try a law before it is
    written in Rust.

    Attributes
    ----------
    symmetric : bool
        Whether consistent tangents are symmetric: associated flow. False when in doubt.
    yields : bool
        Whether the law has a yield surface: locking of plastic flow concerns no other.
    """

    symmetric: bool = False
    yields: bool = True

    def return_map(self, strain: Array, eps_p_eq: Array, elastic: Elasticity) -> tuple[Array, Array]:
        """Stress and consistent tangent of trial states.

        Parameters
        ----------
        strain : ndarray (n, 3)
            Principal values of the trial elastic Hencky strain, in no order; extension positive [-].
        eps_p_eq : ndarray (n,)
            Accumulated plastic strain so far [-].
        elastic : Elasticity
            The elastic part.

        Returns
        -------
        tau : ndarray (n, 3)
            Principal Kirchhoff stress in the order of the strains, tension positive [Pa]. NaN where there is no
            answer: the step is cut.
        tangent : ndarray (n, 3, 3)
            Derivative of ``tau[a]`` by ``strain[b]`` [Pa].
        """
        raise NotImplementedError("write return_map(strain, eps_p_eq, elastic) of the law")

    def reduced(self, srf: float) -> Law:
        """The law with its strength divided by ``srf`` [-]; needed for stages that reduce strength."""
        raise NotImplementedError(f"{type(self).__name__} has no reduced(srf): its strength cannot be reduced")

    def identity(self) -> str:
        """What the law is, in words: a run is resumed only with a law that says the same."""
        kind = type(self)
        return f"{kind.__module__}.{kind.__qualname__}({', '.join(f'{k}={v!r}' for k, v in vars(self).items())})"

    def _answer(self, strain: Array, eps_p_eq: Array, young: float, poisson: float) -> tuple[Array, Array]:
        n = len(strain)
        answer: Any = self.return_map(strain, eps_p_eq, Elasticity(young, poisson))
        whose = f"return_map of {type(self).__name__}"
        try:
            tau, tangent = (np.asarray(part, dtype=float) for part in answer)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{whose} must answer stress and tangent, two arrays of numbers: {error}") from error
        if tau.shape != (n, 3) or tangent.shape != (n, 3, 3):
            raise ValueError(
                f"{whose} must answer arrays of shape ({n}, 3) and ({n}, 3, 3), "
                f"not {tau.shape} and {tangent.shape}"
            )
        if self.symmetric:
            # NaN is no answer, and compares as symmetric.
            skew = np.abs(tangent - tangent.transpose(0, 2, 1)).reshape(n, 9)
            size = np.abs(tangent).reshape(n, 9).max(axis=1, initial=0.0)
            wrong = np.flatnonzero((skew > _SKEW * size[:, None]).any(axis=1))
            if wrong.size:
                raise ValueError(
                    f"{whose} says symmetric = True, and its tangent at the strain {strain[wrong[0]].tolist()} is not: "
                    f"write symmetric = False in the class, or mend the tangent"
                )
        return np.ascontiguousarray(tau).reshape(-1), np.ascontiguousarray(tangent).reshape(-1)
