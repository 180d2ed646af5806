//! Changes since the snapshots were accepted: for every curve the largest change and where it is,
//! a picture of old against new of every curve and residual history; and how the files of a run are accepted.

use std::path::{Path, PathBuf};
use std::{fs, io};

use igimp_cases::CaseError;
use igimp_figures::{CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_results::ResultsError;
use igimp_text::short;

/// Most panels of one picture.
const PANELS: usize = 4;

/// A snapshot that today's results differ from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Difference {
    /// Name of the snapshot, or of the line of the matrix.
    pub(crate) name: String,
    /// The difference, in words.
    pub(crate) change: String,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.name, self.change)
    }
}

/// Folder of the snapshots of this workspace.
pub(crate) fn snapshots() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots")
}

/// Removes the pictures of an earlier comparison, with their folder.
///
/// # Errors
/// [`ResultsError::File`] if the folder cannot be removed.
pub(crate) fn clear(pictures: &Path) -> Result<(), CaseError> {
    match fs::remove_dir_all(pictures) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => Err(ResultsError::File {
            path: pictures.to_path_buf(),
            source,
        }
        .into()),
        _ => Ok(()),
    }
}

/// The text of a snapshot that was accepted, without its head.
pub(crate) fn accepted(folder: &Path, name: &str) -> Option<String> {
    let text = fs::read_to_string(folder.join(format!("{name}.snap"))).ok()?;
    let text = text.replace("\r\n", "\n");
    let rest = text.strip_prefix("---\n")?;
    let (_, contents) = rest.split_once("\n---\n")?;
    Some(contents.to_owned())
}

/// Columns of numbers under a line of names, as snapshots hold them.
struct Columns {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Columns {
    fn read(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let names: Vec<String> = lines
            .next()?
            .split_whitespace()
            .map(str::to_owned)
            .collect();
        let rows = lines
            .filter(|line| !line.trim().is_empty())
            .map(|line| {
                line.split_whitespace()
                    .map(|token| token.parse().ok())
                    .collect()
            })
            .collect::<Option<Vec<Vec<f64>>>>()?;
        rows.iter()
            .all(|row| row.len() == names.len())
            .then_some(Self { names, rows })
    }

    fn points(&self, column: usize) -> Vec<[f64; 2]> {
        let points = self.rows.iter().map(|row| [row[0], row[column]]);
        points.filter(|p| p.iter().all(|v| v.is_finite())).collect()
    }
}

/// Residuals of a history, step by step.
fn residuals(text: &str) -> Option<Vec<Vec<f64>>> {
    let step = |line: &str| {
        let (_, values) = line.strip_prefix("step ")?.split_once(':')?;
        values.split_whitespace().map(|v| v.parse().ok()).collect()
    };
    text.trim_end().lines().map(step).collect()
}

/// Points (place, residual) of the steps of a history, one step beside the other. A step of either
/// history has as many places as the longer of both; lines break between steps.
fn side_by_side(steps: &[Vec<f64>], other: &[Vec<f64>]) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    let mut places = 1..;
    for (number, step) in steps.iter().enumerate() {
        let width = other.get(number).map_or(0, Vec::len).max(step.len());
        let taken: Vec<i32> = places.by_ref().take(width).collect();
        points.extend(taken.iter().zip(step).map(|(&x, &y)| [f64::from(x), y]));
        points.push([f64::NAN; 2]);
    }
    points
}

/// A name of a column as it is said: underscores stand for spaces there.
fn printed(name: &str) -> String {
    name.replace('_', " ")
}

/// The difference of two texts of a curve, in words: its largest change, as a share of the largest
/// value of its column.
fn largest_change(old: &str, new: &str) -> Option<String> {
    let (old, new) = (Columns::read(old)?, Columns::read(new)?);
    if old.names != new.names {
        let [old, new] = [&old, &new].map(|of| of.names.join(", "));
        return Some(format!("columns {new} for {old}"));
    }
    if old.rows.len() != new.rows.len() {
        return Some(format!("{} rows for {}", new.rows.len(), old.rows.len()));
    }
    let mut largest: Option<(f64, usize, usize)> = None;
    for column in 0..old.names.len() {
        let values = old.rows.iter().map(|row| row[column].abs());
        let scale = values.filter(|v| v.is_finite()).fold(0.0, f64::max);
        for (row, (a, b)) in old.rows.iter().zip(&new.rows).enumerate() {
            let (a, b) = (a[column], b[column]);
            let same = a.total_cmp(&b).is_eq();
            let change = match (a - b).abs() / scale {
                _ if same => 0.0,
                change if change.is_finite() => change,
                _ => f64::INFINITY,
            };
            if change > largest.map_or(0.0, |(largest, ..)| largest) {
                largest = Some((change, row, column));
            }
        }
    }
    let (change, row, column) = largest?;
    let share = if change.is_finite() {
        format!(", {} % of its largest value", short(100.0 * change))
    } else {
        String::new()
    };
    Some(format!(
        "{} {} for {} at {} = {}{share}",
        printed(&old.names[column]),
        short(new.rows[row][column]),
        short(old.rows[row][column]),
        printed(&old.names[0]),
        short(old.rows[row][0]),
    ))
}

/// The first line that differs, in words.
fn first_change(old: &str, new: &str) -> String {
    let (mut old, mut new) = (old.trim_end().lines(), new.trim_end().lines());
    let mut number = 0;
    loop {
        number += 1;
        match (old.next(), new.next()) {
            (Some(a), Some(b)) if a.split_whitespace().eq(b.split_whitespace()) => {}
            (Some(a), Some(b)) => return format!("line {number}: \"{b}\" for \"{a}\""),
            (Some(_), None) => return format!("ends before line {number}"),
            (None, Some(_)) => return format!("goes on in line {number}"),
            (None, None) => return "differs in its head".to_owned(),
        }
    }
}

/// Tells how a text differs from the snapshot of its name; draws both if they are curves or residual
/// histories. The folder of the pictures is made where it is not there.
///
/// # Errors
/// [`CaseError`] if a picture cannot be written.
pub(crate) fn difference(
    folder: &Path,
    name: &str,
    new: &str,
    out: &Path,
) -> Result<Difference, CaseError> {
    let change = match accepted(folder, name) {
        None => "new; there is no snapshot of that name".to_owned(),
        Some(old) => {
            write(&drawn(name, &old, new), &out.join(name))?;
            largest_change(&old, new).unwrap_or_else(|| first_change(&old, new))
        }
    };
    Ok(Difference {
        name: name.to_owned(),
        change,
    })
}

/// Writes pictures under one name, numbered where there are several, into a folder that is made.
fn write(plots: &[(usize, CurvePlot)], path: &Path) -> Result<(), CaseError> {
    let Some(folder) = path.parent().filter(|_| !plots.is_empty()) else {
        return Ok(());
    };
    fs::create_dir_all(folder).map_err(|source| ResultsError::File {
        path: folder.to_path_buf(),
        source,
    })?;
    for (column, plot) in plots {
        let file = match plots.len() {
            1 => path.to_path_buf(),
            _ => PathBuf::from(format!("{}__{column}", path.display())),
        };
        plot.write(&file)?;
    }
    Ok(())
}

/// Old against new with the column shown: of a table a picture for each column that differs, as many as
/// [`PANELS`]; of a residual history one; of other texts none.
fn drawn(name: &str, old: &str, new: &str) -> Vec<(usize, CurvePlot)> {
    if let (Some(old), Some(new)) = (Columns::read(old), Columns::read(new)) {
        let columns = old.names.len().min(new.names.len());
        let differs = |&column: &usize| old.points(column) != new.points(column);
        let plot = |column| {
            let both = [&new, &old].map(|of| of.points(column));
            let labels = [&new.names[0], &new.names[column]].map(|label| printed(label));
            (column, plot(name, labels, both, SeriesStyle::Line))
        };
        return (1..columns)
            .filter(differs)
            .take(PANELS)
            .map(plot)
            .collect();
    }
    if let (Some(old), Some(new)) = (residuals(old), residuals(new)) {
        let both = [side_by_side(&new, &old), side_by_side(&old, &new)];
        let labels = ["residuals, step beside step", "residual [-]"].map(str::to_owned);
        let plot = CurvePlot {
            y_scale: Scale::Log,
            ..plot(name, labels, both, SeriesStyle::LineAndMarkers)
        };
        return vec![(1, plot)];
    }
    Vec::new()
}

/// Points that are new in a full line, those that were accepted dashed.
fn plot(
    name: &str,
    [x_label, y_label]: [String; 2],
    [new, old]: [Vec<[f64; 2]>; 2],
    style: fn(LineStyle) -> SeriesStyle,
) -> CurvePlot {
    CurvePlot {
        title: name.to_owned(),
        x_label,
        y_label,
        series: vec![
            Series::new("now", new, style(LineStyle::Solid)),
            Series::new("accepted", old, style(LineStyle::Dashed)),
        ],
        ..CurvePlot::default()
    }
}

/// Accepts the files of earlier runs beside the snapshots, as `cargo insta accept` does; returns the names.
///
/// # Errors
/// An error of the file system.
pub(crate) fn accept_left(folder: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let left = entry?.path();
        let Some(name) = left
            .file_name()
            .and_then(|name| name.to_str()?.strip_suffix(".snap.new"))
        else {
            continue;
        };
        let text = fs::read_to_string(&left)?;
        // Where an assertion stands in the source is no part of a snapshot.
        let kept: Vec<&str> = text
            .lines()
            .filter(|line| !line.starts_with("assertion_line:"))
            .collect();
        fs::write(folder.join(format!("{name}.snap")), kept.join("\n") + "\n")?;
        fs::remove_file(&left)?;
        names.push(name.to_owned());
    }
    names.sort();
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OLD: &str = "w/B_[-]  N_[-]\n 0.0  0.0\n 0.1  4.0\n 0.2  5.0\n";

    #[test]
    fn a_curve_is_named_with_its_largest_change_and_its_place() {
        let new = OLD.replace("4.0", "4.1").replace("5.0", "5.05");
        assert_eq!(
            largest_change(OLD, &new).unwrap(),
            "N [-] 4.1 for 4 at w/B [-] = 0.1, 2 % of its largest value"
        );
        assert_eq!(
            largest_change(OLD, "w/B_[-]  N_[-]\n 0.0 0.0\n").unwrap(),
            "1 rows for 3"
        );
        let lost = OLD.replace("4.0", "NaN");
        let change = largest_change(OLD, &lost).unwrap();
        assert!(
            change.starts_with("N [-] NaN for 4 at w/B [-] = 0.1"),
            "{change}"
        );
    }

    #[test]
    fn other_texts_are_compared_by_their_first_line() {
        assert_eq!(
            first_change("a\nsteps 10\n", "a\nsteps 12\n"),
            "line 2: \"steps 12\" for \"steps 10\""
        );
        assert_eq!(first_change("a\nb\n", "a\n"), "ends before line 2");
    }

    #[test]
    fn residual_histories_are_drawn_step_beside_step() {
        let old = residuals("step 1: 1e0 1e-3 1e-7\nstep 4: 2e0 1e-9\n").unwrap();
        let new = residuals("step 1: 1e0 1e-7\nstep 4: 3e0 1e-9\n").unwrap();
        let finite = |of: &[Vec<f64>], other: &[Vec<f64>]| {
            let points = side_by_side(of, other);
            points.into_iter().filter(|p| p[0].is_finite()).collect()
        };
        let points: Vec<[f64; 2]> = finite(&new, &old);
        assert_eq!(points, [[1.0, 1.0], [2.0, 1e-7], [4.0, 3.0], [5.0, 1e-9]]);
        let points: Vec<[f64; 2]> = finite(&old, &new);
        assert_eq!(points.len(), 5);
        assert_eq!(points[3..], [[4.0, 2.0], [5.0, 1e-9]]);
        assert_eq!(residuals("steps: 40\ncuts: 0\n"), None);
        assert!(drawn("effort", "steps: 40\n", "steps: 41\n").is_empty());
    }

    #[test]
    fn pending_snapshots_are_accepted_once() {
        let folder = std::env::temp_dir().join(format!("igimp-left-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let head = "---\nsource: validation/src/harness/snapshot.rs\n";
        fs::write(folder.join("curve.snap"), format!("{head}---\n{OLD}")).unwrap();
        let new = OLD.replace("4.0", "4.1");
        fs::write(
            folder.join("curve.snap.new"),
            format!("{head}assertion_line: 7\n---\n{new}"),
        )
        .unwrap();
        assert_eq!(accepted(&folder, "curve").unwrap(), OLD);
        let pictures = folder.join("out/review");
        let found = difference(&folder, "curve", &new, &pictures).unwrap();
        assert!(found.change.contains("4.1 for 4"), "{found}");
        assert!(pictures.join("curve.svg").exists());
        assert_eq!(accept_left(&folder).unwrap(), ["curve"]);
        assert_eq!(accepted(&folder, "curve").unwrap(), new);
        let text = fs::read_to_string(folder.join("curve.snap")).unwrap();
        assert_eq!(text, format!("{head}---\n{new}"));
        assert!(accept_left(&folder).unwrap().is_empty());
        fs::remove_dir_all(&folder).unwrap();
    }
}
