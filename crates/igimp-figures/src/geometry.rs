//! Rectangles and clipping in picture coordinates (x to the right, y **down**, in points).

/// A point \[pt\].
pub(super) type Point = [f64; 2];

/// An upright rectangle \[pt\]; `top < bottom`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Rect {
    pub(super) fn new(left: f64, top: f64, width: f64, height: f64) -> Self {
        Self {
            left,
            top,
            right: left + width,
            bottom: top + height,
        }
    }

    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub(super) fn centre(&self) -> Point {
        [
            0.5 * (self.left + self.right),
            0.5 * (self.top + self.bottom),
        ]
    }

    pub(super) fn contains(&self, [x, y]: Point) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    /// The same rectangle with every side moved out by `by`.
    pub(super) fn grown(&self, by: f64) -> Self {
        Self {
            left: self.left - by,
            top: self.top - by,
            right: self.right + by,
            bottom: self.bottom + by,
        }
    }

    /// The four corners, in order.
    pub(super) fn corners(&self) -> Vec<Point> {
        vec![
            [self.left, self.top],
            [self.right, self.top],
            [self.right, self.bottom],
            [self.left, self.bottom],
        ]
    }

    /// The part of a polyline inside, as one or more pieces (Liang and Barsky, segment by segment).
    pub(super) fn clip_polyline(&self, points: &[Point]) -> Vec<Vec<Point>> {
        let mut pieces: Vec<Vec<Point>> = Vec::new();
        for pair in points.windows(2) {
            let Some((a, b)) = self.clip_segment(pair[0], pair[1]) else {
                continue;
            };
            match pieces.last_mut() {
                Some(piece) if piece.last() == Some(&a) => piece.push(b),
                _ => pieces.push(vec![a, b]),
            }
        }
        pieces
    }

    fn clip_segment(&self, a: Point, b: Point) -> Option<(Point, Point)> {
        let d = [b[0] - a[0], b[1] - a[1]];
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for (step, room) in [
            (-d[0], a[0] - self.left),
            (d[0], self.right - a[0]),
            (-d[1], a[1] - self.top),
            (d[1], self.bottom - a[1]),
        ] {
            if step < 0.0 {
                enter = enter.max(room / step);
            } else if step > 0.0 {
                leave = leave.min(room / step);
            } else if room < 0.0 {
                return None;
            }
        }
        let at = |t: f64| [a[0] + t * d[0], a[1] + t * d[1]];
        let start = if enter > 0.0 { at(enter) } else { a };
        let end = if leave < 1.0 { at(leave) } else { b };
        (enter <= leave).then_some((start, end))
    }

    /// The part of a polygon inside (Sutherland and Hodgman); empty if it lies outside.
    pub(super) fn clip_polygon(&self, polygon: &[Point]) -> Vec<Point> {
        let mut kept = polygon.to_vec();
        if polygon.iter().all(|&p| self.contains(p)) {
            return kept;
        }
        for (axis, sign, bound) in [
            (0, 1.0, self.left),
            (0, -1.0, self.right),
            (1, 1.0, self.top),
            (1, -1.0, self.bottom),
        ] {
            let room = |p: Point| sign * (p[axis] - bound);
            let Some(&last) = kept.last() else { break };
            let mut from = last;
            let mut next = Vec::with_capacity(kept.len() + 2);
            for &to in &kept {
                if (room(from) >= 0.0) != (room(to) >= 0.0) {
                    let t = room(from) / (room(from) - room(to));
                    next.push(std::array::from_fn(|k| from[k] + t * (to[k] - from[k])));
                }
                if room(to) >= 0.0 {
                    next.push(to);
                }
                from = to;
            }
            kept = next;
        }
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Rect = Rect {
        left: 0.0,
        top: 0.0,
        right: 1.0,
        bottom: 1.0,
    };

    #[test]
    fn a_line_that_leaves_and_returns_is_two_pieces() {
        let line = [[0.5, 0.5], [1.5, 0.5], [1.5, 0.25], [0.5, 0.25]];
        let pieces = UNIT.clip_polyline(&line);
        assert_eq!(
            pieces,
            vec![vec![[0.5, 0.5], [1.0, 0.5]], vec![[1.0, 0.25], [0.5, 0.25]]]
        );
    }

    #[test]
    fn a_line_inside_stays_whole_and_one_outside_vanishes() {
        let line = [[0.1, 0.1], [0.2, 0.9], [0.9, 0.8]];
        assert_eq!(UNIT.clip_polyline(&line), vec![line.to_vec()]);
        assert!(UNIT.clip_polyline(&[[-1.0, 2.0], [2.0, 2.0]]).is_empty());
    }

    #[test]
    fn a_polygon_over_the_corner_is_cut_to_the_rectangle() {
        let cut = UNIT.clip_polygon(&[[0.5, 0.5], [2.0, 0.5], [2.0, 2.0], [0.5, 2.0]]);
        assert_eq!(cut.len(), 4);
        assert!(cut.iter().all(|&p| UNIT.contains(p)));
        assert!(
            UNIT.clip_polygon(&[[2.0, 2.0], [3.0, 2.0], [3.0, 3.0]])
                .is_empty()
        );
    }
}
