//! Grid lines where they are wanted: given places, layer boundaries, sides of rigid bodies, zones of finer cells.
//!
//! The wanted size of a cell is that of the grid, or a finer one nearby: of a zone, or of lines
//! closer together than a cell. Away from them it grows so that each cell is `growth` times its
//! neighbour (theory, eq. 37c). Between two given lines the cells are as near to that as a whole number of them
//! allows.

use super::AxisSpec;

/// Steps of the search for places, to the size of a cell.
const STEPS_PER_CELL: f64 = 64.0;
/// Layer boundaries closer to a line than this share of the cell stay within it \[-\].
const TOO_CLOSE: f64 = 0.25;
/// The lines beside a side of a rigid body are at least so far from others, or on them \[cells\].
const BESIDE: f64 = 0.55;

/// The lines wanted along one direction of the grid.
#[derive(Clone, Debug)]
pub struct WantedLines {
    /// Where the axis begins and ends \[m\].
    pub ends: [f64; 2],
    /// Size of a cell where nothing finer is near \[m\].
    pub cell: f64,
    /// Places of lines \[m\].
    pub lines: Vec<f64>,
    /// Layer boundaries, the most important first \[m\].
    pub levels: Vec<f64>,
    /// Places in the middle of cells, ascending, by rigid body \[m\].
    pub mid_cell: Vec<Vec<f64>>,
    /// Finer cells.
    pub zones: Vec<Zone>,
    /// Ratio of neighbouring cells where sizes change \[-\].
    pub growth: f64,
}

/// A stretch of finer cells.
#[derive(Clone, Copy, Debug)]
pub struct Zone {
    /// Its ends \[m\].
    pub ends: [f64; 2],
    /// Size of its cells \[m\].
    pub cell: f64,
}

impl WantedLines {
    /// The axis, or nothing if it had more than `most` cells.
    pub fn axis(&self, most: f64) -> Option<AxisSpec> {
        let [lower, upper] = self.ends;
        let fixed = self.fixed();
        let cells = (upper - lower) / self.cell;
        let is_on_line = |x: &f64| {
            let place = (x - lower) / self.cell;
            (place - place.round()).abs() < 1e-9 * cells.max(1.0)
        };
        if self.zones.is_empty() && fixed.iter().all(is_on_line) {
            return Some(AxisSpec::Equal {
                lower,
                cell: (upper - lower) / cells.round(),
                cells: cells.round() as usize,
            });
        }
        let finest = self
            .zones
            .iter()
            .map(|zone| (zone.ends[1] - zone.ends[0]) / zone.cell);
        if finest.fold(0.0, f64::max) > most || cells > most {
            return None;
        }
        let mut zones = self.zones.clone();
        zones.extend(fixed.windows(2).map(|ends| Zone {
            ends: [ends[0], ends[1]],
            cell: ends[1] - ends[0],
        }));
        zones.retain(|zone| zone.cell < self.cell);
        let size = |x: f64| self.size(&zones, x);
        let mut lines = vec![lower];
        for ends in fixed.windows(2) {
            let left = most - lines.len() as f64;
            divide([ends[0], ends[1]], &size, left, &mut lines)?;
        }
        Some(AxisSpec::Lines(lines))
    }

    /// The places that lines go through, ascending: ends, given lines, sides of rigid bodies and layer
    /// boundaries that are not too close to them, and ends of zones that are not too close to those.
    fn fixed(&self) -> Vec<f64> {
        let [lower, upper] = self.ends;
        let mut fixed = vec![lower, upper];
        let size = |x: f64| self.size(&self.zones, x);
        add(
            &mut fixed,
            self.lines.iter().map(|&x| (x, 1e-6 * self.cell)),
        );
        for sides in &self.mid_cell {
            self.add_beside(sides, &mut fixed);
        }
        add(
            &mut fixed,
            self.levels.iter().map(|&x| (x, TOO_CLOSE * size(x))),
        );
        let ends = self.zones.iter().flat_map(|zone| zone.ends);
        let inside = ends.filter(|&x| lower < x && x < upper);
        add(&mut fixed, inside.map(|x| (x, 0.5 * size(x))));
        fixed.sort_by(f64::total_cmp);
        fixed
    }

    /// Adds the two lines beside each side of a body, where both have room (theory, eq. 37c).
    fn add_beside(&self, sides: &[f64], fixed: &mut Vec<f64>) {
        let [lower, upper] = self.ends;
        let is_within = |x: &&f64| lower < **x && **x < upper;
        let sides: Vec<f64> = sides.iter().filter(is_within).copied().collect();
        let (Some(first), Some(last)) = (sides.first(), sides.last()) else {
            return;
        };
        let cells = ((last - first) / self.size(&self.zones, *first)).round();
        for &side in &sides {
            let cell = if cells < 1.0 {
                self.size(&self.zones, side)
            } else {
                (last - first) / cells
            };
            let lines = [side - 0.5 * cell, side + 0.5 * cell];
            let is_taken = |x: f64, other: f64| (x - other).abs() <= 1e-6 * cell;
            let has_room = |x: f64| {
                lower - 1e-6 * cell <= x
                    && x <= upper + 1e-6 * cell
                    && (fixed.iter())
                        .all(|&other| is_taken(x, other) || (x - other).abs() > BESIDE * cell)
            };
            if lines.iter().all(|&x| has_room(x)) {
                let new = lines.map(|x| (x, 1e-6 * cell));
                add(fixed, new.into_iter());
            }
        }
    }

    /// The wanted size of a cell at a place \[m\].
    fn size(&self, zones: &[Zone], x: f64) -> f64 {
        // Sizes that grow by this with distance are a geometric row of ratio `growth`.
        let slope = self.growth.ln();
        let of = |zone: &Zone| {
            let distance = (zone.ends[0] - x).max(x - zone.ends[1]).max(0.0);
            zone.cell + slope * distance
        };
        zones.iter().map(of).fold(self.cell, f64::min)
    }
}

/// Adds places that are further than their distance from all others.
fn add(fixed: &mut Vec<f64>, places: impl Iterator<Item = (f64, f64)>) {
    for (x, distance) in places {
        if fixed.iter().all(|other| (x - other).abs() > distance) {
            fixed.push(x);
        }
    }
}

/// Adds the lines of one stretch, its beginning excluded; nothing if there were more than `most`.
fn divide(
    [from, to]: [f64; 2],
    size: &dyn Fn(f64) -> f64,
    most: f64,
    lines: &mut Vec<f64>,
) -> Option<()> {
    if to - from <= size(from).min(size(to)) {
        lines.push(to);
        return Some(());
    }
    // Places at equal shares of a cell.
    let (mut x, mut count, mut places) = (from, 0.0, vec![(0.0, from)]);
    let mut is_even = true;
    while x < to {
        let middle = x + 0.5 * size(x) / STEPS_PER_CELL;
        let step = size(middle) / STEPS_PER_CELL;
        is_even &= step.total_cmp(&(size(from) / STEPS_PER_CELL)).is_eq();
        let taken = (to - x).min(step);
        x = if taken < step { to } else { x + step };
        count += taken / step / STEPS_PER_CELL;
        places.push((count, x));
        if count > most {
            return None;
        }
    }
    let total = if is_even {
        (to - from) / size(from)
    } else {
        count
    };
    // The nearest whole number, as a ratio.
    let floor = total.floor();
    let cells = if total > (floor * (floor + 1.0)).sqrt() {
        floor + 1.0
    } else {
        floor
    };
    for k in 1..cells as usize {
        let share = k as f64 / cells;
        lines.push(if is_even {
            from + share * (to - from)
        } else {
            let wanted = share * count;
            let next = places.partition_point(|place| place.0 < wanted);
            let ((c0, x0), (c1, x1)) = (places[next - 1], places[next]);
            x0 + (wanted - c0) / (c1 - c0) * (x1 - x0)
        });
    }
    lines.push(to);
    Some(())
}

/// The largest ratio of neighbouring cells, and the line between them \[-, m\].
pub fn largest_jump(axis: &AxisSpec) -> (f64, f64) {
    let lines: Vec<f64> = axis.lines().collect();
    let jumps = lines.windows(3).map(|three| {
        let (below, above) = (three[1] - three[0], three[2] - three[1]);
        ((below / above).max(above / below), three[1])
    });
    jumps.fold((1.0, axis.lower()), |largest, jump| {
        if jump.0 > largest.0 { jump } else { largest }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wish() -> WantedLines {
        WantedLines {
            ends: [0.0, 10.0],
            cell: 1.0,
            lines: Vec::new(),
            levels: Vec::new(),
            mid_cell: Vec::new(),
            zones: Vec::new(),
            growth: 1.3,
        }
    }

    fn lines(wish: &WantedLines) -> Vec<f64> {
        wish.axis(1e6).unwrap().lines().collect()
    }

    #[test]
    fn lines_on_the_grid_change_nothing() {
        let on_grid = WantedLines {
            lines: vec![3.0],
            levels: vec![7.0],
            ..wish()
        };
        let equal = AxisSpec::Equal {
            lower: 0.0,
            cell: 1.0,
            cells: 10,
        };
        assert_eq!(on_grid.axis(1e6), Some(equal));
    }

    #[test]
    fn cells_between_lines_are_as_near_as_equal_division_allows() {
        let found = lines(&WantedLines {
            lines: vec![4.5],
            ..wish()
        });
        // 4.5 m in five cells of 0.9 m, or in four of 1.125 m: the first is the smaller ratio;
        // 5.5 m in six cells of 0.917 m, or in five of 1.1 m.
        assert_eq!(found.len(), 5 + 6 + 1);
        assert!((found[5] - 4.5).abs() < 1e-15 && (found[1] - 0.9).abs() < 1e-15);
    }

    /// GOAL: both sides of a body stand in the middle of a cell, wherever the grid lies.
    #[test]
    fn sides_stand_in_the_middle_of_cells() {
        for (place, width) in [(3.0, 2.0), (3.2, 3.0), (4.9, 2.4), (2.7, 4.6)] {
            let sides = vec![place, place + width];
            let found = WantedLines {
                mid_cell: vec![sides.clone()],
                ..wish()
            };
            let axis = found.axis(1e6).unwrap();
            for side in sides {
                let share = axis.place(side).fract();
                assert!((share - 0.5).abs() < 1e-9, "{place} {width}: {share}");
            }
            let (jump, _) = largest_jump(&axis);
            assert!(jump < 1.35, "{place} {width}: {jump}");
        }
    }

    /// GOAL: lines that a file gives are kept, and a side that leaves no room has none.
    #[test]
    fn given_lines_go_before_sides() {
        let given = WantedLines {
            lines: vec![4.3],
            mid_cell: vec![vec![4.3, 6.7]],
            ..wish()
        };
        let found = lines(&given);
        assert!(found.contains(&4.3), "{found:?}");
        let share = given.axis(1e6).unwrap().place(6.7).fract();
        assert!((share - 0.5).abs() < 1e-9, "{share}");
    }

    #[test]
    fn sizes_grow_as_stated_from_zones_and_thin_layers() {
        let zone = Zone {
            ends: [4.0, 5.0],
            cell: 0.1,
        };
        let graded = WantedLines {
            zones: vec![zone],
            ..wish()
        };
        let thin = WantedLines {
            lines: vec![4.0, 4.2],
            ..wish()
        };
        for (wish, finest) in [(graded, 0.1), (thin, 0.2)] {
            let axis = wish.axis(1e6).unwrap();
            let [smallest, largest] = axis.extremes();
            assert!((smallest / finest - 1.0).abs() < 0.1, "{smallest}");
            assert!(largest < 1.1 && largest > 0.7, "{largest}");
            let (jump, at) = largest_jump(&axis);
            assert!(jump < 1.5, "{jump} at {at}");
            for place in wish.fixed() {
                let line = axis.place(place);
                assert!((line - line.round()).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn boundaries_close_to_a_line_stay_in_the_cell() {
        let found = WantedLines {
            lines: vec![3.0],
            levels: vec![3.2, 6.4, 6.5],
            ..wish()
        }
        .fixed();
        assert_eq!(found, [0.0, 3.0, 6.4, 10.0]);
    }

    #[test]
    fn too_many_cells_are_not_made() {
        let zone = Zone {
            ends: [4.0, 5.0],
            cell: 1e-9,
        };
        let many = WantedLines {
            zones: vec![zone],
            ..wish()
        };
        assert!(many.axis(1e4).is_none());
    }
}
