//! Fields of a body in space: its surface, lit, and cuts through it.

use std::path::Path;

use igimp_figures::{Face, FieldPlot, SpacePlot, View};
use igimp_model::{Cut, Field, PoreSource};
use igimp_results::fields::{self, Axes, Scale};
use igimp_results::summary::FigureNote;

use super::field::Colours;
use super::{Seen, Shown, sentence, titled, water, write};
use crate::error::ReportError;
use crate::skin::{Boxes, Skin};

/// How much the direction of a face itself counts beside that of the surface around it.
const FACE: f64 = 1.0;

/// A state in space that is drawn field by field; its surface is found once.
#[derive(Debug)]
pub struct InSpace<'a> {
    folder: &'a Path,
    /// Title of the case.
    title: &'a str,
    /// Whether titles distinguish total from effective stress.
    pore_water: bool,
    state: Seen<'a, 3>,
    /// Triangles of rigid bodies.
    bodies: Vec<[[f64; 3]; 3]>,
    /// The water tables to draw.
    water: Vec<PoreSource>,
    low: Vec<[f64; 3]>,
    high: Vec<[f64; 3]>,
    skin: Skin,
}

/// How a field is coloured.
struct Coloured {
    values: Vec<f64>,
    colours: Colours,
    label: String,
    /// The quantity in words, for captions.
    quantity: String,
}

impl<'a> InSpace<'a> {
    /// The state of a case of that title, for its results folder, with the triangles of rigid bodies and the lines along `edges`
    /// of the bodies. With `pore_water` titles distinguish total from effective stress.
    pub fn new(
        folder: &'a Path,
        title: &'a str,
        pore_water: bool,
        state: Seen<'a, 3>,
        bodies: Vec<[[f64; 3]; 3]>,
        edges: &[Vec<[f64; 3]>],
    ) -> Self {
        let corner = |sign: f64| {
            let domains = std::iter::zip(&state.particles.x, &state.particles.half_length);
            domains
                .map(|(x, half)| [0, 1, 2].map(|axis| x[axis] + sign * half[axis]))
                .collect::<Vec<_>>()
        };
        let (low, high) = (corner(-1.0), corner(1.0));
        let boxes = Boxes {
            low: &low,
            high: &high,
        };
        let skin = Skin::of(boxes, edges);
        Self {
            folder,
            title,
            pore_water,
            state,
            bodies,
            water: Vec::new(),
            low,
            high,
            skin,
        }
    }

    /// The same, with water tables over the cuts.
    #[must_use]
    pub fn with_water(self, water: Vec<PoreSource>) -> Self {
        Self { water, ..self }
    }

    /// Upright planes across either level axis, through that particle which was nearest to the middle of the
    /// body before it moved: so they run through domains and not between them.
    pub fn middle(&self) -> Vec<Cut> {
        let particles = self.state.particles;
        let plane = |axis: usize| {
            let moved = std::iter::zip(&particles.x, &particles.displacement);
            let places: Vec<f64> = moved.map(|(x, u)| x[axis] - u[axis]).collect();
            let finite = places.iter().copied().filter(|x| x.is_finite());
            let ends = finite.fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(x), b.max(x)]);
            let middle = 0.5 * (ends[0] + ends[1]);
            let from = |x: &f64| (x - middle).abs();
            let finite = places.iter().copied().filter(|x| x.is_finite());
            let at = finite.min_by(|a, b| from(a).total_cmp(&from(b)))?;
            Some(Cut { axis, at })
        };
        [1, 0].into_iter().filter_map(plane).collect()
    }

    /// The surface coloured by a field, and cuts along planes, all with the same unit and colours: those of the
    /// state and of the states that it is `compared` with.
    ///
    /// # Errors
    /// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
    pub fn pictures(
        &self,
        shown: &Shown,
        field: Field,
        compared: &[Seen<'_, 3>],
        planes: &[Cut],
    ) -> Result<Vec<FigureNote>, ReportError> {
        let coloured = self.coloured(field, compared);
        let title = titled(self.title, &shown.title);
        let plot = SpacePlot {
            title: title.clone(),
            faces: self.faces(&coloured.values),
            bodies: self.bodies.clone(),
            view: View::default(),
            label: coloured.label.clone(),
            range: coloured.colours.range,
            map: coloured.colours.map,
        };
        let same = if compared.is_empty() {
            ""
        } else {
            " Colours and unit are the same in both states of the search."
        };
        let bodies = if self.bodies.is_empty() {
            ""
        } else {
            " Grey: rigid bodies."
        };
        let name = |kind: &str| format!("{kind}-{}-{}", shown.name, field.name());
        let caption = format!(
            "{} {}: the surface of the particles' domains.{bodies}{same}",
            coloured.quantity, shown.when
        );
        let mut notes = vec![write(self.folder, &name("space"), &plot.draw()?, caption)?];
        for plane in planes {
            let letter = ["x", "y", "z"][plane.axis];
            let at = format!("{letter} = {} m", rounded(plane.at));
            let plot = self.cut(*plane, &coloured, titled(&title, &at));
            let caption = format!(
                "{} {} in the plane {at}: the domains that it crosses{}.{same}",
                coloured.quantity,
                shown.when,
                water::legend(&plot.outlines)
            );
            let same_axis = planes.iter().filter(|other| other.axis == plane.axis);
            // More of them across an axis differ by their places.
            let name = if same_axis.count() > 1 {
                name(&plane.name())
            } else {
                name(&format!("cut-{letter}"))
            };
            notes.push(write(self.folder, &name, &plot.draw()?, caption)?);
        }
        Ok(notes)
    }

    fn coloured(&self, field: Field, compared: &[Seen<'_, 3>]) -> Coloured {
        let values = self.state.values(field);
        let mut all = values.clone();
        all.extend(compared.iter().flat_map(|seen| seen.values(field)));
        let scale = Scale::of(field.dimension(), all.iter().copied());
        let colours = Colours::of(field, &scale.apply(&all));
        let is_total = self.pore_water && field.is_total();
        let total = if is_total { "total " } else { "" };
        let title = fields::plain(field.title_in(Axes::Space));
        Coloured {
            values: scale.apply(&values),
            label: format!(
                "{total}{}{}",
                fields::label_in(Axes::Space, field, scale),
                colours.note()
            ),
            quantity: sentence(&format!("{total}{title}")),
            colours,
        }
    }

    fn boxes(&self) -> Boxes<'_> {
        Boxes {
            low: &self.low,
            high: &self.high,
        }
    }

    fn faces(&self, values: &[f64]) -> Vec<Face> {
        let boxes = self.boxes();
        let mut faces = Vec::with_capacity(self.skin.count());
        for (k, &value) in values.iter().enumerate() {
            let lie = self.skin.lie[k];
            for face in (0..6).filter(|face| self.skin.faces[k] & (1 << face) != 0) {
                let corners = self.skin.corners(boxes, k, face);
                let face_normal = across(&corners, [-1.0, 1.0][face % 2]);
                let normal = [0, 1, 2].map(|axis| FACE * face_normal[axis] + lie.normal[axis]);
                faces.push(Face {
                    corners,
                    normal: unit(normal),
                    open: lie.open,
                    value,
                });
            }
        }
        faces
    }

    /// The sections of the domains that a plane crosses.
    fn cut(&self, plane: Cut, coloured: &Coloured, title: String) -> FieldPlot {
        let [across, up] = [[1, 2], [0, 2], [0, 1]][plane.axis];
        let letters = ["x [m]", "y [m]", "z [m]"];
        let boxes = self.boxes();
        let crossed = (0..self.low.len()).filter(|&k| {
            // Of domains that meet in the plane, those beyond it.
            self.low[k][plane.axis] <= plane.at && plane.at < self.high[k][plane.axis]
        });
        let (domains, values): (Vec<_>, Vec<_>) = crossed
            .map(|k| {
                let section = self.skin.section(boxes, k, plane.axis, plane.at);
                let corners = section.map(|at| [at[across], at[up]]).to_vec();
                (corners, coloured.values[k])
            })
            .unzip();
        FieldPlot {
            title,
            outlines: water::over_cut(&self.water, plane, &domains),
            domains,
            values,
            label: coloured.label.clone(),
            range: coloured.colours.range,
            map: coloured.colours.map,
            x_label: letters[across].to_owned(),
            y_label: letters[up].to_owned(),
            ..FieldPlot::default()
        }
    }
}

/// The direction across the diagonals of a face, whose corners turn about it in that sense.
fn across(corners: &[[f64; 3]; 4], sense: f64) -> [f64; 3] {
    let way = |from: usize, to: usize| [0, 1, 2].map(|k| corners[to][k] - corners[from][k]);
    let (u, v) = (way(0, 2), way(1, 3));
    unit([0, 1, 2].map(|k| {
        let [a, b] = [(k + 1) % 3, (k + 2) % 3];
        sense * (u[a] * v[b] - u[b] * v[a])
    }))
}

/// A direction with the length 1.
fn unit(way: [f64; 3]) -> [f64; 3] {
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    way.map(|x| x / length.max(f64::MIN_POSITIVE))
}

/// A place in few digits.
fn rounded(at: f64) -> String {
    let text = format!("{at:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
