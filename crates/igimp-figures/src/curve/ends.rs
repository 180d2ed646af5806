//! Labels at the ends of curves, to the right of a plot: none covers another, and a thin line leads to one that had to move.

use crate::colour::Colour;
use crate::drawing::font::{self, CAP_HEIGHT};
use crate::drawing::{Anchor, Drawing, Stroke};
use crate::frame::{GAP, TICK};
use crate::geometry::{Point, Rect};

/// Room between the lines of two labels, over the size of their letters \[-\].
const SPACING: f64 = 1.35;

/// Length of the line that leads to a label \[pt\].
const LEADER: f64 = 14.0;

/// The end of a curve.
pub(super) struct End {
    /// Where it ends \[pt\].
    pub(super) at: Point,
    pub(super) label: String,
    pub(super) colour: Colour,
}

/// Writes labels beside the area of a plot, which grows by their width.
pub(super) fn draw_ends(drawing: &mut Drawing, area: Rect, mut ends: Vec<End>) {
    ends.sort_by(|a, b| a.at[1].total_cmp(&b.at[1]));
    let wanted: Vec<f64> = (ends.iter())
        .map(|end| end.at[1].clamp(area.top, area.bottom))
        .collect();
    let places = apart(&wanted, SPACING * TICK, area.top, area.bottom);
    let mut widest: f64 = 0.0;
    for (end, (&from, to)) in ends.iter().zip(wanted.iter().zip(places)) {
        let start = end.at[0].clamp(area.left, area.right);
        let left = area.right + LEADER;
        let lead = vec![vec![
            [start + 1.5, from],
            [area.right + 3.0, from],
            [left - 2.0, to],
        ]];
        drawing.stroke(lead, Stroke::solid(end.colour, 0.7));
        let at = [left, to + 0.5 * CAP_HEIGHT * TICK];
        drawing.text(at, Anchor::Start, TICK, end.colour, &end.label);
        widest = widest.max(font::width(&end.label, TICK));
    }
    drawing.width = drawing.width.max(area.right + LEADER + widest + GAP);
}

/// Rising places no closer than `spacing`, each as near as can be to where it is wanted, between two limits as far as there is
/// room: groups that touch move together.
fn apart(wanted: &[f64], spacing: f64, low: f64, high: f64) -> Vec<f64> {
    // A group stands about the mean of its members' wanted places, less those within it.
    let mut groups: Vec<(f64, usize)> = Vec::new();
    let first = |&(sum, count): &(f64, usize)| {
        let length = (count - 1) as f64 * spacing;
        let mean = sum / count as f64;
        mean.min(high - length).max(low)
    };
    for &place in wanted {
        let mut group = (place, 1);
        while let Some(last) = groups.last().copied() {
            if first(&last) + last.1 as f64 * spacing <= first(&group) {
                break;
            }
            groups.pop();
            // The members of the latter stand further on by the length of the former.
            let moved = group.0 - group.1 as f64 * last.1 as f64 * spacing;
            group = (last.0 + moved, last.1 + group.1);
        }
        groups.push(group);
    }
    let places = groups.iter().flat_map(|group| {
        let start = first(group);
        (0..group.1).map(move |k| start + k as f64 * spacing)
    });
    places.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_stand_where_they_are_wanted_or_close_to_it() {
        let close = |found: Vec<f64>, expected: &[f64]| {
            assert_eq!(found.len(), expected.len());
            for (a, b) in found.iter().zip(expected) {
                assert!((a - b).abs() < 1e-12, "{found:?}");
            }
        };
        close(apart(&[10.0, 40.0], 5.0, 0.0, 50.0), &[10.0, 40.0]);
        // Two at one place stand to either side of it.
        close(apart(&[20.0, 20.0], 6.0, 0.0, 50.0), &[17.0, 23.0]);
        // A third is pushed along, and the group stays about its mean.
        close(
            apart(&[20.0, 20.0, 22.0], 6.0, 0.0, 50.0),
            &[44.0 / 3.0, 62.0 / 3.0, 80.0 / 3.0],
        );
        // None leaves the plot.
        close(apart(&[49.0, 50.0], 10.0, 0.0, 50.0), &[40.0, 50.0]);
        close(apart(&[0.0, 1.0], 10.0, 0.0, 50.0), &[0.0, 10.0]);
    }
}
