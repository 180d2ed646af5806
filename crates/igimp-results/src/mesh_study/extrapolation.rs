//! From values on several meshes to a value on cells of no size, and how far that may be off.
//!
//! Pure functions of numbers; theory, eqs. (40a) to (40g).

use serde::{Deserialize, Serialize};

use super::order::{Convergence, FASTEST, Order, USUAL, of_three, of_two, share};

/// Share of the correction that stays in doubt when the order is observed \[-\].
const IN_DOUBT: f64 = 0.25;
/// Factor on the range of values that follow no order \[-\].
const WITHOUT_ORDER: f64 = 3.0;
/// Uncertainty of a limit load or factor of safety on a single mesh where several meshes do not reveal it, as a share
/// of it \[-\].
const SINGLE_MESH: f64 = 0.03;

/// A value on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Computed {
    /// Size of the cells; only ratios matter \[any length\].
    pub h: f64,
    /// The value.
    pub value: f64,
    /// Half the width of the interval in which a search left it; 0 for a value that was not
    /// searched for.
    pub half_width: f64,
}

/// The value on cells of no size, estimated from values on several meshes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The extrapolated value; that of the finest mesh where nothing is extrapolated.
    pub value: f64,
    /// How far it may be off, to either side.
    pub uncertainty: f64,
    /// The order of convergence, as far as it is known.
    pub order: Order,
}

/// Extrapolates values on two or three meshes, from coarse to fine; of more the three finest count (theory,
/// eqs. 40a, 40e).
///
/// `None` for fewer than two finite values, and for meshes that do not become finer.
pub fn estimate(values: &[Computed], known: Convergence) -> Option<Estimate> {
    let right = |value: &&Computed| {
        value.value.is_finite()
            && value.half_width.is_finite()
            && value.half_width >= 0.0
            && value.h > 0.0
            && value.h.is_finite()
    };
    let values: Vec<Computed> = values.iter().filter(right).copied().collect();
    let values = &values[values.len().saturating_sub(3)..];
    if values.len() < 2 || values.windows(2).any(|pair| pair[1].h >= pair[0].h) {
        return None;
    }
    let [coarse, fine] = [values[values.len() - 2], values[values.len() - 1]];
    let order = match values {
        [a, b, c] => of_three([a, b, c], known),
        _ => of_two(&coarse, &fine, known),
    };
    // The rest of the change between the last two meshes, as a share of it.
    let share = |p| share(coarse.h, fine.h, p);
    let (value, uncertainty) = match order.used() {
        None => (
            fine.value,
            without_order(values, order, known) + fine.half_width,
        ),
        Some(p) => {
            let left = share(p);
            let value = fine.value + left * (fine.value - coarse.value);
            (value, around(values, order, p, known, &share))
        }
    };
    Some(Estimate {
        value,
        uncertainty: uncertainty.max(known.least * value.abs()),
        order,
    })
}

/// How far the value extrapolated with order p may be off, by the mesh and by the search (theory, eqs. 40e, 40f).
fn around(
    values: &[Computed],
    order: Order,
    p: f64,
    known: Convergence,
    share: &dyn Fn(f64) -> f64,
) -> f64 {
    let [coarse, fine] = [values[values.len() - 2], values[values.len() - 1]];
    let change = (coarse.value - fine.value).abs();
    // Another order in place of p, with all that the search lets the values be with it.
    let with = |other: f64| {
        let left = share(other);
        (left - share(p)).abs() * change + (1.0 + left) * fine.half_width + left * coarse.half_width
    };
    let observed = |from: f64, to: f64| {
        (IN_DOUBT * share(p) + (share(p) - share(USUAL)).abs()) * change + with(from).max(with(to))
    };
    match order {
        Order::Observed(p) => observed(p, p),
        Order::Admitted { from, to } => observed(from, to),
        Order::Limited { observed, used } => {
            // The first change foretells the second by the usual order.
            let foretold = match values {
                [a, b, c] => (a.value - b.value).abs() * (b.h - c.h) / (a.h - b.h),
                _ => 0.0,
            };
            let in_doubt = if observed < used {
                share(used)
            } else {
                share(known.slowest) - share(USUAL)
            };
            in_doubt * change.max(foretold) + with(p)
        }
        _ => with(known.slowest).max(with(FASTEST)),
    }
}

/// How far a value may be off where nothing is extrapolated (theory, eq. 40e).
fn without_order(values: &[Computed], order: Order, known: Convergence) -> f64 {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values {
        (low, high) = (low.min(value.value), high.max(value.value));
    }
    let range = WITHOUT_ORDER * (high - low);
    let is_load = order == Order::Rising || known.falls;
    if is_load {
        range.max(SINGLE_MESH * low.abs().max(high.abs()))
    } else {
        range
    }
}
