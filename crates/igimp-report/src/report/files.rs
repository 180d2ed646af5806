//! The parts of a results folder that a report includes: pictures, tables, and the texts of the case.

use std::path::{Component, Path};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use igimp_results::summary::{FigureNote, Summary};
use igimp_results::tables::cells::text_of;
use serde::Serialize;

use super::rows::grouped;
use crate::pictures::{convergence_caption, convergence_plot, histories, stages_of, titled};

/// An SVG larger than this gives way to its PNG if that is smaller \[byte\].
const MOST_SVG: usize = 150_000;

/// Pictures under a heading.
#[derive(Serialize)]
pub(super) struct Group {
    pub(super) id: &'static str,
    pub(super) title: &'static str,
    pictures: Vec<Picture>,
}

/// A picture in the page.
#[derive(Serialize)]
pub(super) struct Picture {
    file: String,
    caption: String,
    /// A data URI; empty if the picture is missing.
    source: String,
    links: Vec<Link>,
}

/// A relative link.
#[derive(Serialize)]
pub(super) struct Link {
    name: String,
    href: String,
}

/// A link to a file of the folder.
pub(super) fn link(name: &str, file: &str) -> Link {
    Link {
        name: name.to_owned(),
        href: href(file),
    }
}

/// The headings, with the beginnings of the names of the pictures below them.
const GROUPS: [(&str, &str, &[&str]); 8] = [
    ("model", "Model", &["model"]),
    ("mesh-error", "Mesh error, pictures", &["mesh-study"]),
    ("curves", "Curves", &["curve", "safety", "energy"]),
    (
        "histories",
        "Monitors and sections",
        &["monitor", "section"],
    ),
    ("mechanism", "Mechanism of failure", &["mechanism"]),
    ("fields", "Fields", &["field", "space", "cut"]),
    ("pictures", "Further pictures", &[""]),
    ("convergence", "Convergence", &["convergence"]),
];

/// Places of headings among them.
const FURTHER: usize = 6;
const CONVERGENCE: usize = 7;

/// The pictures of the summary by kind, in its order, and plots of the convergence of every stage.
pub(super) fn pictures(folder: &Path, summary: &Summary) -> Vec<Group> {
    let mut groups = GROUPS.map(|(id, title, _)| Group {
        id,
        title,
        pictures: Vec::new(),
    });
    for note in &summary.figures {
        let name = note.file.rsplit('/').next().unwrap_or_default();
        let named = |(_, _, starts): &(_, _, &[&str])| {
            starts
                .iter()
                .any(|start| !start.is_empty() && name.starts_with(start))
        };
        let place = GROUPS.iter().position(named).unwrap_or(FURTHER);
        groups[place].pictures.push(picture(folder, note));
    }
    if groups[CONVERGENCE].pictures.is_empty() {
        groups[CONVERGENCE].pictures = convergence(folder, summary);
    }
    groups
        .into_iter()
        .filter(|group| !group.pictures.is_empty())
        .collect()
}

/// A picture of a folder in a page.
pub(super) fn picture(folder: &Path, note: &FigureNote) -> Picture {
    let inside = Path::new(&note.file)
        .components()
        .all(|part| matches!(part, Component::Normal(_)));
    let read = |extension: &str| {
        let path = folder.join(format!("{}.{extension}", note.file));
        inside.then(|| std::fs::read(path).ok()).flatten()
    };
    let (svg, png) = (read("svg"), read("png"));
    let available = [("SVG", "svg", svg.is_some()), ("PNG", "png", png.is_some())];
    let links = available.into_iter().filter(|link| link.2);
    let links = links.map(|(name, extension, _)| link(name, &format!("{}.{extension}", note.file)));
    let (svg, png) = (
        svg.map(|bytes| ("svg+xml", bytes)),
        png.map(|bytes| ("png", bytes)),
    );
    let chosen = match (svg, png) {
        (Some(svg), Some(png)) if svg.1.len() > MOST_SVG.max(png.1.len()) => Some(png),
        (svg, png) => svg.or(png),
    };
    Picture {
        file: note.file.clone(),
        caption: note.caption.clone(),
        source: chosen.map_or_else(String::new, |(kind, bytes)| data_uri(kind, &bytes)),
        links: links.collect(),
    }
}

fn data_uri(kind: &str, bytes: &[u8]) -> String {
    format!("data:image/{kind};base64,{}", STANDARD.encode(bytes))
}

/// Plots of `convergence.csv`; none if it is missing or cannot be read or drawn.
fn convergence(folder: &Path, summary: &Summary) -> Vec<Picture> {
    let Ok(histories) = histories(&folder.join("convergence.csv")) else {
        return Vec::new();
    };
    let tolerance = tolerance(folder);
    stages_of(&histories)
        .into_iter()
        .filter_map(|(stage, members)| {
            let title = titled(&summary.title, stage);
            let plot = convergence_plot(&title, &members, tolerance);
            let drawing = plot.draw().ok()?;
            Some(Picture {
                file: "convergence.csv".to_owned(),
                caption: convergence_caption(stage, &members),
                source: data_uri("svg+xml", drawing.to_svg().as_bytes()),
                links: Vec::new(),
            })
        })
        .collect()
}

/// The accepted relative out-of-balance force, as the completed case states it.
fn tolerance(folder: &Path) -> Option<f64> {
    let text = std::fs::read_to_string(folder.join("case.completed.toml")).ok()?;
    let case: toml::Table = text.parse().ok()?;
    case.get("solver")?.get("tolerance")?.as_float()
}

/// A table or another file of the results.
#[derive(Serialize)]
pub(super) struct FileView {
    name: String,
    href: String,
    rows: String,
    columns: String,
}

/// The tables, and the entry points of the other results.
pub(super) fn tables(folder: &Path) -> Vec<FileView> {
    let mut views: Vec<FileView> = [
        "curves",
        "monitors",
        "reinforcement",
        "rigid",
        "sections",
        "slip_lines",
    ]
    .into_iter()
    .flat_map(|within| {
        names(&folder.join(within))
            .into_iter()
            .map(move |name| format!("{within}/{name}"))
    })
    .chain(["energy.csv", "mesh_study.csv", "convergence.csv"].map(str::to_owned))
    .filter_map(|name| table(folder, name))
    .collect();
    for (name, about) in [
        ("paraview/particles.pvd", "particles for ParaView"),
        ("paraview/grid.pvd", "background grid for ParaView"),
        ("paraview/rigid.pvd", "rigid bodies for ParaView"),
        ("paraview/reinforcement.pvd", "reinforcement for ParaView"),
        ("summary.json", "everything that this report says"),
    ] {
        if folder.join(name).exists() {
            views.push(FileView {
                name: name.to_owned(),
                href: href(name),
                rows: String::new(),
                columns: about.to_owned(),
            });
        }
    }
    views
}

/// The tables of a folder by name.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| Path::new(name).extension().is_some_and(|end| end == "csv"))
        .collect();
    names.sort();
    names
}

fn table(folder: &Path, name: String) -> Option<FileView> {
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .from_path(folder.join(&name))
        .ok()?;
    let columns: Vec<String> = reader
        .headers()
        .map(|headers| {
            headers
                .iter()
                .map(|name| text_of(name).to_owned())
                .collect()
        })
        .unwrap_or_default();
    let rows = reader.byte_records().take_while(Result::is_ok).count();
    Some(FileView {
        href: href(&name),
        name,
        rows: grouped(rows),
        columns: columns.join(", "),
    })
}

/// A text of the case.
#[derive(Serialize)]
pub(super) struct InputView {
    title: &'static str,
    text: String,
}

/// The case as given and as completed.
pub(super) fn inputs(folder: &Path) -> Vec<InputView> {
    let texts = [
        ("case.toml", "The case as given (case.toml)"),
        (
            "case.completed.toml",
            "The case with every default (case.completed.toml)",
        ),
    ];
    texts
        .into_iter()
        .filter_map(|(file, title)| {
            let bytes = std::fs::read(folder.join(file)).ok()?;
            let text = String::from_utf8_lossy(&bytes).into_owned();
            Some(InputView { title, text })
        })
        .collect()
}

/// A relative path as a link; all but letters, digits and plain signs is percent-encoded.
fn href(path: &str) -> String {
    let mut text = String::with_capacity(path.len());
    for byte in path.bytes() {
        if byte.is_ascii_alphanumeric() || b"-_.~/".contains(&byte) {
            text.push(char::from(byte));
        } else {
            let digit = |value: u8| char::from(b"0123456789ABCDEF"[usize::from(value)]);
            text.extend(['%', digit(byte >> 4), digit(byte & 15)]);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_written_in_percent() {
        assert_eq!(href("curves/a b#ü.csv"), "curves/a%20b%23%C3%BC.csv");
        assert_eq!(href("javascript:x"), "javascript%3Ax");
    }

    #[test]
    fn pictures_outside_the_folder_are_not_read() {
        let note = FigureNote {
            file: "../../secret".into(),
            caption: String::new(),
        };
        let folder = std::env::temp_dir();
        assert!(picture(&folder, &note).links.is_empty());
        assert_eq!(picture(&folder, &note).source, "");
    }
}
