//! Reinforcement in the results: tension along it, as tables, for ParaView and in pictures.

use igimp_assembly::Reinforcement;
use igimp_figures::{Outline, OutlineStyle};
use igimp_model::{ReinforcementPart, front};
use igimp_text::short;

use crate::tables::table::Table;
use crate::vtu::{CellKind, DataArray, UnstructuredGrid, padded};

/// A member that is there.
#[derive(Clone, Copy, Debug)]
pub struct Installed<'a, const D: usize> {
    /// Its number in the case, from 0.
    pub index: usize,
    /// The member as the case describes it.
    pub part: &'a ReinforcementPart<D>,
    /// Where it is, and its tension.
    pub member: &'a Reinforcement<D>,
    /// The factor by which its bond is divided \[-\].
    pub reduction: f64,
}

/// Columns of a table of tension along a member, a row for each of its bars.
const HEADER: [&str; 7] = [
    "distance_[m]",
    "x_[m]",
    "y_[m]",
    "force_[N/m]_tension_+",
    "limit_[N/m]",
    "strain_[-]",
    "at_limit_[-]",
];
/// The same in space.
const HEADER_IN_SPACE: [&str; 8] = [
    "distance_[m]",
    "x_[m]",
    "y_[m]",
    "z_[m]",
    "force_[N]_tension_+",
    "limit_[N]",
    "strain_[-]",
    "at_limit_[-]",
];

impl<const D: usize> Installed<'_, D> {
    /// Tension at the middle of its bars, by the distance from its head before it was stretched.
    pub fn table(&self, name: String) -> Table {
        let header = if D == 2 {
            &HEADER[..]
        } else {
            &HEADER_IN_SPACE
        };
        let mut table = Table::new(name, header);
        let mut so_far = 0.0;
        let stations = self.member.stations.windows(2);
        for (bar, ends) in std::iter::zip(&self.member.segments, stations) {
            let (a, b) = (ends[0].position(), ends[1].position());
            let mut row = vec![so_far + 0.5 * bar.length];
            row.extend((0..D).map(|axis| 0.5 * (a[axis] + b[axis])));
            row.extend([
                bar.state.force,
                bar.limit(self.reduction),
                bar.state.strain,
                f64::from(u8::from(bar.state.is_at_limit)),
            ]);
            table.push(row);
            so_far += bar.length;
        }
        table
    }

    /// Its line where it is, as seen from the front \[m\].
    fn line(&self) -> Vec<[f64; 2]> {
        let stations = self.member.stations.iter();
        stations.map(|station| front(&station.position())).collect()
    }

    /// Its line, with its tension as a curve beside it: the `most` tension of all is `height` away \[m\].
    fn outlines(&self, most: f64, height: f64) -> [Outline; 2] {
        let line = self.line();
        let mut curve = vec![line[0]];
        for (bar, ends) in std::iter::zip(&self.member.segments, line.windows(2)) {
            let along = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
            let length = along[0].hypot(along[1]);
            let away = if most > 0.0 && length > 0.0 {
                height * bar.state.force / most / length
            } else {
                0.0
            };
            let by = [-along[1] * away, along[0] * away];
            curve.extend(ends.iter().map(|end| [end[0] + by[0], end[1] + by[1]]));
        }
        curve.push(line[line.len() - 1]);
        [
            Outline {
                points: curve,
                style: OutlineStyle::Diagram,
            },
            Outline {
                points: line,
                style: OutlineStyle::Member,
            },
        ]
    }
}

/// All members with their tension as curves beside them, and words for the largest of each. `size` is that of
/// the model \[m\].
pub fn outlines<const D: usize>(installed: &[Installed<'_, D>], size: f64) -> Vec<Outline> {
    let most = installed.iter().map(|entry| entry.member.largest_force());
    let most = most.fold(0.0, f64::max);
    let all = installed.iter();
    all.flat_map(|entry| entry.outlines(most, 0.04 * size))
        .collect()
}

/// The largest tension of each member in words, beside its head.
pub fn labels<const D: usize>(installed: &[Installed<'_, D>]) -> Vec<([f64; 2], String)> {
    let label = |entry: &Installed<'_, D>| {
        let force = short(entry.member.largest_force() / 1e3);
        let text = format!("{} {force} kN/m", entry.part.name);
        (front(&entry.member.stations[0].position()), text)
    };
    installed.iter().map(label).collect()
}

/// The members as lines between their stations, with the tension of their bars.
pub fn lines<const D: usize>(installed: &[Installed<'_, D>]) -> UnstructuredGrid {
    let mut points = Vec::new();
    let mut connectivity = Vec::new();
    let (mut forces, mut limits, mut strains) = (Vec::new(), Vec::new(), Vec::new());
    let (mut members, mut at_limit) = (Vec::new(), Vec::new());
    for entry in installed {
        let first = points.len();
        let stations = entry.member.stations.iter();
        points.extend(stations.map(|station| padded(&station.position())));
        for (k, bar) in entry.member.segments.iter().enumerate() {
            connectivity.extend([first + k, first + k + 1]);
            forces.push(bar.state.force);
            limits.push(bar.limit(entry.reduction));
            strains.push(bar.state.strain);
            at_limit.push(i32::from(bar.state.is_at_limit));
            members.push(entry.index as i32);
        }
    }
    let unit = if D == 2 { "N/m" } else { "N" };
    UnstructuredGrid {
        points,
        kind: CellKind::Line,
        connectivity,
        point_data: Vec::new(),
        cell_data: vec![
            DataArray::scalars(format!("force [{unit}], tension +"), forces),
            DataArray::scalars(format!("limit [{unit}]"), limits),
            DataArray::scalars("strain", strains),
            DataArray::integers("at limit", at_limit),
            DataArray::integers("member", members),
        ],
        field_data: Vec::new(),
    }
}
