//! Contact at one knot of a surface: the mean gap and the mean slip around it as linear functions of
//! the step's displacements, and what they cause.

use std::borrow::Cow;

use crate::{ContactNode, Interface, Penalty, Shear, Tension, Turn};

/// Takes a block of the tangent: row, column, ∂f/∂u \[force/length\].
pub type AddBlock<'b, const D: usize> = dyn FnMut(usize, usize, &[[f64; D]; D]) + 'b;

/// Traction grows at most so much from step to step where soil covers less and less of a knot \[-\]. A choice: without a bound
/// the last bit of soil at a knot would carry all of its force; what is cut off is out of balance in one step, and found by it.
const MOST_GROWTH: f64 = 2.0;

/// Soil that covers less of a knot than this share hands its traction on, and not its force: soil that leaves a side takes along what it
/// carries \[-\]. A choice: forces that are carried on to the last crumb have no bound.
const CRUMB: f64 = 0.1;

/// Shear this near to its limit still sticks: what slipped in the last step begins the next one with the
/// tangent of sticking, whatever round-off says \[-\].
const ON_THE_LIMIT: f64 = 1e-12;

/// A body that is laid on soil overlaps it by so much of the smoothing length: five per cent of the stiffness of contact, an
/// eight-hundredth of the pressure at which it is stiff \[-\].
const SEAT: f64 = 0.05;

/// Soil that is no further off than so many cells still slips along an adhesive side at its limit, and touches straight sides from the
/// start on a given geometry: the smallest gap that a grid can tell from none, and as much as soil may go into a body \[-\].
pub const ADHESIVE_GAP: f64 = 0.1;

/// A linear function of nodal displacements.
pub type Functional<const D: usize> = Vec<(usize, [f64; D])>;

/// Arms of a body that turns in a step, from its reference point to the soil around a knot (theory, eq. 48a).
#[derive(Clone, Debug)]
pub struct Arms<const D: usize> {
    /// The node of its rotation.
    pub node: usize,
    /// The factor by which rotations become lengths \[length\].
    pub size: f64,
    /// Means of the arm times the normal; first the component of the arm \[length\].
    pub opening: [[f64; D]; D],
    /// Means of the arm times the tangents, likewise \[length\].
    pub slip: [[[f64; D]; D]; 2],
}

impl<const D: usize> Arms<D> {
    /// Of the opening and of the slip along the tangents.
    fn all(&self) -> [&[[f64; D]; D]; 3] {
        [&self.opening, &self.slip[0], &self.slip[1]]
    }
}

/// Contact at one knot of a surface.
#[derive(Clone, Debug)]
pub struct KnotContact<const D: usize> {
    /// The number of the body.
    pub body: usize,
    /// The number of the knot on its surface.
    pub knot: usize,
    /// Area that soil covers \[length^(D-1)\].
    pub area: f64,
    /// Mean gap at the step's start \[length\].
    pub gap: f64,
    /// Size of the cells \[length\].
    pub cell: f64,
    /// Young's modulus of the soil \[stress\].
    pub young: f64,
    /// Adhesion of the soil that touches \[stress\].
    pub adhesion: f64,
    /// Opening of the mean gap, by the part linear in the rotation of the body.
    pub opening: Functional<D>,
    /// Slip of the soil along the tangents, likewise.
    pub slip: [Functional<D>; 2],
    /// The arms that turn with the body; none where it does not turn, and where it is round.
    pub arms: Option<Arms<D>>,
    /// As the last step left it.
    pub before: ContactNode,
}

/// Traction at a knot with its derivatives by gap and slip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Traction {
    /// Pressure, positive when pressed \[stress\].
    pub pressure: f64,
    /// Shear on the soil \[stress\].
    pub shear: [f64; 2],
    /// ∂p/∂g \[stress/length\].
    pub by_gap: f64,
    /// ∂τ/∂g \[stress/length\].
    pub shear_by_gap: [f64; 2],
    /// ∂τ/∂s \[stress/length\].
    pub shear_by_slip: [[f64; 2]; 2],
    /// Whether the soil slips.
    pub slips: bool,
    /// Whether a bond breaks.
    pub breaks: bool,
}

impl<const D: usize> KnotContact<D> {
    /// Begins the step with the force that the last one left, on the area that is covered now of the `whole` of the knot (theory, eq.
    /// 50): soil that flows along a side hands its place on to other soil.
    pub fn carry_force(&mut self, interface: &Interface, penalty: &Penalty, whole: f64) {
        if self.before.area == 0.0 {
            return;
        }
        let covered = |area: f64| area.max(CRUMB * whole);
        let growth = (covered(self.before.area) / covered(self.area)).min(MOST_GROWTH);
        self.before.shear = self.before.shear.map(|shear| growth * shear);
        if !self.before.is_closed {
            return;
        }
        self.before.pressure *= growth;
        let stiffness = penalty.stiffness * self.young / self.cell;
        let smoothing = penalty.smoothing * self.cell;
        let pressure = self.before.pressure;
        let holds = interface.tension != Tension::None && !self.before.is_broken;
        self.gap = if holds {
            -pressure / stiffness
        } else if pressure > 0.5 * stiffness * smoothing {
            -pressure / stiffness - 0.5 * smoothing
        } else {
            -(2.0 * pressure.max(0.0) * smoothing / stiffness).sqrt()
        };
    }

    /// Takes over the gap that is `measured` of soil that came in the place of other \[length\], by the share of a cell that slid by in the last
    /// step (theory, eq. 50a); in steps that take time the gap only grows by it. Its slip then is on the limit still.
    pub fn take_soil_that_came(
        &mut self,
        (measured, takes_time): (f64, bool),
        interface: &Interface,
        penalty: &Penalty,
    ) {
        if self.before.area == 0.0 || !self.before.is_closed {
            return;
        }
        // Domains that overlap a side would throw soil off it.
        let least = [f64::NEG_INFINITY, self.gap][usize::from(takes_time)];
        let measured = measured.max(least);
        let share = (self.before.way / self.cell).min(1.0);
        self.gap += share * (measured - self.gap);
        if let (Shear::Limited { friction, .. }, true) = (&interface.shear, self.before.slips) {
            let limit = |pressure: f64| self.adhesion + friction * pressure.max(0.0);
            let before = limit(self.before.pressure);
            let now = limit(self.pressed(penalty, self.gap).0);
            if before > 0.0 {
                self.before.shear = self.before.shear.map(|shear| now / before * shear);
            }
        }
    }

    /// The pressure of a side without tension at a gap \[stress\], and its derivative \[stress/length\] (theory, eq. 46).
    fn pressed(&self, penalty: &Penalty, gap: f64) -> (f64, f64) {
        let stiffness = penalty.stiffness * self.young / self.cell;
        let smoothing = penalty.smoothing * self.cell;
        if gap >= 0.0 {
            (0.0, 0.0)
        } else if gap > -smoothing {
            (
                0.5 * stiffness * gap * gap / smoothing,
                stiffness * gap / smoothing,
            )
        } else {
            (stiffness * (-gap - 0.5 * smoothing), -stiffness)
        }
    }

    /// The way by which soil slides along the knot by nodal step displacements `u` \[length\].
    pub fn way(&self, u: &[[f64; D]]) -> f64 {
        let slip = self.slip_at(u);
        slip[0].hypot(slip[1])
    }

    /// Begins where a body that a force pushes was laid on soil: with a pressure that is next to nothing, and stiff.
    /// Without it nothing holds the body before it has moved (theory, eq. 46).
    pub fn seat(&mut self, penalty: &Penalty) {
        self.gap = self.gap.min(-SEAT * penalty.smoothing * self.cell);
    }

    /// The mean gap after nodal step displacements `u`.
    pub fn gap_at(&self, u: &[[f64; D]]) -> f64 {
        let beyond = self
            .turn(u)
            .map_or(0.0, |(arms, turn)| turn.work_beyond(&arms.opening));
        self.gap + value(&self.opening, u) - beyond
    }

    /// The slip of the soil along the tangents by nodal step displacements `u` \[length\].
    pub fn slip_at(&self, u: &[[f64; D]]) -> [f64; 2] {
        let turn = self.turn(u);
        [0, 1].map(|k| {
            let beyond = |(arms, turn): &(&Arms<D>, Turn<D>)| turn.work_beyond(&arms.slip[k]);
            value(&self.slip[k], u) - turn.as_ref().map_or(0.0, beyond)
        })
    }

    /// The turn of the body in a step by nodal step displacements `u`, with the arms that turn.
    fn turn(&self, u: &[[f64; D]]) -> Option<(&Arms<D>, Turn<D>)> {
        let arms = self.arms.as_ref()?;
        Some((arms, Turn::by(&u[arms.node], arms.size)))
    }

    /// Whether adhesion acts across a mean gap \[length\] (theory, eq. 47a): a crack carries none.
    pub fn adheres_at(&self, gap: f64, is_broken: bool) -> bool {
        self.adhesion > 0.0 && !is_broken && gap <= ADHESIVE_GAP * self.cell
    }

    /// Traction at nodal step displacements `u` (theory, eqs. 46 to 48).
    pub fn traction(&self, interface: &Interface, penalty: &Penalty, u: &[[f64; D]]) -> Traction {
        let stiffness = penalty.stiffness * self.young / self.cell;
        let gap = self.gap_at(u);
        let holds = !self.before.is_broken && self.before.is_closed;
        let mut out = Traction::default();
        match interface.tension {
            Tension::Bonded if holds || gap < 0.0 => {
                out.pressure = -stiffness * gap;
                out.by_gap = -stiffness;
            }
            Tension::Limit(limit) if holds && -stiffness * gap > -limit => {
                out.pressure = -stiffness * gap;
                out.by_gap = -stiffness;
            }
            Tension::Limit(limit) if holds => {
                out.pressure = -limit;
                out.breaks = true;
            }
            _ => {
                (out.pressure, out.by_gap) = self.pressed(penalty, gap);
            }
        }
        let held = penalty.tangential * stiffness;
        let slip = self.slip_at(u);
        let trial = [0, 1].map(|k| self.before.shear[k] - held * slip[k]);
        match &interface.shear {
            Shear::Rough if self.before.is_closed => {
                out.shear = trial;
                out.shear_by_slip = [[-held, 0.0], [0.0, -held]];
            }
            Shear::Smooth | Shear::Rough => {}
            Shear::Limited { friction, .. } => {
                let touches =
                    self.before.is_closed || self.adheres_at(self.gap, self.before.is_broken);
                let adhesion = if touches { self.adhesion } else { 0.0 };
                let limit = adhesion + friction * out.pressure.max(0.0);
                let size = trial[0].hypot(trial[1]);
                if limit <= 0.0 {
                    out.slips = true;
                } else if size <= (1.0 + ON_THE_LIMIT) * limit {
                    out.shear = trial;
                    out.shear_by_slip = [[-held, 0.0], [0.0, -held]];
                } else {
                    let along = trial.map(|t| t / size);
                    out.slips = true;
                    out.shear = along.map(|a| limit * a);
                    if out.pressure > 0.0 {
                        out.shear_by_gap = along.map(|a| friction * out.by_gap * a);
                    }
                    for k in 0..2 {
                        for l in 0..2 {
                            let across = f64::from(u8::from(k == l)) - along[k] * along[l];
                            out.shear_by_slip[k][l] = -held * limit / size * across;
                        }
                    }
                }
            }
        }
        out
    }

    /// Adds the internal force at nodal step displacements `u`, −A (p ∂g/∂u + τ ∂s/∂u), and hands its
    /// derivative on by blocks of nodes (row, column) (theory, eqs. 48 and 48a).
    pub fn add(
        &self,
        traction: &Traction,
        u: &[[f64; D]],
        f: &mut [[f64; D]],
        blocks: Option<&mut AddBlock<'_, D>>,
    ) {
        let tangents = D - 1;
        let turn = self.turn(u);
        let all = [&self.opening, &self.slip[0], &self.slip[1]];
        let of_arms = turn.as_ref().map(|(arms, turn)| (arms.all(), turn));
        let moments = of_arms.map(|(arms, turn)| arms.map(|arm| turn.moment_beyond(arm)));
        let [opening, first, second] = self.turned(all, moments);
        add(&opening, -self.area * traction.pressure, f);
        for (slip, shear) in [&first, &second]
            .into_iter()
            .zip(traction.shear)
            .take(tangents)
        {
            add(slip, -self.area * shear, f);
        }
        let Some(blocks) = blocks else {
            return;
        };
        if let Some((arms, turn)) = &turn {
            let [of_opening, first, second] = arms.all().map(|arm| {
                turn.slope_of_moment(arm)
                    .map(|row| row.map(|x| self.area * x))
            });
            let entry = |a: usize, b: usize| {
                traction.pressure * of_opening[a][b]
                    + traction.shear[0] * first[a][b]
                    + traction.shear[1] * second[a][b]
            };
            let block = std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)));
            blocks(arms.node, arms.node, &block);
        }
        let slopes = of_arms.map(|(arms, turn)| arms.map(|arm| turn.slope_beyond(arm)));
        let [of_gap, of_first, of_second] = self.turned(all, slopes);
        let (slip, of_slip) = ([first, second], [of_first, of_second]);
        let mut outer = |a: &Functional<D>, b: &Functional<D>, factor: f64| {
            if factor == 0.0 {
                return;
            }
            for (row, left) in a {
                for (column, right) in b {
                    blocks(*row, *column, &left.map(|l| right.map(|r| factor * l * r)));
                }
            }
        };
        outer(&opening, &of_gap, -self.area * traction.by_gap);
        for k in 0..tangents {
            let by_gap = -self.area * traction.shear_by_gap[k];
            outer(&slip[k], &of_gap, by_gap);
            for l in 0..tangents {
                let by_slip = -self.area * traction.shear_by_slip[k][l];
                outer(&slip[k], &of_slip[l], by_slip);
            }
        }
    }

    /// Functions whose shares of the rotation of the body are less by so much, once the body has turned.
    fn turned<'a>(
        &self,
        functions: [&'a Functional<D>; 3],
        beyond: Option<[[f64; D]; 3]>,
    ) -> [Cow<'a, Functional<D>>; 3] {
        let (Some(arms), Some(beyond)) = (&self.arms, beyond) else {
            return functions.map(Cow::Borrowed);
        };
        std::array::from_fn(|k| {
            let reduced = |&(at, share): &(usize, [f64; D])| {
                let by = if at == arms.node { beyond[k] } else { [0.0; D] };
                (at, std::array::from_fn(|axis| share[axis] - by[axis]))
            };
            Cow::Owned(functions[k].iter().map(reduced).collect())
        })
    }
}

/// The value of a linear function of nodal displacements.
fn value<const D: usize>(function: &Functional<D>, u: &[[f64; D]]) -> f64 {
    let terms = function.iter();
    terms
        .map(|(node, share)| (0..D).map(|axis| share[axis] * u[*node][axis]).sum::<f64>())
        .sum()
}

fn add<const D: usize>(function: &Functional<D>, factor: f64, f: &mut [[f64; D]]) {
    for (node, share) in function {
        for axis in 0..D {
            f[*node][axis] += factor * share[axis];
        }
    }
}

#[cfg(test)]
#[path = "../tests/units/knot_contact.rs"]
mod tests;
