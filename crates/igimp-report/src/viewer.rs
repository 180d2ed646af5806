//! Parts of pages that show frames in a browser: `igimp view`, and the frames of a report.
//!
//! The script draws plane and space alike, and needs no other script and no network. It takes frames as
//! [`packed`] makes them of those in `paraview/`, the only states along a run that a results folder keeps. Overlays,
//! water and slip lines, come from the case and its tables ([`over`]).

pub mod over;
mod packed;
mod surroundings;

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use igimp_figures::ColourMap;
use igimp_results::paraview::pvd;
use igimp_text::short;
pub use packed::{Keep, packed};
use rayon::prelude::*;
use serde::Serialize;
pub use surroundings::{Bodies, Surroundings};

use crate::whereabouts::whereabouts;

/// The section `soil` of a page: choices, canvas, slider.
pub const SECTION: &str = include_str!("viewer/soil.html");

/// The style of that section; the page gives the colours `--card`, `--line` and `--soft`.
pub const STYLE: &str = include_str!("viewer/viewer.css");

/// The script in parts.
const PARTS: [&str; 20] = [
    include_str!("viewer/frame.js"),
    include_str!("viewer/camera.js"),
    include_str!("viewer/slant.js"),
    include_str!("viewer/shaders.js"),
    include_str!("viewer/gl.js"),
    include_str!("viewer/axes.js"),
    include_str!("viewer/water.js"),
    include_str!("viewer/contours.js"),
    include_str!("viewer/levels.js"),
    include_str!("viewer/outlines.js"),
    include_str!("viewer/overlay.js"),
    include_str!("viewer/seams.js"),
    include_str!("viewer/plain.js"),
    include_str!("viewer/scene.js"),
    include_str!("viewer/section.js"),
    include_str!("viewer/saving.js"),
    include_str!("viewer/pointing.js"),
    include_str!("viewer/cutting.js"),
    include_str!("viewer/colours.js"),
    include_str!("viewer/viewer.js"),
];

/// Most bytes of the last frame of a report, and of all its frames together.
const MOST_OF_LAST: usize = 14_000_000;
const MOST: usize = 4_000_000;

/// Most frames before the last one where nothing moves in time: a frame takes longer to pack than to write.
const MOST_BEFORE: usize = 3;

/// Largest file of a frame that is read \[bytes\].
const LARGEST_FILE: u64 = 2_000_000_000;

/// The script that makes the section work, by its class `Viewer`.
pub fn script() -> String {
    let mut text = String::new();
    let ends = [("grey", vec![[245, 245, 245], [20, 20, 20]])];
    let maps = [
        ("viridis", ColourMap::Sequential),
        ("diverging", ColourMap::Diverging),
    ]
    .map(|(name, map)| {
        let colours = (0..=10).map(|k| map.at(f64::from(k) / 10.0).0);
        (name, colours.collect::<Vec<_>>())
    });
    text += "// Colours from the low end to the high end, those of the pictures.\nconst MAPS = {\n";
    for (name, colours) in maps.iter().chain(&ends) {
        let _ = writeln!(text, "  {name}: {colours:?},");
    }
    text += "};\n\n";
    for part in PARTS {
        text += part;
        text.push('\n');
    }
    text
}

/// A frame of a results folder as pages take it, by its file, with the pieces and edges of the bodies where these are given;
/// none where it cannot be read.
pub fn frame(file: &Path, keep: Keep, bodies: Option<&Bodies>) -> Option<String> {
    let about = fs::symlink_metadata(file).ok()?;
    if !about.is_file() || about.len() > LARGEST_FILE {
        return None;
    }
    packed(&fs::read_to_string(file).ok()?, keep, bodies)
}

/// The frames of a results folder, as a report holds them.
#[derive(Debug, Serialize)]
pub(super) struct Held {
    section: &'static str,
    style: &'static str,
    script: String,
    /// Those that fit into a page, the last among them; none if that one is too large.
    frames: Vec<HeldFrame>,
    /// Overlays of the frames of each stage, as JSON.
    over: String,
    /// How many there are.
    all: usize,
    /// The size of the frames in words, or that of the last frame where there is none.
    size: String,
}

/// A frame within a page.
#[derive(Debug, Serialize)]
struct HeldFrame {
    /// Its name on the page.
    label: String,
    /// Its time \[s\], where the soil moves in time.
    seconds: Option<f64>,
    /// The number of its stage, from 0, where that is known.
    stage: Option<usize>,
    data: String,
    /// The rigid bodies of that frame, where the case has some.
    bodies: Option<String>,
    /// The reinforcement of that frame, where the case has some.
    members: Option<String>,
}

/// The last frame of particles, and as many before it as there is room for; none if it cannot be read.
pub(super) fn held(folder: &Path, around: &Surroundings) -> Option<Held> {
    let folder = folder.join("paraview");
    let particles = pvd::frames(&folder, pvd::PARTICLES)?;
    let beside = |stem| pvd::frames(&folder, stem).unwrap_or_default();
    let (bodies, members) = (beside(pvd::RIGID), beside(pvd::REINFORCEMENT));
    let seconds = pvd::seconds(&folder);
    let all = particles.len();
    let places = whereabouts(&particles, &around.stages);
    let of = |k: usize, keep| {
        let packed = |found: Option<&pvd::Frame>| frame(&folder.join(&found?.file), keep, None);
        let shown = &particles[k];
        let seconds = seconds.get(&shown.file).copied();
        let when = match seconds {
            Some(seconds) => format!("t = {} s, stage “{}”", short(seconds), shown.stage),
            None => format!("stage “{}”, {}", shown.stage, places[k].when),
        };
        Some(HeldFrame {
            label: format!("Frame {} of {all}, {when}", k + 1),
            seconds,
            stage: places[k].stage,
            data: frame(&folder.join(&shown.file), keep, around.bodies.as_ref())?,
            bodies: packed(bodies.get(k)),
            members: packed(members.get(k)),
        })
    };
    let last = all.checked_sub(1)?;
    let mut end = of(last, Keep::MUCH)?;
    if end.data.len() > MOST {
        end = of(last, Keep::LITTLE)?;
    }
    let mut size = end.data.len();
    let mut frames = Vec::new();
    if size <= MOST_OF_LAST {
        // The first, and others at equal distances.
        let probe = (last > 0 && size < MOST)
            .then(|| of(0, Keep::LITTLE))
            .flatten();
        let room = probe.as_ref().map_or(0, |first| {
            let most = first.data.len().max(end.data.len() / 2).max(1);
            (MOST - size) / most
        });
        let most = if seconds.is_empty() {
            MOST_BEFORE
        } else {
            last
        };
        let count = room.min(last).min(most);
        let before: Vec<usize> = (0..count).map(|k| k * last / count).collect();
        let read = |&k: &usize| of(k, Keep::LITTLE);
        frames = before.par_iter().filter_map(read).collect();
        frames.push(end);
        size = frames.iter().map(|frame| frame.data.len()).sum();
    }
    Some(Held {
        section: SECTION,
        style: STYLE,
        script: script() + "\n" + include_str!("viewer/held.js"),
        frames,
        over: serde_json::to_string(&around.over).ok()?,
        all,
        size: format!("{:.1} MB", size as f64 / 1e6),
    })
}
