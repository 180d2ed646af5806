//! Frames as pages take them: boxes by their corners, the faces that are seen, and numbers in as few bytes as
//! serve, as JSON with base64 in it.
//!
//! In the plane every particle is there. In space a body of many particles is there with those of its skin
//! and those that certain planes cross, so that it can be cut along these.

use std::io::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use igimp_results::paraview::read_back::FrameParticles;
use igimp_results::vtu::CellKind;
use igimp_results::vtu::read::{Frame, Stored};
use rayon::prelude::*;
use serde::Serialize;

use super::Bodies;
use crate::patches::{Carriers, Pieces};
use crate::skin::{Boxes, Lie, Skin};

/// Numbers of planes across each axis that are tried, most first.
const PLANES: [usize; 4] = [9, 5, 3, 1];
/// Boxes so close to a plane, in their widths, are taken for crossed: it may run along a crack.
const CRACK: f64 = 0.1;
/// Arrays that are left out when numbers are rounded.
const LEFT_OUT: [&str; 4] = ["deformation gradient", "mass", "volume", "regime"];
/// Of zlib: more takes twice the time, and saves hardly any room.
const LEVEL: Compression = Compression::new(2);
/// Steps of a rounded number; one step more encodes NaN.
const STEPS: f64 = 65_534.0;

/// How much of a frame is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Keep {
    /// Whether numbers are rounded to 1/65 534 of their range, and some arrays left out.
    pub rounded: bool,
    /// So many boxes are all kept; of more, the skin and so many planes as stay below.
    pub boxes: usize,
}

impl Keep {
    /// For a page that asks for frames one by one.
    pub const MUCH: Self = Self {
        rounded: false,
        boxes: 250_000,
    };
    /// For a page that holds its frames.
    pub const LITTLE: Self = Self {
        rounded: true,
        boxes: 60_000,
    };
}

/// A frame of particles or of rigid bodies.
#[derive(Debug, Serialize)]
struct Packed {
    /// 2 or 3.
    dimension: usize,
    /// Shape of the cells: `boxes`, `lines` or `triangles`.
    kind: &'static str,
    /// Number of particles, and of those that are kept.
    particles: usize,
    count: usize,
    /// Places of the planes along which the body can be cut, by axis \[m\]; null where any will do.
    planes: Option<[Vec<f64>; 3]>,
    /// Places of the cells that are shown.
    places: Vec<Array>,
    /// Fields of the particles.
    fields: Vec<Array>,
}

/// Numbers: zlib over all first bytes, all second bytes, and so on.
#[derive(Debug, Serialize)]
struct Array {
    name: String,
    components: usize,
    component_names: Vec<String>,
    whole: bool,
    /// `f32`, `i32`, `u16` or `u8`.
    kind: &'static str,
    /// By component: a number is low + step · the stored one.
    low: Vec<f64>,
    step: Vec<f64>,
    /// By component, and of three for their length too: least, largest, and the same without the outermost
    /// 1 % on either side, over all particles.
    range: Vec<[f64; 4]>,
    data: String,
}

/// A frame, of particles, rigid bodies or reinforcement, as JSON that no script ends in; none where it cannot be read.
///
/// With the bodies of the case particles of the plane are there by their pieces too, and the edges of the bodies stand beside.
pub fn packed(text: &str, keep: Keep, bodies: Option<&Bodies>) -> Option<String> {
    let frame = Frame::of(text)?;
    let packed = match frame.kind() {
        Some(CellKind::Quad | CellKind::Hexahedron) => of_boxes(&frame, keep, bodies)?,
        Some(kind) => of_bodies(&frame, kind)?,
        None if frame.cells == 0 => nothing(),
        None => return None,
    };
    let text = serde_json::to_string(&packed).ok()?;
    Some(text.replace('<', "\\u003c"))
}

fn nothing() -> Packed {
    Packed {
        dimension: 2,
        kind: "boxes",
        particles: 0,
        count: 0,
        planes: None,
        places: Vec::new(),
        fields: Vec::new(),
    }
}

fn of_bodies(frame: &Frame<'_>, kind: CellKind) -> Option<Packed> {
    let is_line = kind == CellKind::Line;
    let corners = frame.corners(kind.corners().len())?;
    let numbers: Vec<f64> = corners.concat();
    Some(Packed {
        dimension: if is_line { 2 } else { 3 },
        kind: if is_line { "lines" } else { "triangles" },
        particles: frame.cells,
        count: frame.cells,
        places: vec![exact("corners", 3, &numbers)],
        ..nothing()
    })
}

fn of_boxes(frame: &Frame<'_>, keep: Keep, bodies: Option<&Bodies>) -> Option<Packed> {
    let kind = frame.kind()?;
    let dimension = if kind == CellKind::Quad { 2 } else { 3 };
    let corners = kind.corners().len();
    // The corner opposite the first.
    let opposite = if dimension == 2 { 2 } else { 6 };
    let points = frame.corners(corners)?;
    let corner = |k: usize| points.iter().skip(k).step_by(corners).copied().collect();
    let (low, high): (Vec<[f64; 3]>, Vec<[f64; 3]>) = (corner(0), corner(opposite));
    drop(points);
    let boxes = Boxes {
        low: &low,
        high: &high,
    };
    let all: Vec<u32> = (0..u32::try_from(frame.cells).ok()?).collect();
    let (skin, kept, planes) = if dimension == 2 {
        (None, all, None)
    } else {
        let edges = match bodies {
            Some(Bodies::Space(outlines)) => FrameParticles::of(frame)
                .map_or_else(Vec::new, |particles| outlines.now(&particles)),
            _ => Vec::new(),
        };
        let skin = Skin::of(boxes, &edges);
        let (kept, planes) = if frame.cells <= keep.boxes {
            (all, None)
        } else {
            thinned(boxes, &skin, keep.boxes)
        };
        (Some((skin, edges)), kept, planes)
    };
    let mut places = vec![
        position("low", &low, &kept, boxes, keep),
        position("high", &high, &kept, boxes, keep),
    ];
    if let Some((skin, edges)) = &skin {
        let faces: Vec<u8> = kept.iter().map(|&k| skin.faces[k as usize]).collect();
        let lie: Vec<u8> = kept
            .iter()
            .flat_map(|&k| bytes_of(skin.lie[k as usize]))
            .collect();
        let moves: Vec<u8> = (kept.iter())
            .flat_map(|&k| skin.moves[k as usize].into_iter().flatten())
            .map(|share| (i16::from(share) + 128) as u8)
            .collect();
        places.extend([
            bytes("faces", 1, &faces),
            bytes("lie", 4, &lie),
            bytes("moves", 24, &moves),
        ]);
        // A body without edges has none to draw.
        if let Some(Bodies::Space(_)) = bodies {
            let ends = ends_of(&edges.iter().flatten());
            places.extend(lines(["edges", "edge-ends"], edges, keep, &ends));
        }
    }
    if let (Some(Bodies::Plane(pieces)), 2) = (bodies, dimension) {
        places.extend(of_pieces(frame, keep, pieces).unwrap_or_default());
    }
    let fields = frame.arrays("CellData");
    let wanted: Vec<&Stored<'_>> = fields
        .iter()
        .filter(|field| !keep.rounded || !LEFT_OUT.iter().any(|name| field.name.starts_with(name)))
        .collect();
    let fields = wanted
        .par_iter()
        .map(|field| of_field(field, frame.cells, &kept, keep))
        .collect::<Option<_>>()?;
    Some(Packed {
        dimension,
        kind: "boxes",
        particles: frame.cells,
        count: kept.len(),
        planes,
        places,
        fields,
    })
}

/// The pieces that particles carry, and the edges of the bodies: corners one after another, where each piece or edge ends among
/// them, and whose a piece is.
fn of_pieces(frame: &Frame<'_>, keep: Keep, pieces: &Pieces) -> Option<Vec<Array>> {
    let particles = FrameParticles::of(frame)?;
    let half_length = |&number: &usize| pieces.half_length(number);
    let half_length0: Vec<[f64; 2]> = particles
        .number
        .iter()
        .map(half_length)
        .collect::<Option<_>>()?;
    let carriers = Carriers {
        x: &particles.x,
        def_grad: &particles.def_grad,
        half_length0: &half_length0,
        number: &particles.number,
    };
    let (polygons, whose) = pieces.now(carriers);
    let edges = pieces.edges(carriers);
    let ends = ends_of(&polygons.iter().chain(&edges).flatten());
    let mut arrays = Vec::from(lines(["pieces", "piece-ends"], &polygons, keep, &ends));
    arrays.push(whole("whose", whose.iter().copied()));
    arrays.extend(lines(["edges", "edge-ends"], &edges, keep, &ends));
    Some(arrays)
}

/// Least and largest coordinate by axis.
fn ends_of<'a, const D: usize>(
    points: &(impl Iterator<Item = &'a [f64; D]> + Clone),
) -> [[f64; 2]; D] {
    std::array::from_fn(|axis| {
        let places = points.clone().map(|point| point[axis]);
        places.fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(x), b.max(x)])
    })
}

/// Lines by their names: corners one after another, and where each line ends among them.
fn lines<const D: usize>(
    names: [&str; 2],
    lines: &[Vec<[f64; D]>],
    keep: Keep,
    ends: &[[f64; 2]],
) -> [Array; 2] {
    let numbers: Vec<f64> = lines.iter().flatten().flatten().copied().collect();
    let corners = if keep.rounded {
        rounded(names[0], &numbers, ends)
    } else {
        exact(names[0], D, &numbers)
    };
    let last = lines.iter().scan(0, |last, line| {
        *last += line.len();
        Some(*last)
    });
    [corners, whole(names[1], last)]
}

/// Whole numbers.
fn whole(name: &str, numbers: impl Iterator<Item = usize>) -> Array {
    let bytes: Vec<u8> = numbers.flat_map(|n| (n as i32).to_le_bytes()).collect();
    let array = array(name, 1, "i32", &bytes);
    Array {
        whole: true,
        ..array
    }
}

/// Boxes of the skin and those that planes cross, and where these stand.
fn thinned(boxes: Boxes<'_>, skin: &Skin, most: usize) -> (Vec<u32>, Option<[Vec<f64>; 3]>) {
    let planes = |count: usize| {
        [0, 1, 2].map(|axis| {
            let finite = |x: &f64| x.is_finite();
            let low = boxes.low.iter().map(|x| x[axis]).filter(finite);
            let high = boxes.high.iter().map(|x| x[axis]).filter(finite);
            let ends = [low.fold(f64::MAX, f64::min), high.fold(f64::MIN, f64::max)];
            let share = |k| (k + 1) as f64 / (count + 1) as f64;
            let at = |k| ends[0] + share(k) * (ends[1] - ends[0]);
            (0..count).map(at).collect::<Vec<f64>>()
        })
    };
    let chosen = |planes: &[Vec<f64>; 3]| -> Vec<u32> {
        let is_crossed = |k: usize| {
            (0..3).any(|axis| {
                let (low, high) = (boxes.low[k][axis], boxes.high[k][axis]);
                let more = CRACK * (high - low);
                let span = low - more..=high + more;
                planes[axis].iter().any(|plane| span.contains(plane))
            })
        };
        (0..skin.faces.len())
            .into_par_iter()
            .filter(|&k| skin.faces[k] != 0 || is_crossed(k))
            .map(|k| k as u32)
            .collect()
    };
    let mut last = (Vec::new(), None);
    for count in PLANES {
        let planes = planes(count);
        last = (chosen(&planes), Some(planes));
        if last.0.len() <= most {
            break;
        }
    }
    last
}

/// Direction of the surface in steps of 1/127 about 128, and how free it lies.
fn bytes_of(lie: Lie) -> [u8; 4] {
    let [x, y, z] = lie.normal.map(|n| (127.0 * n).round() + 128.0);
    [x, y, z, (255.0 * lie.open).round()].map(|x| x as u8)
}

fn position(name: &str, corners: &[[f64; 3]], kept: &[u32], all: Boxes<'_>, keep: Keep) -> Array {
    let places = kept.iter().flat_map(|&k| corners[k as usize]);
    let numbers: Vec<f64> = places.collect();
    if !keep.rounded {
        return exact(name, 3, &numbers);
    }
    // Neighbours that touch are rounded to the same place.
    let ends = [0, 1, 2].map(|axis| {
        let ends = all.low.iter().chain(all.high).map(|x| x[axis]);
        let finite = ends.filter(|x| x.is_finite());
        finite.fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(x), b.max(x)])
    });
    rounded(name, &numbers, &ends)
}

fn of_field(field: &Stored<'_>, cells: usize, kept: &[u32], keep: Keep) -> Option<Array> {
    let components = field.components;
    let numbers = field.numbers(cells)?;
    let mut range: Vec<[f64; 4]> = (0..components)
        .map(|k| {
            range_of(
                numbers
                    .iter()
                    .skip(k)
                    .step_by(components)
                    .copied()
                    .collect(),
            )
        })
        .collect();
    if components == 3 {
        let length = |x: &[f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let lengths = numbers.as_chunks::<3>().0.iter().map(length);
        range.push(range_of(lengths.collect()));
    }
    let values: Vec<f64> = kept
        .iter()
        .flat_map(|&k| &numbers[components * k as usize..][..components])
        .copied()
        .collect();
    let mut array = if field.is_whole() {
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|&x| (x as i32).to_le_bytes())
            .collect();
        array(&field.name, components, "i32", &bytes)
    } else if keep.rounded {
        let ends: Vec<[f64; 2]> = range.iter().map(|&[a, b, ..]| [a, b]).collect();
        rounded(&field.name, &values, &ends[..components])
    } else {
        exact(&field.name, components, &values)
    };
    array.component_names.clone_from(&field.component_names);
    array.whole = field.is_whole();
    array.range = range;
    Some(array)
}

/// Least, largest, and the same without the outermost 1 % on either side; zeros where there is no number.
fn range_of(mut values: Vec<f64>) -> [f64; 4] {
    values.retain(|value| value.is_finite());
    let Some(last) = values.len().checked_sub(1) else {
        return [0.0; 4];
    };
    let place = |share: f64| (share * last as f64).round() as usize;
    [0, last, place(0.01), place(0.99)]
        .map(|place| *values.select_nth_unstable_by(place, f64::total_cmp).1)
}

/// Single precision, which is exact enough for numbers that are read off a picture; places far from zero count from
/// the first one on.
fn exact(name: &str, components: usize, numbers: &[f64]) -> Array {
    let low: Vec<f64> = match numbers.first_chunk::<3>() {
        Some(first) if components == 3 && first.iter().all(|x| x.is_finite()) => first.to_vec(),
        _ => vec![0.0; components],
    };
    let bytes: Vec<u8> = std::iter::zip(numbers, low.iter().cycle())
        .flat_map(|(x, low)| ((x - low) as f32).to_le_bytes())
        .collect();
    let mut array = array(name, components, "f32", &bytes);
    array.low = low;
    array
}

fn rounded(name: &str, numbers: &[f64], ends: &[[f64; 2]]) -> Array {
    let steps: Vec<f64> = ends.iter().map(|[a, b]| (b - a) / STEPS).collect();
    let bytes: Vec<u8> = std::iter::zip(numbers, (0..ends.len()).cycle())
        .flat_map(|(&x, k)| {
            let place = (x - ends[k][0]) / steps[k];
            // Without a range every number stands at its low end.
            let place = if steps[k] > 0.0 { place } else { 0.0 * x };
            let stands = if place.is_finite() {
                place.round() as u16
            } else {
                u16::MAX
            };
            stands.to_le_bytes()
        })
        .collect();
    let mut array = array(name, ends.len(), "u16", &bytes);
    array.low = ends.iter().map(|end| end[0]).collect();
    array.step = steps;
    array
}

fn bytes(name: &str, components: usize, bytes: &[u8]) -> Array {
    array(name, components, "u8", bytes)
}

fn array(name: &str, components: usize, kind: &'static str, bytes: &[u8]) -> Array {
    let width = match kind {
        "u8" => 1,
        "u16" => 2,
        _ => 4,
    };
    let sorted: Vec<u8> = (0..width)
        .flat_map(|k| bytes.iter().skip(k).step_by(width))
        .copied()
        .collect();
    let mut encoder = ZlibEncoder::new(Vec::new(), LEVEL);
    let packed = encoder
        .write_all(&sorted)
        .and_then(|()| encoder.finish())
        .expect("invariant: writing to a Vec cannot fail");
    Array {
        name: name.to_owned(),
        components,
        component_names: Vec::new(),
        whole: false,
        kind,
        low: vec![0.0; components],
        step: vec![1.0; components],
        range: Vec::new(),
        data: BASE64.encode(packed),
    }
}

#[cfg(test)]
mod tests;
