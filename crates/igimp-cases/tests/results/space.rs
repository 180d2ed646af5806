//! GOAL: particles in space become a page that shows their surface, turns and cuts it, and tells their values.
//! ORACLE: the fields that the particles were given. The page is looked at in a headless browser where there
//! is one; it stays in the `tmp` folder of the target, to be looked at by people.

use std::path::{Path, PathBuf};
use std::process::Command;

use igimp_assembly::{ParticleFields, ParticleSeed, Particles};
use igimp_model::Field;
use igimp_report::pictures::{InSpace, Seen, Shown};
use igimp_report::report::write_report;
use igimp_report::skin::{Boxes, Skin};
use igimp_report::viewer::Surroundings;
use igimp_results::paraview::particles::{Extras, of_particles};
use igimp_results::paraview::pvd::{Collection, PARTICLES};
use igimp_results::summary::Summary;

/// Height of the ground of a slope that falls along x \[m\].
fn ground(x: f64) -> f64 {
    (10.0 - 0.8 * (x - 7.0).clamp(0.0, 7.5)).max(4.0)
}

/// A slope of 20 × 20 × 10 m, in which a bowl slides down and out.
fn slope(width: f64, share: f64) -> Particles<3> {
    let count = |length: f64| (length / width).round() as usize;
    let mut seeds = Vec::new();
    for k in 0..count(20.0) * count(20.0) * count(10.0) {
        let place = [
            k % count(20.0),
            k / count(20.0) % count(20.0),
            k / (count(20.0) * count(20.0)),
        ];
        let x = place.map(|i| (i as f64 + 0.5) * width);
        if x[2] < ground(x[0]) {
            seeds.push(ParticleSeed {
                x,
                half_length: [0.5 * width; 3],
                volume: width.powi(3),
                density: 2000.0,
                law: usize::from(x[2] < 3.0),
                centroid: [0.0; _],
            });
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
        let u = [
            moved * -from[2] / along,
            0.02 * moved * from[1],
            moved * from[0] / along,
        ];
        let shear = 4.0 * inside * (1.0 - 9.0 * inside).max(0.0) * 9.0;
        fields.displacement[k] = u;
        fields.half_length[k] = [
            0.5 * width * (1.0 + 0.03 * slides),
            0.5 * width,
            0.5 * width * (1.0 - 0.03 * slides),
        ];
        fields.x[k] = std::array::from_fn(|axis| x[axis] + u[axis]);
        fields.eps_p_eq[k] = if inside > 0.0 {
            0.5 * share * shear
        } else {
            0.0
        };
        let depth = (ground(x[0]) - x[2]).max(0.0) * 20e3;
        fields.sigma[k] = [
            [-0.5 * depth, 0.0, 0.0],
            [0.0, -0.5 * depth, 0.0],
            [0.0, 0.0, -depth],
        ];
    }
    Particles::from_fields(fields).unwrap()
}

/// A results folder with frames and pictures of the slope, and its report.
fn results(name: &str, width: f64, frames: usize) -> (PathBuf, Particles<3>) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    let paraview = folder.join("paraview");
    std::fs::create_dir_all(&paraview).unwrap();
    let mut collection = Collection::create(&paraview, PARTICLES).unwrap();
    let mut last = slope(width, 0.0);
    for k in 1..=frames {
        last = slope(width, k as f64 / frames as f64);
        let cells = of_particles(&last, &Extras::default());
        collection.add(k as f64, "stage", &cells).unwrap();
    }
    let title = "A slope in space";
    let state = Seen {
        particles: &last,
        laws: &[],
    };
    let drawn = InSpace::new(&folder, title, false, state, vec![ROOF; 1], &[]);
    let shown = Shown {
        name: "1-slide".into(),
        title: "slide".into(),
        when: "at the end of stage “slide”".into(),
    };
    let fields = [Field::Displacement, Field::SigmaZz, Field::PlasticStrain];
    let figures = fields.map(|field| drawn.pictures(&shown, field, &[], &drawn.middle()).unwrap());
    let summary = Summary {
        title: title.into(),
        figures: figures.concat(),
        ..Summary::default()
    };
    let text = serde_json::to_string(&summary).unwrap();
    std::fs::write(folder.join("summary.json"), text).unwrap();
    write_report(&folder, &Surroundings::default()).unwrap();
    (folder, last)
}

/// A triangle of a rigid body above the slope.
const ROOF: [[f64; 3]; 3] = [[16.0, 4.0, 7.0], [20.0, 4.0, 7.0], [16.0, 8.0, 8.5]];

/// Width and height of a picture, from its file.
fn size(png: &Path) -> [u32; 2] {
    let bytes = std::fs::read(png).unwrap();
    [16, 20].map(|at| u32::from_be_bytes(*bytes[at..].first_chunk().unwrap()))
}

/// GOAL: a stage has a picture of the surface and of two cuts for each field, for print.
#[test]
fn pictures_need_no_browser() {
    let (folder, _) = results("space-pictures", 1.0, 1);
    for field in ["displacement", "sigma_zz", "plastic_strain"] {
        for view in ["space", "cut-x", "cut-y"] {
            let name = folder.join(format!("figures/{view}-1-slide-{field}"));
            let [width, height] = size(&name.with_extension("png"));
            assert!(
                (800..3000).contains(&width) && (400..3000).contains(&height),
                "{name:?}"
            );
            let svg = std::fs::read_to_string(name.with_extension("svg")).unwrap();
            assert!(svg.contains("z [m]") && svg.contains("A slope in space – slide"));
            assert_eq!(svg.contains("<image "), view == "space");
        }
    }
    let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
    assert_eq!(page.matches("<figure").count(), 9);
    assert!(page.contains("in the plane y = 9.5 m: the domains that it crosses."));
}

/// A browser without a window, if one is installed.
fn browser() -> Option<&'static str> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let found = names.into_iter().find(|name| {
        let version = Command::new(name).arg("--version").output();
        version.is_ok_and(|output| output.status.success())
    });
    if found.is_none() {
        println!("skipped: there is no chromium");
    }
    found
}

/// The report as it stands in the browser after some seconds, opened with wishes.
fn looked_at(browser: &str, folder: &Path, wishes: &str, how: &[&str]) -> String {
    let profile = folder.join("profile");
    let output = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--dump-dom",
            "--window-size=1000,900",
        ])
        .args(["--virtual-time-budget=8000"])
        .args(how)
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!(
            "file://{}#look=1&{wishes}",
            folder.join("report.html").display()
        ))
        .output()
        .unwrap();
    let _ = std::fs::remove_dir_all(profile);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// An attribute of the element with an id.
fn attribute(page: &str, id: &str, name: &str) -> String {
    let (before, after) = page.split_once(&format!("id=\"{id}\"")).unwrap();
    let start = before.rfind('<').unwrap();
    let end = after.find('>').unwrap();
    let tag = format!("{}{}", &before[start..], &after[..end]);
    let (_, value) = tag
        .split_once(&format!(" {name}=\""))
        .unwrap_or_else(|| panic!("no {name} in {tag}"));
    value.split_once('"').unwrap().0.to_owned()
}

/// WebGL2 by software, and none at all.
const WITH_GL: [&str; 3] = [
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
];
const WITHOUT_GL: [&str; 2] = ["--disable-gpu", "--disable-3d-apis"];

/// GOAL: the report shows the surface, and the particle that is pointed at with its value, whether the browser
/// has WebGL2 or not; a cut shows the soil behind it.
#[test]
fn a_slope_in_space_is_shown() {
    let Some(browser) = browser() else {
        return;
    };
    let (folder, particles) = results("space-slope", 0.5, 4);
    let (low, high): (Vec<_>, Vec<_>) = std::iter::zip(&particles.x, &particles.half_length)
        .map(|(x, half)| {
            (
                [0, 1, 2].map(|k| x[k] - half[k]),
                [0, 1, 2].map(|k| x[k] + half[k]),
            )
        })
        .unzip();
    let boxes = Boxes {
        low: &low,
        high: &high,
    };
    let skin = Skin::of(boxes, &[]);
    let field = "field=displacement%20[m],%20length";
    let mut pointed = Vec::new();
    for (how, by) in [(&WITH_GL[..], "webgl2"), (&WITHOUT_GL[..], "canvas")] {
        let page = looked_at(browser, &folder, &format!("{field}&hover=0.5,0.45"), how);
        if attribute(&page, "canvas", "data-by") != by {
            println!("skipped: this chromium has no {by}");
            continue;
        }
        assert_eq!(
            attribute(&page, "canvas", "data-faces"),
            skin.count().to_string()
        );
        let particle: usize = attribute(&page, "found", "data-particle").parse().unwrap();
        let value: f64 = attribute(&page, "found", "data-value").parse().unwrap();
        let expected = particles.displacement[particle]
            .iter()
            .map(|u| u * u)
            .sum::<f64>()
            .sqrt();
        assert!(
            (value - expected).abs() < 1e-6 && expected > 1.0,
            "{value} for {expected}"
        );
        assert!(skin.faces[particle] != 0, "it is one of the surface");
        pointed.push(particle);
        // With the half towards the eye taken away, what is pointed at lies in the plane of the cut.
        let page = looked_at(
            browser,
            &folder,
            &format!("{field}&cut=1,0.52&hover=0.5,0.55"),
            how,
        );
        let particle: usize = attribute(&page, "found", "data-particle").parse().unwrap();
        let (from, to) = (low[particle][1], high[particle][1]);
        assert!(from <= 10.4 && 10.4 <= to, "{from} to {to}");
        assert_eq!(skin.faces[particle], 0, "it is one from within");
    }
    assert!(
        pointed.windows(2).all(|pair| pair[0] == pair[1]),
        "{pointed:?}"
    );
}
