//! Parts of pages that show frames in a browser: `igimp view`, and the last frame of a report.
//!
//! The script reads the frames as they lie in `paraview/`; it needs no other script and no network.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use igimp_figures::ColourMap;
use serde::Serialize;

use super::pvd;

/// What stands in the section `soil` of a page: choices, canvas, slider.
pub const SECTION: &str = include_str!("viewer/soil.html");

/// The style of that section; the page gives the colours `--card`, `--line` and `--soft`.
pub const STYLE: &str = include_str!("viewer/viewer.css");

/// Largest frame that a report holds \[bytes\].
const LARGEST_FRAME: u64 = 3_000_000;

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
    text += include_str!("viewer/frame.js");
    text.push('\n');
    text += include_str!("viewer/soil.js");
    text.push('\n');
    text += include_str!("viewer/viewer.js");
    text
}

/// The last frame of a results folder, as a report holds it.
#[derive(Debug, Serialize)]
pub(super) struct LastFrame {
    section: &'static str,
    style: &'static str,
    script: String,
    /// The file; none if it is too large for a page.
    data: Option<String>,
    /// The rigid bodies of that frame, where the case has some.
    bodies: Option<String>,
    /// What it is called.
    label: String,
    /// Its size in words.
    size: String,
}

/// The last frame of particles, if there is one that can be read, and of rigid bodies.
pub(super) fn last_frame(folder: &Path) -> Option<LastFrame> {
    let folder = folder.join("paraview");
    let file = pvd::last(&folder, pvd::PARTICLES)?;
    let path = folder.join(&file);
    let about = fs::symlink_metadata(&path).ok()?;
    if !about.is_file() {
        return None;
    }
    let data = if about.len() <= LARGEST_FRAME {
        Some(harmless(&path)?)
    } else {
        None
    };
    let bodies = pvd::last(&folder, pvd::RIGID).and_then(|file| harmless(&folder.join(file)));
    Some(LastFrame {
        section: SECTION,
        style: STYLE,
        script: script() + "\n" + include_str!("viewer/last.js"),
        data,
        bodies,
        label: file,
        size: format!("{:.1} MB", about.len() as f64 / 1e6),
    })
}

/// The text of a frame. Numbers in base64 end no script; a file that somebody changed might.
fn harmless(path: &Path) -> Option<String> {
    let about = fs::symlink_metadata(path).ok()?;
    if !about.is_file() || about.len() > LARGEST_FRAME {
        return None;
    }
    let text = fs::read_to_string(path).ok()?;
    let lower = text.to_ascii_lowercase();
    let ends = lower.contains("</script") || lower.contains("<!--");
    (!ends).then_some(text)
}
