//! Lines of one layer of a drawing in ASCII DXF: LWPOLYLINE, POLYLINE and LINE, joined where their ends meet.
//!
//! DXF is pairs of lines, a group code and a value. Code 0 begins an entity, 8 is its layer, 10 and 20 (11 and 21) are
//! coordinates, 42 is the bulge of a polyline, 70 its flags (AutoCAD DXF reference, "entities section").

use igimp_schema::text::{clip, number, row};

use crate::named::Trouble;

/// How a binary drawing begins.
const BINARY: &str = "AutoCAD Binary DXF";
/// Ends closer than this share of the drawing's extent meet \[-\].
const MEET: f64 = 1e-6;
/// An extrusion is that of the drawing if it leans by less than this \[-\].
const ALONG: f64 = 1e-6;
/// Most pieces of a line.
const MOST: usize = 5000;
/// Entities without shape that may stand beside lines on a layer.
const WORDS: [&str; 3] = ["TEXT", "MTEXT", "ATTDEF"];

/// A line of a drawing in its own unit.
#[derive(Debug, PartialEq)]
pub(crate) struct Line {
    /// Its corners; the first is not repeated in a closed one.
    pub(crate) points: Vec<[f64; 2]>,
    /// Whether it ends where it began.
    pub(crate) is_closed: bool,
}

/// Something drawn.
struct Entity<'t> {
    kind: &'t str,
    line: usize,
    groups: Vec<(i32, &'t str, usize)>,
}

impl<'t> Entity<'t> {
    fn text(&self, code: i32) -> Option<&'t str> {
        let group = self.groups.iter().find(|group| group.0 == code)?;
        Some(group.1)
    }

    fn flags(&self) -> i64 {
        self.text(70)
            .and_then(|text| text.parse().ok())
            .unwrap_or(0)
    }

    fn layer(&self) -> &'t str {
        self.text(8).unwrap_or("0")
    }

    /// The points of two codes; a bulge between them is refused.
    fn points(&self, [x, y]: [i32; 2]) -> Result<Vec<[f64; 2]>, Trouble> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        for &(code, text, line) in &self.groups {
            if code != x && code != y && code != 42 {
                continue;
            }
            let value: Option<f64> = text.parse().ok().filter(|value: &f64| value.is_finite());
            let Some(value) = value else {
                let message = format!("line {line}, `{}`, is not a number", clip(text, 40));
                return Err(Trouble::new(message, "is it an ASCII DXF file?"));
            };
            if code == x {
                points.push([value, f64::NAN]);
            } else if code == 42 {
                if value != 0.0 {
                    return Err(self.curved(line, "with a bulge (an arc)"));
                }
            } else if let Some(last) = points.last_mut() {
                last[1] = value;
            }
        }
        if points.iter().any(|point| point[1].is_nan()) {
            let message = format!("the {} of line {} has no y", self.kind, self.line);
            return Err(Trouble::new(message, "is it an ASCII DXF file?"));
        }
        Ok(points)
    }

    /// Points in the plane of the drawing of those in the plane of the entity, which looks along its extrusion: seen from behind,
    /// left and right are exchanged (AutoCAD DXF reference, "arbitrary axis algorithm").
    fn seen(&self, points: Vec<[f64; 2]>) -> Result<Vec<[f64; 2]>, Trouble> {
        let group = |code: i32, usual: f64| match self.text(code) {
            Some(text) => text.parse().unwrap_or(f64::NAN),
            None => usual,
        };
        let [x, y, z] = [group(210, 0.0), group(220, 0.0), group(230, 1.0)];
        if x.abs() < ALONG * z.abs() && y.abs() < ALONG * z.abs() {
            let side = z.signum();
            return Ok(points.into_iter().map(|[x, y]| [side * x, y]).collect());
        }
        Err(Trouble::new(
            format_args!(
                "line {}: the {} on layer `{}` does not lie in the plane of the drawing: its extrusion is ({}, {}, {})",
                self.line,
                self.kind,
                clip(self.layer(), 40),
                number(x),
                number(y),
                number(z)
            ),
            "draw the line in the plane of x and y",
        ))
    }

    fn curved(&self, line: usize, how: &str) -> Trouble {
        Trouble::new(
            format_args!(
                "line {line}: {} {how} on layer `{}`",
                self.kind,
                clip(self.layer(), 40)
            ),
            "straight lines are read: LWPOLYLINE, POLYLINE and LINE; draw the curve as a chain of them",
        )
    }
}

/// The line on a layer of a drawing: one polyline, or several and lines that join to one.
pub(crate) fn line_on(text: &str, layer: Option<&str>) -> Result<Line, Trouble> {
    if text.starts_with(BINARY) {
        return Err(Trouble::new(
            "it is a binary DXF file",
            "save it as ASCII DXF",
        ));
    }
    let entities = entities(text)?;
    let mut layers: Vec<&str> = Vec::new();
    for entity in &entities {
        let name = entity.layer();
        if !layers.iter().any(|known| is_same(known, name)) {
            layers.push(name);
        }
    }
    let known = || {
        format!(
            "layers with something on them: {}",
            row(layers.iter().copied())
        )
    };
    let Some(layer) = layer else {
        return Err(Trouble::new(
            "a drawing needs the name of a layer",
            format_args!("add layer = \"NAME\"; {}", known()),
        ));
    };
    let of_layer = |entity: &&Entity<'_>| {
        is_same(entity.layer(), layer) && entity.text(67).is_none_or(|space| space != "1")
    };
    let mut pieces = Vec::new();
    let mut rest = entities.iter().peekable();
    while let Some(entity) = rest.next() {
        // The vertices of a polyline follow it, whatever their layer.
        let mut vertices = Vec::new();
        if entity.kind == "POLYLINE" {
            while let Some(vertex) = rest.next_if(|next| next.kind == "VERTEX") {
                vertices.push(vertex);
            }
            rest.next_if(|next| next.kind == "SEQEND");
        }
        if of_layer(&entity) {
            piece(entity, &vertices, &mut pieces)?;
        }
    }
    if pieces.is_empty() {
        return Err(Trouble::new(
            format_args!("there is no line on layer `{}`", clip(layer, 40)),
            known(),
        ));
    }
    joined(pieces).map_err(|message| {
        Trouble::new(
            format_args!("the lines on layer `{}` {message}", clip(layer, 40)),
            "draw one line on a layer of its own",
        )
    })
}

/// The unit that a drawing says of itself, `$INSUNITS` in its header, if it is one of length that case files know.
pub(crate) fn unit_of_header(text: &str) -> Option<&'static str> {
    let mut lines = text.lines().map(str::trim);
    lines.find(|line| *line == "$INSUNITS")?;
    // Group 70, then the code (AutoCAD DXF reference, "header group codes").
    lines.next().filter(|group| *group == "70")?;
    match lines.next()? {
        "1" => Some("in"),
        "2" => Some("ft"),
        "4" => Some("mm"),
        "5" => Some("cm"),
        "6" => Some("m"),
        "7" => Some("km"),
        _ => None,
    }
}

/// Names of layers are the same in capitals.
fn is_same(a: &str, b: &str) -> bool {
    a.to_lowercase() == b.to_lowercase()
}

/// The entities of a drawing.
fn entities(text: &str) -> Result<Vec<Entity<'_>>, Trouble> {
    let mut lines = text.lines().enumerate();
    let mut entities: Vec<Entity<'_>> = Vec::new();
    let (mut opens, mut is_inside, mut was_there) = (false, false, false);
    while let (Some((at, code)), Some((_, value))) = (lines.next(), lines.next()) {
        let (Ok(code), value) = (code.trim().parse::<i32>(), value.trim()) else {
            let message = format!("line {}, `{}`, is no group code", at + 1, clip(code, 40));
            return Err(Trouble::new(message, "is it an ASCII DXF file?"));
        };
        match (code, value) {
            (0, "ENDSEC" | "EOF") => is_inside = false,
            (0, "SECTION") => opens = true,
            (2, "ENTITIES") if opens => (is_inside, was_there, opens) = (true, true, false),
            (0, kind) if is_inside => entities.push(Entity {
                kind,
                line: at + 2,
                groups: Vec::new(),
            }),
            _ => {
                opens = false;
                if let Some(entity) = entities.last_mut().filter(|_| is_inside) {
                    entity.groups.push((code, value, at + 2));
                }
            }
        }
    }
    if was_there {
        Ok(entities)
    } else {
        Err(Trouble::new(
            "it has no section of entities",
            "is it an ASCII DXF file?",
        ))
    }
}

/// Adds the piece of line that an entity draws.
fn piece(
    entity: &Entity<'_>,
    vertices: &[&Entity<'_>],
    pieces: &mut Vec<Line>,
) -> Result<(), Trouble> {
    let is_closed = entity.flags() & 1 == 1;
    let (points, is_closed) = match entity.kind {
        "LWPOLYLINE" => (entity.seen(entity.points([10, 20])?)?, is_closed),
        // 2 and 4: fitted curves; 16 and 64: meshes.
        "POLYLINE" if entity.flags() & (2 + 4 + 16 + 64) != 0 => {
            return Err(entity.curved(entity.line, "that is a fitted curve or a mesh"));
        }
        "POLYLINE" => {
            let mut points = Vec::with_capacity(vertices.len());
            for vertex in vertices {
                points.extend(vertex.points([10, 20])?);
            }
            // The vertices of one in space are those of the drawing.
            if entity.flags() & 8 == 0 {
                points = entity.seen(points)?;
            }
            (points, is_closed)
        }
        "LINE" => {
            let mut points = entity.points([10, 20])?;
            points.extend(entity.points([11, 21])?);
            (points, false)
        }
        kind if WORDS.contains(&kind) => return Ok(()),
        _ => return Err(entity.curved(entity.line, "found")),
    };
    if points.len() >= 2 {
        pieces.push(Line { points, is_closed });
    }
    Ok(())
}

/// One line of all pieces.
fn joined(mut pieces: Vec<Line>) -> Result<Line, String> {
    if pieces.len() > MOST {
        return Err(format!(
            "are {} pieces; at most {MOST} are joined",
            pieces.len()
        ));
    }
    let all = || pieces.iter().flat_map(|piece| &piece.points);
    let extent = (0..2)
        .map(|k| {
            let (least, most) = all().fold((f64::MAX, f64::MIN), |(least, most), point| {
                (least.min(point[k]), most.max(point[k]))
            });
            most - least
        })
        .fold(0.0, f64::max);
    let meet = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) <= MEET * extent;
    let first = pieces.remove(0);
    let mut chain = first.points;
    let mut is_closed = first.is_closed;
    while !is_closed {
        let (head, tail) = (chain[0], chain[chain.len() - 1]);
        if chain.len() > 2 && meet(head, tail) {
            chain.pop();
            is_closed = true;
            break;
        }
        let ends = |piece: &Line| [piece.points[0], piece.points[piece.points.len() - 1]];
        let next = pieces.iter().position(|piece| {
            !piece.is_closed
                && ends(piece)
                    .iter()
                    .any(|&end| meet(end, tail) || meet(end, head))
        });
        let Some(next) = next else { break };
        let mut piece = pieces.remove(next).points;
        if meet(piece[0], head) || meet(piece[piece.len() - 1], head) && !meet(piece[0], tail) {
            chain.reverse();
        }
        if !meet(piece[0], chain[chain.len() - 1]) {
            piece.reverse();
        }
        chain.extend(piece.into_iter().skip(1));
    }
    match pieces.first() {
        None => Ok(Line {
            points: chain,
            is_closed,
        }),
        Some(other) => {
            let [a, b] = [chain[chain.len() - 1], other.points[0]];
            let at = |p: [f64; 2]| format!("({}, {})", number(p[0]), number(p[1]));
            let first = if is_closed { "closes at" } else { "ends at" };
            Err(format!(
                "are several: one {first} {}, another begins at {}",
                at(a),
                at(b)
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{line_on, unit_of_header};

    fn drawn(entities: &str) -> String {
        format!("0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n")
    }

    fn line(from: [f64; 2], to: [f64; 2]) -> String {
        let [[a, b], [c, d]] = [from, to];
        format!("0\nLINE\n8\nclay\n10\n{a}\n20\n{b}\n30\n0\n11\n{c}\n21\n{d}\n31\n0\n")
    }

    /// GOAL: lines join to a closed one from both ends, whichever way each of them runs.
    #[test]
    fn lines_join_where_their_ends_meet() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
        let side = |k: usize| (corners[k], corners[(k + 1) % 4]);
        for order in [[0, 1, 2, 3], [2, 0, 3, 1], [3, 1, 0, 2]] {
            for turned in 0..16_usize {
                let sides = order.iter().map(|&k| {
                    let (a, b) = side(k);
                    if turned >> k & 1 == 1 {
                        line(b, a)
                    } else {
                        line(a, b)
                    }
                });
                let found = line_on(&drawn(&sides.collect::<String>()), Some("clay"));
                let Ok(found) = found else {
                    panic!("{order:?}, {turned}")
                };
                assert!(found.is_closed);
                assert_eq!(found.points.len(), 4);
                assert!(
                    (igimp_geometry::polygon::area_and_centroid(&found.points)
                        .0
                        .abs()
                        - 12.0)
                        .abs()
                        < 1e-12
                );
            }
        }
    }

    #[test]
    fn a_line_within_a_block_or_on_paper_does_not_count() {
        let paper = line([0.0, 0.0], [1.0, 0.0]).replace("8\nclay", "67\n1\n8\nclay");
        let model = line([0.0, 2.0], [1.0, 2.0]);
        let block = format!("0\nSECTION\n2\nBLOCKS\n{model}0\nENDSEC\n");
        let text = block + &drawn(&format!("{paper}{model}"));
        let found = line_on(&text, Some("Clay"))
            .map_err(|trouble| trouble.message)
            .unwrap();
        assert_eq!(found.points, [[0.0, 2.0], [1.0, 2.0]]);
        assert!(!found.is_closed);
    }

    // GOAL: a polyline that was drawn, or mirrored, from behind has left and right exchanged; one that leans is refused.
    // ORACLE: the arbitrary axis algorithm of the AutoCAD DXF reference: for the extrusion (0, 0, -1) its x axis is
    // (0, 1, 0) x (0, 0, -1) = (-1, 0, 0), its y axis (0, 0, -1) x (-1, 0, 0) = (0, 1, 0).
    #[test]
    fn a_polyline_seen_from_behind_is_mirrored() {
        let points = "10\n1\n20\n2\n10\n4\n20\n3\n";
        let light = |extrusion: &str| {
            let text = drawn(&format!(
                "0\nLWPOLYLINE\n8\nclay\n90\n2\n{points}{extrusion}"
            ));
            line_on(&text, Some("clay")).map_err(|trouble| trouble.message)
        };
        let vertices = "0\nVERTEX\n8\nclay\n10\n1\n20\n2\n0\nVERTEX\n8\nclay\n10\n4\n20\n3\n0\nSEQEND\n8\nclay\n";
        let old = |head: &str| {
            let text = drawn(&format!("0\nPOLYLINE\n8\nclay\n66\n1\n{head}{vertices}"));
            let found = line_on(&text, Some("clay")).map_err(|trouble| trouble.message);
            found.unwrap().points
        };
        let (front, behind) = ([[1.0, 2.0], [4.0, 3.0]], [[-1.0, 2.0], [-4.0, 3.0]]);
        let from_behind = "210\n0\n220\n0\n230\n-1\n";
        assert_eq!(light("").unwrap().points, front);
        assert_eq!(light("230\n1\n").unwrap().points, front);
        assert_eq!(light(from_behind).unwrap().points, behind);
        assert_eq!(old(from_behind), behind);
        assert_eq!(old(&format!("70\n8\n{from_behind}")), front);
        let leans = light("210\n0\n220\n1\n230\n0\n").unwrap_err();
        assert!(leans.contains("does not lie in the plane"), "{leans}");
    }

    // GOAL: the unit of a drawing is that of its header, and nothing where the header names none.
    // ORACLE: the codes of the AutoCAD DXF reference; a drawing of ezdxf, in metres.
    #[test]
    fn the_header_names_the_unit() {
        let drawing = include_str!("../../igimp-cases/tests/data/drawings/r2000.dxf");
        assert_eq!(unit_of_header(drawing), Some("m"));
        let header =
            |code: &str| format!("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n 70\n{code}\n0\nENDSEC\n");
        for (code, unit) in [
            ("1", "in"),
            ("2", "ft"),
            ("4", "mm"),
            ("5", "cm"),
            ("6", "m"),
            ("7", "km"),
        ] {
            assert_eq!(unit_of_header(&header(code)), Some(unit));
        }
        for code in ["0", "3", "21", "", "m"] {
            assert_eq!(unit_of_header(&header(code)), None);
        }
        assert_eq!(unit_of_header("9\n$INSUNITS\n"), None);
        let old = include_str!("../../igimp-cases/tests/data/drawings/r12.dxf");
        assert_eq!(unit_of_header(old), None);
    }

    /// GOAL: a damaged drawing is read or refused, and nothing else.
    #[test]
    fn damaged_drawings_do_no_harm() {
        let whole = include_str!("../../igimp-cases/tests/data/drawings/r12.dxf");
        for at in (0..whole.len()).filter(|&at| whole.is_char_boundary(at)) {
            let (before, after) = whole.split_at(at);
            let rest = after.get(1..).unwrap_or_default();
            for damage in ["", "9", "-", "\n", " ", "x", "1e999", "\0", "é"] {
                for layer in [None, Some("clay"), Some("sand")] {
                    let _ = line_on(&format!("{before}{damage}{rest}"), layer);
                    let _ = line_on(before, layer);
                }
            }
        }
    }
}
