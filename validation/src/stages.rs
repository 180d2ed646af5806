//! Ground that is built, dug, drained and drawn down: columns with exact stresses, cuts against one another.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use igimp_assembly::Geometry;
use igimp_cases::CaseError;
use igimp_cases::run::Run;
use igimp_input::CaseFile;
use igimp_model::check::Band;
use igimp_model::{Case, Construction, Drainage, PoreSource, Stage, StageKind, WaterCondition};

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use crate::runs::{Computed, corners};

/// The book's description of the study.
const ABOUT: &str = "Construction stages: fill in lifts, excavation in slices and at once, water that is lowered, undrained loading and its dissipation. Columns between smooth sides have exact stresses; elastic ground that was cut in slices is that cut at once, and that which never was anything else.";
const COLUMN: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "equilibrium of a column",
    locator: "σ′_v = weight above − u; u = γ_w times the depth below the table",
};
const OEDOMETER: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "oedometer with water that cannot leave",
    locator: "u = q (K_w/n)/(K_w/n + M); drained settlement q H/M",
};
const SUPERPOSITION: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "linear elasticity",
    locator: "stress after an excavation does not depend on its order",
};
/// Unit weight of the soil, of the soil full of water, and of water \[N/m³\].
const WEIGHTS: [f64; 3] = [18e3, 20e3, 9810.0];
/// Young's modulus \[Pa\].
const YOUNG: f64 = 1e9;
const POISSON: f64 = 0.3;

/// Bodies in a grid of square cells between smooth sides on a fixed base, elastic.
fn ground(
    name: &str,
    cell: f64,
    upper: [f64; 2],
    young: f64,
    bodies: &[(&str, Vec<[f64; 2]>)],
) -> Result<Case<2>, CaseError> {
    let [width, height] = upper;
    let mut text = format!(
        "igimp = 1
         [case]
         title = \"{name}\"
         analysis = \"plane-strain\"
         gravity = \"9.81 m/s2\"
         [grid]
         cell = \"{cell} m\"
         domain.x = [\"0 m\", \"{width} m\"]
         domain.y = [\"0 m\", \"{height} m\"]
         [boundaries]
         left = \"roller\"
         right = \"roller\"
         bottom = \"fixed\"
         [solver]
         tolerance = 1e-11
         [materials.soil]
         model = \"elastic\"
         unit_weight = \"{} N/m3\"
         young = \"{young} Pa\"
         poisson = {POISSON}
         [[stages]]
         name = \"weight\"
         type = \"gravity\"
         steps = 2
        ",
        WEIGHTS[0],
    );
    for (name, polygon) in bodies {
        let _ = write!(
            text,
            "
             [[bodies]]
             name = \"{name}\"
             material = \"soil\"
             points_per_cell = 4
             polygon = {}
            ",
            corners(polygon),
        );
    }
    Ok(CaseFile::parse(name, &text, &[])?.into_case())
}

/// A stage after the last one of a case.
fn then(case: &mut Case<2>, construction: Construction) {
    let last = case.stages.len() - 1;
    for &body in &construction.place {
        case.bodies[body].from_start = false;
    }
    case.stages.push(Stage {
        name: format!("stage {}", last + 2),
        kind: StageKind::Construction(construction),
        steps: 4,
        start_from: Some(last),
        ..case.stages[last].clone()
    });
}

fn box_of(from: [f64; 2], to: [f64; 2]) -> Vec<[f64; 2]> {
    vec![from, [to[0], from[1]], to, [from[0], to[1]]]
}

/// Runs the study.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("stages", ABOUT, out)?;
    lifts(&mut study)?;
    drawdown(&mut study)?;
    oedometer(&mut study)?;
    cuts(&mut study)?;
    Ok(study)
}

/// Largest deviation of the vertical stress that laws speak of from an exact one by the level as seeded, over the
/// greatest, both as means over half metres as seeded: particles of a cell share the dilation \[-\].
fn deviation(run: &Run<2>, exact: impl Fn(f64) -> f64) -> f64 {
    let particles = &run.body.particles;
    let mut cells: BTreeMap<i64, [f64; 3]> = BTreeMap::new();
    for particle in 0..particles.len() {
        let y = particles.x[particle][1] - particles.displacement[particle][1];
        let sums = cells.entry((2.0 * y).floor() as i64).or_default();
        for (sum, value) in sums
            .iter_mut()
            .zip([1.0, particles.sigma[particle][1][1], exact(y)])
        {
            *sum += value;
        }
    }
    let means = cells
        .values()
        .map(|[count, stress, exact]| (stress / count, exact / count));
    let greatest = means
        .clone()
        .fold(0.0, |a: f64, (_, exact)| a.max(exact.abs()));
    means.fold(0.0, |a: f64, (stress, exact)| a.max((stress - exact).abs())) / greatest
}

/// A column of soil that is filled up in lifts, and dug off again.
fn lifts(study: &mut Study) -> Result<(), CaseError> {
    let [dry, ..] = WEIGHTS;
    let layers = [
        ("ground", 0.0, 6.0),
        ("lift 1", 6.0, 8.0),
        ("lift 2", 8.0, 10.0),
    ];
    let bodies: Vec<_> = layers
        .iter()
        .map(|&(name, from, to)| (name, box_of([0.0, from], [2.0, to])))
        .collect();
    let quantity = "largest deviation of σ_v over the greatest [-]";

    let mut case = ground("lifts", 0.5, [2.0, 11.0], YOUNG, &bodies)?;
    for lift in [1, 2] {
        then(
            &mut case,
            Construction {
                place: vec![lift],
                ..Construction::default()
            },
        );
    }
    let lifts = Computed::new(case.clone())?;
    let run = study.run_to_end(RunRecord::new(
        "fill in two lifts",
        &lifts.report,
        lifts.elapsed,
    ));
    // Weight above by the particles seeded above: the width does not change.
    let filled = deviation(&lifts.run, |y| -dry * (10.0 - y));
    study.check(run, quantity, COLUMN.says(0.0), Band::AtMost(2e-3), filled);

    then(
        &mut case,
        Construction {
            remove: vec![2],
            ..Construction::default()
        },
    );
    let dug = Computed::new(case)?;
    let run = study.run_to_end(RunRecord::new(
        "and the upper lift taken away",
        &dug.report,
        dug.elapsed,
    ));
    let left = deviation(&dug.run, |y| -dry * (8.0 - y));
    study.check(run, quantity, COLUMN.says(0.0), Band::AtMost(2e-3), left);
    Ok(())
}

/// A column of soil under water that falls.
fn drawdown(study: &mut Study) -> Result<(), CaseError> {
    let [dry, wet, water] = WEIGHTS;
    let mut case = ground(
        "drawdown",
        0.5,
        [2.0, 11.0],
        YOUNG,
        &[("ground", box_of([0.0, 0.0], [2.0, 10.0]))],
    )?;
    case.materials[0].saturated = Some(wet);
    let table = |name: &str, level: f64| WaterCondition {
        name: name.to_owned(),
        source: PoreSource::Table(vec![[0.0, level]]),
        bodies: Vec::new(),
        carried: false,
    };
    case.water = vec![table("pond", 12.0), table("low", 4.0)];
    let exact = |level: f64| {
        move |y: f64| {
            let dry_above = (10.0 - y.max(level.min(10.0))) * dry;
            let wet_above = (level.min(10.0) - y).max(0.0) * (wet - water);
            -(dry_above + wet_above)
        }
    };
    let pond = Computed::new(case.clone())?;
    let run = study.run_to_end(RunRecord::new("pond 2 m deep", &pond.report, pond.elapsed));
    let quantity = "largest deviation of σ′_v over the greatest [-]";
    let measured = deviation(&pond.run, exact(12.0));
    study.check(
        run,
        quantity,
        COLUMN.says(0.0),
        Band::AtMost(1e-3),
        measured,
    );
    then(
        &mut case,
        Construction {
            water: Some(1),
            ..Construction::default()
        },
    );
    let low = Computed::new(case.clone())?;
    let run = study.run_to_end(RunRecord::new(
        "drawn down to 6 m below the ground",
        &low.report,
        low.elapsed,
    ));
    let measured = deviation(&low.run, exact(4.0));
    study.check(
        run,
        quantity,
        COLUMN.says(0.0),
        Band::AtMost(1e-3),
        measured,
    );
    Ok(())
}

/// A column of clay with one-dimensional stiffness `modulus` \[Pa\] that is loaded by a lift, undrained, with water of a
/// `stiffness` \[Pa\] in its pores.
struct Oedometer {
    case: Case<2>,
    modulus: f64,
    stiffness: f64,
}

fn loaded_clay() -> Result<Oedometer, CaseError> {
    let bodies = [
        ("clay", box_of([0.0, 0.0], [2.0, 8.0])),
        ("lift", box_of([0.0, 8.0], [2.0, 10.0])),
    ];
    let mut case = ground("oedometer", 0.5, [2.0, 11.0], 2e9, &bodies)?;
    let young = case.materials[0].young;
    let modulus = young * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
    let stiffness = 30.0 * modulus;
    let mut clay = case.materials[0].clone();
    "clay".clone_into(&mut clay.name);
    clay.drainage = Drainage::Undrained {
        stiffness: stiffness.into(),
        flows: false,
    };
    case.materials.push(clay);
    case.bodies[0].material = 1;
    case.stages[0].drained = true;
    case.stages[0].reset_displacements = true;
    case.stages[0].geometry = Geometry::Given;
    then(
        &mut case,
        Construction {
            place: vec![1],
            ..Construction::default()
        },
    );
    case.stages[1].drained = false;
    case.stages[1].reset_displacements = false;
    Ok(Oedometer {
        case,
        modulus,
        stiffness,
    })
}

/// A column that is loaded undrained by a lift, and drains.
fn oedometer(study: &mut Study) -> Result<(), CaseError> {
    let Oedometer {
        mut case,
        modulus,
        stiffness,
    } = loaded_clay()?;
    let load = 2.0 * WEIGHTS[0];
    let filled = Computed::new(case.clone())?;
    let run = study.run_to_end(RunRecord::new(
        "undrained fill",
        &filled.report,
        filled.elapsed,
    ));
    let particles = filled.particles();
    let of_clay: Vec<usize> = (0..particles.len())
        .filter(|&particle| particles.law[particle] == 1)
        .collect();
    let expected = stiffness / (stiffness + modulus);
    let worst = of_clay
        .iter()
        .map(|&particle| particles.excess[particle] / load)
        .max_by(|a, b| (a - expected).abs().total_cmp(&(b - expected).abs()))
        .unwrap_or(f64::NAN);
    let quantity = "excess pore pressure over the load, farthest off [-]";
    study.check(
        run,
        quantity,
        OEDOMETER.says(expected),
        Band::Relative(1e-4),
        worst,
    );
    then(
        &mut case,
        Construction {
            dissipate: true,
            ..Construction::default()
        },
    );
    let drained = Computed::new(case)?;
    let run = study.run_to_end(RunRecord::new(
        "and drained",
        &drained.report,
        drained.elapsed,
    ));
    let particles = drained.particles();
    let settled = of_clay
        .iter()
        .map(|&p| -particles.displacement[p][1])
        .fold(0.0, f64::max);
    let top = of_clay
        .iter()
        .map(|&p| particles.x[p][1])
        .fold(0.0, f64::max)
        + settled;
    let quantity = "settlement of the highest clay over that of drained soil [-]";
    let ratio = settled / (load * top / modulus);
    study.check(
        run,
        quantity,
        OEDOMETER.says(1.0),
        Band::Relative(1e-3),
        ratio,
    );
    Ok(())
}

/// A pit that is dug at once, in three slices, and ground that never was anything else.
fn pits() -> Result<[Computed<2>; 3], CaseError> {
    let cell = 0.5;
    let rest = vec![
        [0.0, 0.0],
        [24.0, 0.0],
        [24.0, 10.0],
        [8.0, 10.0],
        [5.0, 4.0],
        [0.0, 4.0],
    ];
    let slice = |from: f64, to: f64| {
        let at = |y: f64| 5.0 + (y - 4.0) * 0.5;
        vec![[0.0, from], [at(from), from], [at(to), to], [0.0, to]]
    };
    let slices = [
        ("slice 1", slice(8.0, 10.0)),
        ("slice 2", slice(6.0, 8.0)),
        ("slice 3", slice(4.0, 6.0)),
    ];
    let mut bodies = vec![("ground", rest.clone())];
    bodies.extend(slices);
    let whole = ground("pit", cell, [24.0, 11.0], 1e10, &bodies)?;
    let mut at_once = whole.clone();
    then(
        &mut at_once,
        Construction {
            remove: vec![1, 2, 3],
            ..Construction::default()
        },
    );
    let mut in_slices = whole;
    for slice in 1..4 {
        then(
            &mut in_slices,
            Construction {
                remove: vec![slice],
                ..Construction::default()
            },
        );
    }
    let never = ground("pit", cell, [24.0, 11.0], 1e10, &bodies[..1])?;
    Ok([
        Computed::new(at_once)?,
        Computed::new(in_slices)?,
        Computed::new(never)?,
    ])
}

/// Displacements and stresses of a pit do not depend on the way in which it is dug.
fn cuts(study: &mut Study) -> Result<(), CaseError> {
    let [at_once, in_slices, never] = pits()?;
    let run = study.run_to_end(RunRecord::new(
        "pit in three slices",
        &in_slices.report,
        in_slices.elapsed,
    ));
    let quantity =
        "largest difference of displacements over the largest, to the pit dug at once [-]";
    let of = |computed: &Computed<2>| -> Vec<f64> {
        computed
            .particles()
            .displacement
            .iter()
            .flatten()
            .copied()
            .collect()
    };
    let apart = difference(&of(&in_slices), &of(&at_once));
    study.check(
        run,
        quantity,
        SUPERPOSITION.says(0.0),
        Band::AtMost(1e-4),
        apart,
    );
    let quantity = "largest difference of stresses over the largest, to ground that never was anything else [-]";
    let of = |computed: &Computed<2>| -> Vec<f64> {
        let sigma = computed.particles().sigma.iter();
        sigma
            .flat_map(|sigma| sigma.as_flattened().to_vec())
            .collect()
    };
    for (name, computed) in [
        ("pit in three slices", &in_slices),
        ("pit at once", &at_once),
    ] {
        let run = study.run_to_end(RunRecord::new(
            format!("{name}, stresses"),
            &computed.report,
            computed.elapsed,
        ));
        let apart = difference(&of(computed), &of(&never));
        study.check(
            run,
            quantity,
            SUPERPOSITION.says(0.0),
            Band::AtMost(1e-4),
            apart,
        );
    }
    Ok(())
}

/// The largest difference of two lists over the largest number of the second; not a number for lists of other lengths.
fn difference(found: &[f64], other: &[f64]) -> f64 {
    if found.len() != other.len() {
        return f64::NAN;
    }
    let largest = other.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    std::iter::zip(found, other).fold(0.0, |a: f64, (x, y)| a.max((x - y).abs())) / largest
}
