//! The pictures of a test.

use igimp_figures::{CurvePlot, Series};
use igimp_solver::element::ElementState;

use super::Drive;
use super::table::{driven_name, driven_strain, pore_pressure};

/// Stress over strain, the path of stress, and volume or pore pressure over strain, by the names of their files.
pub(super) fn plots(
    states: &[ElementState],
    drive: &Drive,
    title: &str,
) -> Vec<(&'static str, CurvePlot)> {
    let x_label = format!("{} [%]", driven_name(drive));
    let over_strain = |y_label: &str, y: &dyn Fn(&ElementState) -> f64| CurvePlot {
        title: title.to_owned(),
        x_label: x_label.clone(),
        y_label: y_label.to_owned(),
        series: vec![Series::line(
            "",
            states
                .iter()
                .map(|state| [100.0 * driven_strain(state, drive), y(state)])
                .collect(),
        )],
        ..CurvePlot::default()
    };
    let (is_shear, undrained) = match drive {
        Drive::Standard(test, _) => (test.is_shear(), test.is_undrained().then_some(*test)),
        Drive::Path(_) => (false, None),
    };
    let stress = if is_shear {
        over_strain("shear stress τ_{xy} [kPa]", &|state| {
            state.sigma[0][1] / 1e3
        })
    } else {
        over_strain("q [kPa]", &|state| state.q() / 1e3)
    };
    let path = CurvePlot {
        title: title.to_owned(),
        x_label: "p', compression positive [kPa]".to_owned(),
        y_label: "q [kPa]".to_owned(),
        series: vec![Series::line(
            "",
            states
                .iter()
                .map(|state| [state.p() / 1e3, state.q() / 1e3])
                .collect(),
        )],
        ..CurvePlot::default()
    };
    let last = match undrained {
        Some(test) => (
            "pore-pressure",
            over_strain("pore pressure [kPa]", &|state| {
                pore_pressure(state, &states[0], test) / 1e3
            }),
        ),
        None => (
            "volume",
            over_strain("volumetric strain, compression positive [%]", &|state| {
                100.0 * state.volumetric_strain()
            }),
        ),
    };
    vec![("stress-strain", stress), ("stress-path", path), last]
}
