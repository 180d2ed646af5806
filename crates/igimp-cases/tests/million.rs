//! x
use igimp_assembly::{ParticleSeed, Particles};
use igimp_cases::results::particles::{Extras, of_particles};
use igimp_cases::results::skin::{Boxes, Skin};
use igimp_cases::results::viewer::{Keep, packed};
use std::time::Instant;
#[test]
fn million() {
    for n in [50_usize, 100] {
        let seeds: Vec<ParticleSeed<3>> = (0..n * n * n)
            .map(|k| {
                let p = [k % n, k / n % n, k / (n * n)];
                ParticleSeed {
                    x: p.map(|i| i as f64 + 0.5),
                    half_length: [0.5; 3],
                    volume: 1.0,
                    density: 1.0,
                    law: 0,
                }
            })
            .collect();
        let particles = Particles::new(&seeds).unwrap();
        let low: Vec<[f64; 3]> = particles.x.iter().map(|x| x.map(|x| x - 0.5)).collect();
        let high: Vec<[f64; 3]> = particles.x.iter().map(|x| x.map(|x| x + 0.5)).collect();
        let t = Instant::now();
        let skin = Skin::of(Boxes {
            low: &low,
            high: &high,
        });
        println!(
            "{n}: skin {:.2} s, {} faces",
            t.elapsed().as_secs_f64(),
            skin.count()
        );
        let t = Instant::now();
        let text = of_particles(&particles, &Extras::default()).to_xml();
        println!(
            "{n}: vtu {:.2} s, {:.1} MB",
            t.elapsed().as_secs_f64(),
            text.len() as f64 / 1e6
        );
        for keep in [Keep::MUCH, Keep::LITTLE] {
            let t = Instant::now();
            let json = packed(&text, keep).unwrap();
            let count = json
                .split("\"count\":")
                .nth(1)
                .unwrap()
                .split(',')
                .next()
                .unwrap()
                .to_owned();
            println!(
                "{n}: packed {:.2} s, {:.1} MB, {count} boxes",
                t.elapsed().as_secs_f64(),
                json.len() as f64 / 1e6
            );
            if n == 100 {
                std::fs::write("/tmp/million.json", &json).unwrap();
            }
        }
        let status = std::fs::read_to_string("/proc/self/status").unwrap();
        println!(
            "{}",
            status.lines().find(|l| l.starts_with("VmHWM")).unwrap()
        );
    }
}
