//! The rigid footing: resistance against penetration, and fields at one width of penetration.

use std::path::Path;

use igimp_assembly::Method;
use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::figures::{
    Band as ShadedBand, Colour, ColourMap, CurvePlot, LineStyle, ReferenceLine, ReferenceValue,
    Series, SeriesStyle,
};
use igimp_cases::footing::{Footing, FootingResult};
use igimp_cases::measure::{displacement_norm, eps_p_eq, sigma};
use rayon::prelude::*;

use crate::pictures::{contours, scaled};
use crate::reference::{footing_sequential_limit_analysis, interpolate};
use crate::study::{Level, Run, Study, timed};

/// Source of the large-deformation curve.
const SEQUENTIAL: &str = "sequential limit analysis";

/// One push and what is asked of it.
struct Push {
    name: &'static str,
    label: String,
    footing: Footing,
    role: Role,
}

impl Push {
    /// The label with its subscript set.
    fn legend(&self) -> String {
        self.label.replace("s_u", "s_{u}")
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Role {
    /// Stiff soil, hardly any penetration.
    SmallStrain,
    /// To one width.
    Deep,
    /// Without B-bar: must be too stiff.
    Locked,
    /// Shown beside the others.
    Shown,
}

fn pushes(level: Level) -> Vec<Push> {
    let of = |name, label: &str, role, footing| Push {
        name,
        label: label.into(),
        footing,
        role,
    };
    let base = Footing::default;
    let mut pushes = vec![
        of(
            "small_strain_9",
            "iGIMP + B-bar, rough, B/h = 9, E/s_u = 1e4",
            Role::SmallStrain,
            Footing {
                young: 1e7,
                penetration: 0.005,
                steps: 20,
                ..base()
            },
        ),
        of(
            "locked_9",
            "iGIMP, rough, B/h = 9",
            Role::Locked,
            Footing {
                method: Method::igimp(),
                penetration: 0.2,
                steps: 15,
                ..base()
            },
        ),
        of(
            "rough_9",
            "iGIMP + B-bar, rough, B/h = 9",
            Role::Deep,
            base(),
        ),
    ];
    if level >= Level::Default {
        pushes.extend([
            of(
                "smooth_9",
                "iGIMP + B-bar, smooth, B/h = 9",
                Role::Shown,
                Footing {
                    rough: false,
                    ..base()
                },
            ),
            of(
                "rough_13",
                "iGIMP + B-bar, rough, B/h = 13",
                Role::Deep,
                Footing {
                    cells_per_width: 13,
                    steps: 130,
                    ..base()
                },
            ),
            of(
                "small_strain_13",
                "iGIMP + B-bar, rough, B/h = 13, E/s_u = 1e4",
                Role::SmallStrain,
                Footing {
                    cells_per_width: 13,
                    young: 1e7,
                    penetration: 0.005,
                    steps: 20,
                    ..base()
                },
            ),
        ]);
    }
    if level == Level::Full {
        pushes.extend([
            of(
                "impm_bbar_9",
                "iMPM + B-bar, rough, B/h = 9",
                Role::Shown,
                Footing {
                    method: Method::impm_bbar(),
                    ..base()
                },
            ),
            of(
                "rough_17",
                "iGIMP + B-bar, rough, B/h = 17",
                Role::Deep,
                Footing {
                    cells_per_width: 17,
                    steps: 170,
                    ..base()
                },
            ),
        ]);
    }
    pushes
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("footing", out)?;
    let pushes = pushes(level);
    let results = pushes
        .par_iter()
        .map(|push| timed(|| push.footing.run()))
        .collect::<Result<Vec<_>, _>>()?;
    let sequential = footing_sequential_limit_analysis().points("w_over_B", "N");
    for (push, (result, elapsed)) in pushes.iter().zip(&results) {
        let run = study.run_to_end(Run::new(push.label.clone(), &result.report, *elapsed));
        check(&mut study, push, run, result, &sequential);
        if push.role != Role::SmallStrain {
            study.newton(push.name, run)?;
        }
        let mut table = result.resistance.clone();
        table.name = format!("resistance_{}", push.name);
        study.table(table)?;
    }
    figures(
        &study,
        &pushes,
        &results.iter().map(|(result, _)| result).collect::<Vec<_>>(),
    )?;
    Ok(study)
}

fn check(
    study: &mut Study,
    push: &Push,
    run: usize,
    result: &FootingResult,
    sequential: &[[f64; 2]],
) {
    let prandtl = 2.0 + std::f64::consts::PI;
    match push.role {
        Role::SmallStrain => {
            let plateau = result.resistance_at(push.footing.penetration);
            let expected = (prandtl, "Prandtl 1920, 2 + π");
            study.check(
                run,
                "N at small strain [-]",
                expected,
                Band::Relative(0.02),
                plateau,
            );
        }
        Role::Deep => {
            let expected = (1.0, "set-up of Kardani et al. 2015");
            study.check(
                run,
                "w/B reached [-]",
                expected,
                Band::AtLeast(1.0),
                result.reached,
            );
            let expected = (interpolate(sequential, 0.2), SEQUENTIAL);
            let measured = result.resistance_at(0.2);
            study.check(
                run,
                "N at 0.2 B [-]",
                expected,
                Band::Relative(0.03),
                measured,
            );
            let source = "independent program 6.54; sequential limit analysis 5.95: open question";
            let measured = result.resistance_at(0.5);
            study.check(
                run,
                "N at 0.5 B [-]",
                (6.54, source),
                Band::Between(6.3, 6.7),
                measured,
            );
            let expected = match push.footing.cells_per_width {
                9 => 7.44,
                _ => 7.33,
            };
            let source = "independent program; sequential limit analysis 6.40: open question";
            let measured = result.resistance_at(1.0);
            study.check(
                run,
                "N at 1.0 B [-]",
                (expected, source),
                Band::Relative(0.03),
                measured,
            );
        }
        Role::Locked => {
            let with_bbar = interpolate(sequential, 0.2);
            let source = "30 % above sequential limit analysis: without B-bar it locks";
            study.check(
                run,
                "N at 0.2 B [-]",
                (1.3 * with_bbar, source),
                Band::AtLeast(1.3 * with_bbar),
                result.resistance_at(0.2),
            );
        }
        Role::Shown => {}
    }
}

fn figures(study: &Study, pushes: &[Push], results: &[&FootingResult]) -> Result<(), CaseError> {
    let sequential = footing_sequential_limit_analysis().points("w_over_B", "N");
    let mut series: Vec<Series> = pushes
        .iter()
        .zip(results)
        .filter(|(push, _)| push.role != Role::SmallStrain)
        .map(|(push, result)| Series::line(push.legend(), result.resistance.points(0, 1)))
        .collect();
    series.push(
        Series::new(
            "sequential limit analysis",
            sequential.clone(),
            SeriesStyle::Line(LineStyle::Dashed),
        )
        .in_colour(Colour::BLACK),
    );
    CurvePlot {
        title: "Rigid footing in Tresca soil, E/s_{u} = 100".into(),
        x_label: "penetration w/B".into(),
        y_label: "resistance N = Q/(B s_{u}), compression positive".into(),
        bands: vec![ShadedBand::around("± 3 %", &sequential, 0.03)],
        lines: vec![ReferenceLine {
            label: "2 + π".into(),
            at: ReferenceValue::Y(5.1416),
        }],
        series,
        ..CurvePlot::default()
    }
    .write(&study.folder.join("resistance"))?;

    let small: Vec<Series> = pushes
        .iter()
        .zip(results)
        .filter(|(push, _)| push.role == Role::SmallStrain)
        .map(|(push, result)| Series::line(push.legend(), result.resistance.points(0, 1)))
        .collect();
    CurvePlot {
        title: "Rigid footing in stiff Tresca soil".into(),
        x_label: "penetration w/B".into(),
        y_label: "resistance N = Q/(B s_{u}), compression positive".into(),
        lines: vec![ReferenceLine {
            label: "2 + π".into(),
            at: ReferenceValue::Y(5.1416),
        }],
        series: small,
        ..CurvePlot::default()
    }
    .write(&study.folder.join("resistance_small_strain"))?;

    for (push, result) in pushes.iter().zip(results) {
        if push.role != Role::Deep {
            continue;
        }
        let particles = &result.particles;
        let scale = 1e-3;
        let fields = [
            (
                "displacement",
                "displacement [m]",
                displacement_norm(particles),
                None,
            ),
            (
                "plastic_strain",
                "accumulated plastic strain invariant [-]",
                eps_p_eq(particles),
                Some((0.0, 3.0)),
            ),
            (
                "shear_stress",
                "shear stress τ_{xy} [kPa]",
                scaled(&sigma(particles, 0, 1), scale),
                Some((-1.0, 1.0)),
            ),
        ];
        for (name, label, values, range) in fields {
            let map = if name == "shear_stress" {
                ColourMap::Diverging
            } else {
                ColourMap::Sequential
            };
            let title = format!(
                "{}, w = {} B",
                push.label,
                igimp_cases::check::short(result.reached)
            );
            contours(title, particles, values, label, map, range)
                .write(&study.folder.join(format!("{name}_{}", push.name)))?;
        }
    }
    Ok(())
}
