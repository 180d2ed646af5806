//! A member in a strip of elastic soil one cell high: its force is that of a bar.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::tables::table::Table;

use super::case;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use crate::runs::Computed;

/// The book's description of the study.
const ABOUT: &str = "A strip of elastic soil, one cell high and without Poisson's ratio, is pulled or pressed with a member of reinforcement in it: elastic, at its capacity, slack, with a bond that lets its ends slip, and stressed by a jack and locked off. Soil and member share the load by their stiffness, cell by cell.";
const BAR: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "two bars side by side",
    locator: "N = EA ε up to its limit, E H ε + N = p H",
};
const STRIP: &str = include_str!("strip.toml");

/// Young's modulus of the soil \[Pa\]; the strip is 1 m high and has cells of 1 m.
const YOUNG: f64 = 100e6;
/// Axial stiffness of the member \[N/m\].
const STIFFNESS: f64 = 60e6;
/// Pressure on its end \[Pa\].
const PULL: f64 = 100e3;

/// A strip with its member.
struct Strip {
    name: &'static str,
    overrides: &'static [&'static str],
    /// Largest tension \[N/m\], and the accepted deviation of it as a share.
    force: f64,
    tolerance: f64,
}

/// Mean tension of a cell's four bars at a strain, with the limits of their bond.
fn mean(strain: f64, limits: &[f64]) -> f64 {
    let force = |limit: &f64| (STIFFNESS * strain).clamp(0.0, *limit);
    limits.iter().map(force).sum::<f64>() / limits.len() as f64
}

/// The strain of a cell in which soil and member balance the pull.
fn strain(limits: &[f64]) -> f64 {
    let (mut low, mut high) = (0.0, PULL / YOUNG);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if YOUNG * middle + mean(middle, limits) > PULL {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// Runs the study.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("reinforcement-bar", ABOUT, out)?;
    let elastic = STIFFNESS / (YOUNG + STIFFNESS) * PULL;
    let anchor = "reinforcement.member.capacity=\"1 MN/m\"";
    let strips = [
        Strip {
            name: "elastic",
            overrides: &[],
            force: elastic,
            tolerance: 1e-9,
        },
        Strip {
            name: "elastic, moving geometry",
            overrides: &["stages.pull.geometry=moving"],
            force: elastic,
            tolerance: 1e-3,
        },
        Strip {
            name: "elastic, moving geometry, small strain",
            overrides: &["stages.pull.geometry=moving", "grid.kinematics=small"],
            force: elastic,
            tolerance: 1e-3,
        },
        Strip {
            name: "at its capacity",
            overrides: &["reinforcement.member.capacity=\"30 kN/m\""],
            force: 30e3,
            tolerance: 1e-12,
        },
        Strip {
            name: "pressed",
            overrides: &["loads.pull.pressure=\"100 kPa\""],
            force: 0.0,
            tolerance: 0.0,
        },
    ];
    for strip in &strips {
        let set: Vec<String> = strip.overrides.iter().map(|&t| t.to_owned()).collect();
        let computed = Computed::new(case("strip.toml", STRIP, &set)?)?;
        let record = RunRecord::new(strip.name, &computed.report, computed.elapsed);
        let run = study.run_to_end(record);
        let bars = &computed.run.body.reinforcement[0].segments;
        // On a moving geometry the end of the strip reaches a little into a cell: the bar in the middle tells.
        let moves = strip.name.contains("moving");
        let looked_at = if moves { &bars[18..22] } else { &bars[..] };
        let force = looked_at
            .iter()
            .map(|bar| bar.state.force)
            .max_by(|a, b| (a - strip.force).abs().total_cmp(&(b - strip.force).abs()))
            .unwrap_or(f64::NAN);
        let band = if strip.force > 0.0 {
            Band::Relative(strip.tolerance)
        } else {
            Band::Between(0.0, 0.0)
        };
        let quantity = if moves {
            "N in the middle [N/m]"
        } else {
            "N of the bar furthest off [N/m]"
        };
        study.check(run, quantity, BAR.says(strip.force), band, force);
    }
    pull_out(&mut study)?;
    locked_off(&mut study, anchor)?;
    Ok(study)
}

/// A member without heads: its ends slip, and its tension grows with the distance from them.
fn pull_out(study: &mut Study) -> Result<(), CaseError> {
    let bond = 12e3;
    let overrides = [
        "reinforcement.member.head_capacity=\"0 kN/m\"",
        "reinforcement.member.end_capacity=\"0 kN/m\"",
        "reinforcement.member.bond=\"12 kPa\"",
    ]
    .map(str::to_owned);
    let computed = Computed::new(case("strip.toml", STRIP, &overrides)?)?;
    let record = RunRecord::new("ends that slip", &computed.report, computed.elapsed);
    let run = study.run_to_end(record);
    let bars = &computed.run.body.reinforcement[0].segments;
    let mut table = Table::new("pull_out", &["x_[m]", "N_[N/m]", "exact_[N/m]"]);
    let mut worst = 0.0_f64;
    for (cell, group) in bars.chunks(4).enumerate() {
        let middle = |k: usize| cell as f64 + (k as f64 + 0.5) / 4.0;
        let limits: Vec<f64> = (0..4)
            .map(|k| bond * middle(k).min(10.0 - middle(k)))
            .collect();
        let strain = strain(&limits);
        for (k, bar) in group.iter().enumerate() {
            let exact = (STIFFNESS * strain).min(limits[k]);
            table.push(vec![middle(k), bar.state.force, exact]);
            worst = worst.max((bar.state.force - exact).abs());
        }
    }
    table.write_csv(&study.folder)?;
    study.check(
        run,
        "largest error of N of any bar, over the largest N [-]",
        BAR.says(0.0),
        Band::AtMost(1e-9),
        worst / (STIFFNESS / (YOUNG + STIFFNESS) * PULL),
    );
    Ok(())
}

/// An anchor from the free end of the strip to its held one: stressed, locked off, and pulled further.
fn locked_off(study: &mut Study, capacity: &str) -> Result<(), CaseError> {
    let text = STRIP
        .replace(
            "type = \"geotextile\"\npoints = [[\"0 m\", \"0.5 m\"], [\"10 m\", \"0.5 m\"]]\n",
            "type = \"anchor\"\nhead = [\"10 m\", \"0.5 m\"]\nend = [\"0 m\", \"0.5 m\"]\n\
             bonded_length = \"1 m\"\nprestress = \"20 kN/m\"\nplate = \"1 m\"\n",
        )
        .replace("end_capacity = \"1 MN/m\"\n", "")
        .replace("bond = \"0 kPa\"", "bond = \"1 MPa\"")
        .replace(
            "[[stages]]\n",
            "[[stages]]\nname = \"stress\"\ntype = \"gravity\"\ninstall = [\"member\"]\nsteps = 2\n\
             geometry = \"given\"\n\n[[stages]]\n",
        );
    let elastic = STIFFNESS / (YOUNG + STIFFNESS) * PULL;
    for (name, factor, force) in [
        ("stressed and locked off", 0.0, 20e3),
        ("then pulled", 1.0, 20e3 + elastic),
        ("then pressed", -0.2, 20e3 - 0.2 * elastic),
        ("then pressed until it is slack", -1.0, 0.0),
    ] {
        let overrides = [capacity.to_owned(), format!("stages.pull.factor={factor}")];
        let computed = Computed::new(case("strip.toml", &text, &overrides)?)?;
        let record = RunRecord::new(name, &computed.report, computed.elapsed);
        let run = study.run_to_end(record);
        let bar = computed.run.body.reinforcement[0].segments[0].state.force;
        let band = if force > 0.0 {
            Band::Relative(1e-9)
        } else {
            Band::Between(0.0, 0.0)
        };
        study.check(
            run,
            "N of the free length [N/m]",
            BAR.says(force),
            band,
            bar,
        );
    }
    Ok(())
}
