//! How a rigid body moves in a step.

/// The drive of one component of a rigid body's motion over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// Its increment is prescribed: a displacement \[length\] or a rotation \[rad\].
    Moved(f64),
    /// It is found from equilibrium with this force \[force\] or moment about the reference point
    /// \[force · length\] at the end of the step.
    Loaded(f64),
}

/// The motion of one rigid body over a step: drives of its displacement along the axes, then of its
/// rotation (in the plane: anticlockwise; in space: about the axes).
#[derive(Clone, Debug, PartialEq)]
pub struct RigidMotion<const D: usize> {
    /// Of the displacement of the reference point.
    pub displacement: [Drive; D],
    /// Of the rotation: one component in the plane, three in space; those beyond are not looked at.
    pub rotation: [Drive; 3],
    /// Force at its centre of mass, beside its drives: its weight \[force\].
    pub weight: [f64; D],
}

impl<const D: usize> RigidMotion<D> {
    /// A body that is held.
    pub fn held() -> Self {
        Self {
            displacement: [Drive::Moved(0.0); D],
            rotation: [Drive::Moved(0.0); 3],
            weight: [0.0; D],
        }
    }

    /// A displacement without rotation \[length\].
    pub fn displaced(by: [f64; D]) -> Self {
        Self {
            displacement: by.map(Drive::Moved),
            ..Self::held()
        }
    }

    /// Whether a force pushes it along some axis, its weight counted.
    pub(crate) fn is_pushed(&self) -> bool {
        std::iter::zip(&self.displacement, &self.weight)
            .any(|(drive, weight)| matches!(drive, Drive::Loaded(force) if force + weight != 0.0))
    }

    /// Whether every number is finite.
    pub(crate) fn is_finite(&self) -> bool {
        let mut drives = self.displacement.iter().chain(&self.rotation);
        drives.all(|drive| match drive {
            Drive::Moved(value) | Drive::Loaded(value) => value.is_finite(),
        }) && self.weight.iter().all(|f| f.is_finite())
    }
}
