//! GOAL: what makes no sense is refused with the name of the field, and a march that finds no
//! equilibrium is a result with its reason, not an error.

use std::error::Error;

use igimp_assembly::{Method, Remedy};
use igimp_cases::column::Column;
use igimp_cases::footing::Footing;
use igimp_cases::mohr_coulomb_slope::MohrCoulombSlope;
use igimp_cases::slope::SlopeGeometry;
use igimp_cases::von_mises_slope::VonMisesSlope;
use igimp_solver::Outcome;

/// The error and all its causes on one line.
fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(next) = cause {
        text = format!("{text}: {next}");
        cause = next.source();
    }
    text
}

#[test]
fn nonsense_is_refused_by_name() {
    let column = |change: &dyn Fn(&mut Column)| {
        let mut column = Column::default();
        change(&mut column);
        chain(&column.run().unwrap_err())
    };
    assert_eq!(
        column(&|c| c.cells = 0),
        "cells is 0, but must be at least 1"
    );
    assert_eq!(
        column(&|c| c.steps = 0),
        "steps is 0, but must be at least 1"
    );
    assert_eq!(
        column(&|c| c.height = -1.0),
        "height is -1, but must be positive and finite"
    );
    let young = column(&|c| c.young = -5.0);
    assert!(
        young.starts_with("the material cannot be made: ") && young.contains("young"),
        "{young}"
    );

    let soft = VonMisesSlope {
        poisson: 0.5,
        ..VonMisesSlope::default()
    };
    let text = chain(&soft.run().unwrap_err());
    assert!(text.contains("poisson") && text.contains("0.5"), "{text}");
    let cell = VonMisesSlope {
        cell: 0.0,
        ..VonMisesSlope::default()
    };
    assert!(chain(&cell.run().unwrap_err()).starts_with("the grid cannot be made: "));
    let geometry = SlopeGeometry {
        crest: f64::NAN,
        ..VonMisesSlope::default().geometry
    };
    let slope = VonMisesSlope {
        geometry,
        ..VonMisesSlope::default()
    };
    assert_eq!(
        chain(&slope.run().unwrap_err()),
        "geometry.crest is NaN, but must be zero or positive, and finite"
    );

    let dilation = MohrCoulombSlope {
        dilation_angle: 0.6,
        ..MohrCoulombSlope::default()
    };
    let text = chain(&dilation.run(1.0).unwrap_err());
    assert!(text.contains("dilation_angle"), "{text}");
    let text = chain(&MohrCoulombSlope::default().run(0.0).unwrap_err());
    assert!(text.contains("srf"), "{text}");

    let even = Footing {
        cells_per_width: 8,
        ..Footing::default()
    };
    assert_eq!(
        chain(&even.run().unwrap_err()),
        "cells_per_width is 8, but must be odd, so that the footing's edge lies in the middle of \
         a cell"
    );
}

/// A column a million times too soft for one step: no equilibrium, and the reason is kept.
#[test]
fn a_march_that_stops_is_a_result() {
    let column = Column {
        young: 1e-2,
        steps: 1,
        cells: 8,
        ..Column::default()
    };
    let result = column.run().unwrap();
    let Outcome::StepTooSmall {
        last_converged,
        cause,
    } = &result.report.outcome
    else {
        panic!("{:?}", result.report.outcome)
    };
    assert!(*last_converged < 1.0);
    assert!(!cause.failure.to_string().is_empty());
    assert!(
        result.report.failures.len() >= 6,
        "one attempt and five cuts"
    );
    assert_eq!(result.stress.rows.len(), 32, "what was computed is kept");
}

/// The coarse column of the benchmark, against the exact solution.
#[test]
fn a_coarse_column_is_close_to_the_exact_solution() {
    let result = Column {
        cells: 16,
        ..Column::default()
    }
    .run()
    .unwrap();
    assert!(result.stress_error < 4e-3, "{}", result.stress_error);
    assert!((result.top / result.exact_top - 1.0).abs() < 5e-3);
    assert_eq!(result.report.outcome, Outcome::Completed);
}

/// What is done about small cuts shows in the column at E = 1 MPa with 128 cells: tying a node to
/// its neighbour keeps the accuracy of doing nothing, dropping it doubles the error.
#[test]
fn tying_small_cuts_costs_no_accuracy_and_dropping_them_does() {
    let error = |below, remedy| {
        let mut method = Method::igimp_bbar();
        method.small_cuts.below = below;
        method.small_cuts.remedy = remedy;
        let column = Column {
            method,
            cells: 128,
            young: 1e6,
            ..Column::default()
        };
        column.run().unwrap().stress_error
    };
    let (nothing, tied, dropped) = (
        error(0.0, Remedy::Tie),
        error(1e-4, Remedy::Tie),
        error(1e-4, Remedy::Drop),
    );
    for (measured, stated) in [(nothing, 2.32e-4), (tied, 2.29e-4), (dropped, 4.53e-4)] {
        assert!(
            (measured / stated - 1.0).abs() < 0.01,
            "{measured:e}, stated {stated:e}"
        );
    }
}
