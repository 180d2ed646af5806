//! Newton's method for the heads of a flow, the free surface approached from a wide fall of permeability.

use igimp_linear::{SolverKind, TangentMatrix};
use igimp_shape::Grid;

use crate::boundary::{At, Held, reach};
use crate::conditions::{Conditions, FreeWater, InGround, Named, OnFaces};
use crate::curve::{Curve, Relative};
use crate::error::SeepageError;
use crate::ground::{Bodies, SeepageBody, cells};
use crate::storage::{Moved, Storing};
use crate::system::{Flows, System};

/// Imbalance of a node over the largest flow at which heads are found \[-\].
pub(crate) const TOLERANCE: f64 = 1e-12;
/// The same of the imbalance of all nodes together, in time: a tenth of it counts \[-\].
const ALL_OVER_ONE: f64 = 0.1;
/// The same for flows on the way to the one that is asked for \[-\].
pub(crate) const ON_THE_WAY: f64 = 1e-3;
/// From one fall of permeability to the next \[-\].
const FACTOR: f64 = 3.0;
/// Falls of permeability that are put between others, at most.
const INSERTED: usize = 12;
/// Corrections for one fall of permeability.
const CORRECTIONS: usize = 30;
/// Corrections in time that are taken whole.
const FREE: usize = 15;
/// Digits of the flow between two nodes that their heads do not resolve \[-\].
const ROUND_OFF: f64 = f64::EPSILON;
/// Halvings of a correction.
const HALVINGS: usize = 8;

/// From a flow that is easy to find to the one that is asked for.
pub(crate) fn path<const D: usize>(
    asked: &Relative,
    height: f64,
    conditions: &Conditions<D>,
) -> Vec<Relative> {
    if asked.confined {
        return vec![*asked];
    }
    let mut widths = vec![asked.width];
    while let Some(last) = widths.last().copied().filter(|width| *width < height) {
        widths.push(FACTOR * last);
    }
    let count = widths.len();
    let has_curves = conditions
        .soils
        .iter()
        .any(|soil| soil.curve != Curve::Ramp);
    let steps = if has_curves { count.max(4) } else { count };
    (1..=steps)
        .map(|step| Relative {
            width: widths[count.saturating_sub(step)],
            exponent: step as f64 / steps as f64,
            ..*asked
        })
        .collect()
}

/// How permeability falls in the end.
pub(crate) fn relative_of<const D: usize>(grid: &Grid<D>, conditions: &Conditions<D>) -> Relative {
    let heights = &grid.axes[D - 1];
    let tallest = (0..heights.cell_count()).map(|cell| heights.spacing(cell));
    Relative {
        width: conditions.width.unwrap_or(tallest.fold(0.0, f64::max)),
        floor: conditions.floor,
        exponent: 1.0,
        confined: conditions.confined,
    }
}

/// Heads on their way to balance.
pub(crate) struct Search<'a, const D: usize> {
    pub(crate) system: System<'a, D>,
    matrix: TangentMatrix,
    solver: Box<dyn igimp_linear::LinearSolver>,
    pub(crate) heads: Vec<f64>,
    pub(crate) corrections: usize,
}

/// Heads that balance, in numbers.
pub(crate) struct Balanced {
    pub(crate) residual: Vec<f64>,
    pub(crate) flows: Flows,
    /// Largest imbalance of a node beyond the round-off of its flows \[m^D/s\].
    beyond: f64,
    /// The flow that an imbalance is held against \[m^D/s\].
    pub(crate) scale: f64,
    moved: Moved,
}

impl<'a, const D: usize> Search<'a, D> {
    /// The search in the ground that bodies make, without heads to begin with.
    pub(crate) fn of(
        grid: &'a Grid<D>,
        bodies: &[SeepageBody<'_, D>],
        conditions: &'a Conditions<D>,
        free: FreeWater<'_, D>,
    ) -> Result<Self, SeepageError> {
        check(conditions)?;
        let cells = cells(grid, &Bodies::new(bodies), conditions);
        let system = System::new(grid, cells, conditions, free)?;
        check_places(&system)?;
        // Where water comes out, a face acts on its own heads alone.
        let is_symmetric =
            conditions.confined && !(system.held.iter()).any(|held| matches!(held.at, At::Open(_)));
        Ok(Self {
            matrix: TangentMatrix::zeros(system.pattern.clone(), is_symmetric),
            solver: SolverKind::Auto.build(),
            heads: Vec::new(),
            corrections: 0,
            system,
        })
    }

    /// Goes from flow to flow, to a tolerance in the end; where one is not found, with one more between it and the one before.
    pub(crate) fn follow(
        &mut self,
        path: &[Relative],
        mut found: Option<Relative>,
        tolerance: f64,
    ) -> Result<(), SeepageError> {
        let Some(asked) = path.last() else {
            return Ok(());
        };
        let mut left: Vec<Relative> = path.iter().rev().copied().collect();
        let mut inserted = 0;
        while let Some(next) = left.last().copied() {
            let kept = self.heads.clone();
            let is_last = left.len() == 1;
            match (
                self.balance(&next, if is_last { tolerance } else { ON_THE_WAY }, None),
                found,
            ) {
                (Ok(_), _) => {
                    left.pop();
                    found = Some(next);
                }
                (Err(SeepageError::NotFound { .. }), Some(before)) if inserted < INSERTED => {
                    inserted += 1;
                    self.heads = kept;
                    left.push(Relative {
                        width: (before.width * next.width).sqrt(),
                        exponent: 0.5 * (before.exponent + next.exponent),
                        ..*asked
                    });
                }
                (Err(error), _) => return Err(error),
            }
        }
        Ok(())
    }

    /// Residual with the flow into storage, and flows.
    fn residual(
        &self,
        heads: &[f64],
        relative: &Relative,
        storing: Option<&Storing<'_>>,
    ) -> Vec<f64> {
        let (mut residual, _) = self.system.assemble(heads, relative, None);
        if let Some(storing) = storing {
            storing.add(&self.system, (heads, relative), &mut residual, None);
        }
        residual
    }

    /// Residual, tangent and flows at the heads.
    fn linearised(&mut self, relative: &Relative, storing: Option<&Storing<'_>>) -> Balanced {
        let matrix = &mut self.matrix;
        let (mut residual, flows) =
            (self.system).assemble(&self.heads, relative, Some(&mut *matrix));
        let round_off = round_off(matrix, &self.heads);
        let moved = storing.map_or_else(Moved::default, |storing| {
            let at = (&self.heads[..], relative);
            storing.add(&self.system, at, &mut residual, Some(matrix))
        });
        Balanced {
            scale: self.system.scale(&self.heads, &flows, moved.rate),
            beyond: largest_beyond(&residual, &round_off),
            moved,
            residual,
            flows,
        }
    }

    /// Takes as much of a correction as lessens the imbalance, or all of it where it is free; the balance after it.
    fn correct(
        &mut self,
        (step, before): (&[f64], f64),
        is_free: bool,
        relative: &Relative,
        storing: Option<&Storing<'_>>,
    ) -> Balanced {
        let kept = self.heads.clone();
        let moved = |share: f64| {
            let pairs = std::iter::zip(&kept, step);
            let mut heads: Vec<f64> = pairs.map(|(head, change)| head - share * change).collect();
            if let Some(storing) = storing.filter(|_| !relative.confined) {
                let soils = &self.system.conditions.soils;
                let is_sharp = soils.iter().any(|soil| soil.curve == Curve::Ramp);
                (storing.storage).stop_at_surface(&kept, &mut heads, (relative, is_sharp));
            }
            heads
        };
        let is_less = |residual: &[f64], share: f64| norm(residual) < (1.0 - 1e-2 * share) * before;
        // All of it is mostly taken: its tangent is made at once.
        self.heads = moved(1.0);
        let whole = self.linearised(relative, storing);
        if is_free || is_less(&whole.residual, 1.0) {
            return whole;
        }
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            share *= 0.5;
            self.heads = moved(share);
            if is_less(&self.residual(&self.heads, relative, storing), share) {
                break;
            }
        }
        self.linearised(relative, storing)
    }

    /// Corrects the heads until water balances.
    pub(crate) fn balance(
        &mut self,
        relative: &Relative,
        tolerance: f64,
        storing: Option<&Storing<'_>>,
    ) -> Result<Balanced, SeepageError> {
        // In time small imbalances of one sign would add up.
        let off = |state: &Balanced| {
            let sum = state.residual.iter().sum::<f64>().abs();
            let sum = storing.map_or(0.0, |_| ALL_OVER_ONE * (sum - state.moved.all_round_off));
            (state.beyond - state.moved.round_off).max(sum) / state.scale
        };
        let mut found = self.linearised(relative, storing);
        for correction in 0..CORRECTIONS {
            if off(&found) <= tolerance {
                return Ok(found);
            }
            self.solver.factor(&self.matrix)?;
            let mut step = vec![0.0; found.residual.len()];
            self.solver
                .solve(&self.matrix, &found.residual, &mut step)?;
            self.corrections += 1;
            // Between full pores and empty ones a correction may have to go uphill.
            let is_free = storing.is_some() && correction < FREE;
            let before = norm(&found.residual);
            found = self.correct((&step, before), is_free, relative, storing);
        }
        Err(SeepageError::NotFound {
            corrections: self.corrections,
            residual: off(&found),
        })
    }
}

/// Round-off of the flow out of each node \[m^D/s\], from the tangent of that flow and the heads \[m\].
fn round_off(matrix: &TangentMatrix, heads: &[f64]) -> Vec<f64> {
    let pattern = &matrix.pattern;
    let mut found = vec![0.0; heads.len()];
    for (column, head) in heads.iter().enumerate() {
        let values = &matrix.values[pattern.first_value[column]..];
        for (&row, value) in std::iter::zip(pattern.coupled_to(column), values) {
            found[row as usize] += ROUND_OFF * (value * head).abs();
        }
    }
    found
}

/// The largest of some imbalances without their signs, each less its round-off; infinite with one that is no number.
fn largest_beyond(imbalances: &[f64], round_off: &[f64]) -> f64 {
    let pairs = std::iter::zip(imbalances, round_off);
    pairs.fold(0.0, |most, (imbalance, below)| {
        let beyond = imbalance.abs() - below;
        if beyond.is_nan() {
            f64::INFINITY
        } else {
            beyond.max(most)
        }
    })
}

fn norm(values: &[f64]) -> f64 {
    let sum: f64 = values.iter().map(|value| value * value).sum();
    if sum.is_finite() {
        sum.sqrt()
    } else {
        f64::INFINITY
    }
}

/// The highest head that is given; none without one.
pub(crate) fn start_of<const D: usize>(system: &System<'_, D>) -> Option<f64> {
    let on_faces = system.held.iter().filter_map(|held| match held.at {
        At::Head(head) => Some(head),
        At::Open(_) => Some(held.facet.x[D - 1]),
        At::Inflow(_) | At::Closed => None,
    });
    let within = system.conditions.regions.iter();
    let within = within.filter_map(|region| match region.condition {
        InGround::Head(head) => Some(head),
        InGround::Drain => Some(region.within.lower[D - 1]),
        InGround::Inflow(_) | InGround::Soil(_) => None,
    });
    on_faces.chain(within).reduce(f64::max)
}

/// Whether anything says how much water is in the ground: a head, or water that enters. Without, it is as full as the start is.
pub(crate) fn is_fed<const D: usize>(system: &System<'_, D>) -> bool {
    let on_faces = system.held.iter().any(|held| match held.at {
        At::Head(_) => true,
        At::Inflow(inflow) | At::Open(inflow) => inflow > 0.0,
        At::Closed => false,
    });
    let within = &system.conditions.regions;
    let within = within.iter().any(|region| match region.condition {
        InGround::Head(_) => true,
        InGround::Inflow(inflow) => inflow > 0.0,
        InGround::Drain | InGround::Soil(_) => false,
    });
    on_faces || within
}

/// Refuses numbers that do not serve.
fn check<const D: usize>(conditions: &Conditions<D>) -> Result<(), SeepageError> {
    let refuse = |quantity: String, value: f64, wanted| {
        Err(SeepageError::Value {
            quantity,
            value,
            wanted,
        })
    };
    let is_positive = |value: f64| value > 0.0 && value.is_finite();
    for (index, soil) in conditions.soils.iter().enumerate() {
        for (name, value) in [("along", soil.along), ("across", soil.across)] {
            if !is_positive(value) {
                let quantity = format!("the permeability {name} the bedding of soil {index}");
                return refuse(quantity, value, "positive");
            }
        }
        if !soil.angle.is_finite() {
            return refuse(format!("the angle of soil {index}"), soil.angle, "a number");
        }
        match soil.curve {
            Curve::Gardner { alpha } | Curve::VanGenuchten { alpha, .. } if !is_positive(alpha) => {
                return refuse(format!("alpha of soil {index}"), alpha, "positive");
            }
            Curve::VanGenuchten { n, .. } if !(n > 1.0 && n.is_finite()) => {
                return refuse(format!("n of soil {index}"), n, "above 1");
            }
            _ => {}
        }
    }
    if !(conditions.floor > 0.0 && conditions.floor < 1.0) {
        return refuse("the floor".to_owned(), conditions.floor, "between 0 and 1");
    }
    match conditions.width {
        Some(width) if !is_positive(width) => refuse("the width".to_owned(), width, "positive"),
        _ => Ok(()),
    }
}

/// Refuses conditions that hold nowhere.
fn check_places<const D: usize>(system: &System<'_, D>) -> Result<(), SeepageError> {
    let refuse = |name: &str, problem| {
        Err(SeepageError::Empty {
            name: name.to_owned(),
            problem,
        })
    };
    let reach = reach(system.grid);
    let bare = |face: &Named<D, OnFaces>, held: &Held<D>| face.within.holds(&held.facet.x, reach);
    for face in &system.conditions.faces {
        if !system.held.iter().any(|held| bare(face, held)) {
            return refuse(
                &face.name,
                "holds no face of the ground: its box has to reach over one",
            );
        }
    }
    for (index, region) in system.conditions.regions.iter().enumerate() {
        let points = system.cells.iter().flat_map(|cell| &cell.points);
        let holds = |point: &crate::basis::Point<D>| match region.condition {
            InGround::Soil(_) => region.within.holds(&point.x, 0.0),
            _ => point.region == Some(index),
        };
        if !points.into_iter().any(holds) {
            return refuse(
                &region.name,
                "holds no point of the ground: make its box as large as half a cell",
            );
        }
    }
    Ok(())
}
