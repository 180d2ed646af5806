//! All slopes in one picture: known intervals, and computed factors.

use std::path::Path;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_figures::{Band, CurvePlot, ReferenceLine, ReferenceValue, Series};

use super::Known;
use crate::limit_equilibrium::section::Variant;

/// Factors of safety over the middle of the known interval: the slope's number, mesh and method, factor.
pub(crate) fn write(
    folder: &Path,
    known: &[Known],
    points: &[(usize, Variant, f64)],
) -> Result<(), CaseError> {
    let middle = |slope: usize| 0.5 * (known[slope].interval[0] + known[slope].interval[1]);
    // One band of all intervals, without height between them.
    let edge = |end: usize| {
        let boxes = known.iter().enumerate().flat_map(|(slope, known)| {
            let (x, y) = (slope as f64 + 1.0, known.interval[end] / middle(slope));
            [(-0.4, 1.0), (-0.4, y), (0.4, y), (0.4, 1.0)].map(|(across, y)| [x + across, y])
        });
        boxes.collect()
    };
    let bands = vec![Band {
        label: "known".into(),
        lower: edge(0),
        upper: edge(1),
    }];
    let mut series = Vec::new();
    let hand = known.iter().enumerate();
    series.push(Series::markers(
        "by hand",
        hand.map(|(slope, known)| [slope as f64 + 1.0, known.opinion / middle(slope)])
            .collect(),
    ));
    let (shared, bbar) = (Locking::SharedStrain, Locking::BBar);
    for (label, coarse, locking, associated, aside) in [
        ("h = H/10", true, shared, true, -0.2),
        ("h = H/20", false, shared, true, 0.0),
        ("ψ = 0, h = H/10", true, shared, false, -0.1),
        ("ψ = 0, h = H/20", false, shared, false, 0.1),
        ("B-bar, h = H/10", true, bbar, true, 0.2),
        ("without, h = H/10", true, Locking::None, true, 0.3),
    ] {
        let chosen = points.iter().filter(|(_, variant, _)| {
            (variant.cells <= 10) == coarse
                && variant.locking == locking
                && variant.associated == associated
        });
        let chosen: Vec<[f64; 2]> = chosen
            .map(|&(slope, _, factor)| [slope as f64 + 1.0 + aside, factor / middle(slope)])
            .collect();
        if !chosen.is_empty() {
            series.push(Series::markers(label, chosen));
        }
    }
    CurvePlot {
        title: "Factors of safety over the middle of what is known".into(),
        x_label: "number of the slope".into(),
        y_label: "F / F_{known}".into(),
        x_range: Some((0.0, known.len() as f64 + 1.0)),
        lines: vec![ReferenceLine {
            label: String::new(),
            at: ReferenceValue::Y(1.0),
        }],
        bands,
        series,
        ..CurvePlot::default()
    }
    .write(&folder.join("factors_of_safety"))?;
    Ok(())
}
