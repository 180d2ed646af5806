//! Supports.

use igimp_model::{Boundaries, FixedBox, Side};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::grid::{self as keys, FixedAxis};
use igimp_schema::tree::read::At;

use super::Frame;

/// The supports.
pub(crate) fn boundaries<const D: usize>(
    table: &keys::Boundaries<D>,
    frame: Option<&Frame<D>>,
    problems: &mut Problems,
) -> Option<Boundaries<D>> {
    let boxes: Vec<_> = (table.boxes.iter())
        .map(|part| fixed_box(part.as_ref().ok()?, frame, problems))
        .collect();
    let sides = table
        .by_axis()?
        .map(|both| both.map(|stated| side(**stated)));
    Some(Boundaries {
        sides,
        boxes: boxes.into_iter().collect::<Option<_>>()?,
    })
}

fn side(side: keys::Side) -> Side {
    match side {
        keys::Side::Roller => Side::Roller,
        keys::Side::Fixed => Side::Fixed,
        keys::Side::Free => Side::Free,
    }
}

fn fixed_box<const D: usize>(
    row: &At<keys::FixedBox<D>>,
    frame: Option<&Frame<D>>,
    problems: &mut Problems,
) -> Option<FixedBox<D>> {
    let (from, to) = (*row.from, *row.to);
    let lower: [f64; D] = std::array::from_fn(|axis| from[axis].min(to[axis]));
    let upper: [f64; D] = std::array::from_fn(|axis| from[axis].max(to[axis]));
    if let Some(frame) = frame {
        let has_nodes = (0..D).all(|axis| {
            let slack = 1e-6;
            let place = |x: f64| frame.axes[axis].place(x);
            let first = (place(lower[axis].max(frame.lower[axis])) - slack).ceil();
            first <= place(upper[axis].min(frame.upper[axis])) + slack
        });
        if !has_nodes {
            problems
                .warning(row.place, "there is no node in this box: it holds nothing")
                .help("let it reach over a line of the grid");
        }
    }
    let mut fix = [false; D];
    for axis in row.fix.iter() {
        let held = match **axis {
            FixedAxis::X => 0,
            FixedAxis::Y => 1,
            FixedAxis::Z => 2,
        };
        if held >= D {
            let name = axis.name();
            problems
                .error(
                    axis.place,
                    format!("there is no axis {name} in plane strain"),
                )
                .help("write x or y");
            return None;
        }
        fix[held] = true;
    }
    Some(FixedBox {
        name: row.name.value.clone(),
        lower,
        upper,
        fix,
    })
}
