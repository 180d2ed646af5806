//! A film of a run: the frames that its folder keeps, drawn as the pictures are, one after another.

use std::fs;
use std::path::Path;

use igimp_figures::{Drawing, FieldPlot, Outline, OutlineStyle, STAYS, Scale as AxisScale, film};
use igimp_model::{Case, Field, StageKind};
use igimp_results::ResultsError;
use igimp_results::fields::{self, Scale};
use igimp_results::paraview::pvd::{self, Frame};
use igimp_results::paraview::read_back::{self, FrameParticles};
use igimp_results::vtu::read;
use igimp_text::short;
use rayon::prelude::*;

use crate::error::ReportError;
use crate::patches::{Carriers, Pieces};
use crate::pictures::{Colours, axes_of, edges, titled, water};
use crate::whereabouts::whereabouts;

/// Free room around the bodies, as a share of the larger side of the box of their motion \[-\].
const ROOM: f64 = 0.03;
/// Time that a frame stays where the case has no time \[s\].
const STAY: f64 = 0.25;
/// Time that the last frame stays \[s\].
const LAST: f64 = 2.0;
/// A motion is shown so slowly that it takes no less than this \[s\].
const SHORTEST: f64 = 4.0;
/// How fast a motion may be shown when nobody asks for a pace \[-\].
const PACES: [f64; 7] = [1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01];
/// Most frames: of more, as many at equal distances.
const MOST: usize = 400;

/// A film that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmRequest {
    /// The field.
    pub field: Field,
    /// The stage, by its number from 0; none: that of the last motion, or the whole run where nothing moves in time.
    pub stage: Option<usize>,
    /// Time of the film over that of the motion: 0.1 is ten times slower than it was; none: slow enough to be followed.
    pub pace: Option<f64>,
    /// Width \[pixel\].
    pub width: u32,
}

/// A film, and its data.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// The bytes of the animated GIF.
    pub gif: Vec<u8>,
    /// Number of its frames.
    pub frames: usize,
    /// How long it takes \[s\].
    pub seconds: f64,
    /// Time of the motion over that of the film, where the soil moves in time \[-\].
    pub pace: Option<f64>,
}

/// A frame as it is drawn.
struct Scene {
    particles: FrameParticles<2>,
    half_length0: Vec<[f64; 2]>,
    values: Vec<f64>,
    over: Vec<Outline>,
}

/// Draws the frames of a results folder as a film.
///
/// # Errors
/// [`ReportError::NoFilm`] where there are fewer than two frames, or none with the field; [`ReportError::Results`], [`ReportError::Figure`].
pub fn film_of(folder: &Path, case: &Case<2>, request: &FilmRequest) -> Result<Film, ReportError> {
    let folder = folder.join("paraview");
    let frames = chosen(&folder, case, request.stage);
    if frames.len() < 2 {
        let why = "the folder has fewer than two frames of it; paraview = { every = \"film\" } in [output] writes some tens";
        return Err(ReportError::NoFilm {
            why: why.to_owned(),
        });
    }
    let is_motion = frames.iter().all(|(_, step)| step.is_none());
    let lasts = frames[frames.len() - 1].0.time - frames[0].0.time;
    let pace = is_motion.then(|| request.pace.unwrap_or_else(|| pace_of(lasts)));
    let frames = match pace {
        Some(pace) => at_pace(frames, pace)?,
        None => frames,
    };
    let (frames, steps): (Vec<Frame>, Vec<Option<String>>) = frames.into_iter().unzip();
    let pieces = Pieces::of(case)?;
    let scenes = frames
        .par_iter()
        .map(|frame| scene(&folder, frame, (case, &pieces), request.field))
        .collect::<Result<Vec<Scene>, ReportError>>()?;
    let stage = Stage {
        case,
        pieces: &pieces,
        look: Look::of(request.field, &scenes, case),
        window: window(&pieces, &scenes),
    };
    let pictures = (0..frames.len())
        .into_par_iter()
        .map(|k| {
            let label = label(&frames[k], steps[k].as_deref(), pace);
            Ok(stage.draw(&label, &scenes[k])?.to_rgb(request.width)?)
        })
        .collect::<Result<Vec<_>, ReportError>>()?;
    let stays = (0..frames.len()).map(|k| match (frames.get(k + 1), pace) {
        (None, _) => LAST,
        (Some(next), Some(pace)) => (next.time - frames[k].time) / pace,
        (Some(_), None) => STAY,
    });
    let shown: Vec<_> = pictures.into_iter().zip(stays).collect();
    Ok(Film {
        gif: film(&shown)?,
        frames: shown.len(),
        seconds: shown.iter().map(|(_, stay)| stay).sum(),
        pace,
    })
}

/// Frames of a motion that stay as long at a pace as a film can show: where they follow too fast some are left out.
fn at_pace<T>(frames: Vec<(Frame, T)>, pace: f64) -> Result<Vec<(Frame, T)>, ReportError> {
    let [shortest, longest] = STAYS;
    let gaps = frames.windows(2).map(|two| two[1].0.time - two[0].0.time);
    let widest = gaps.fold(0.0, f64::max);
    if widest > longest * pace {
        return Err(ReportError::NoFilm {
            why: format!(
                "at the pace {} a frame would stay for {} s, and a GIF holds one for {longest} s at most; --pace {} shows it",
                short(pace),
                short(widest / pace),
                short(1.1 * widest / longest)
            ),
        });
    }
    // Rounding of times is no reason to leave a frame out.
    let least = (1.0 - 1e-6) * shortest * pace;
    let last = frames.len() - 1;
    let (mut kept, mut before) = (Vec::new(), f64::NEG_INFINITY);
    for (k, frame) in frames.into_iter().enumerate() {
        let is_close = frame.0.time - before < least;
        if is_close && k == last && kept.len() > 1 {
            kept.pop();
        } else if is_close && k < last {
            continue;
        }
        before = frame.0.time;
        kept.push(frame);
    }
    Ok(kept)
}

/// The frames of a film, each with its step in words; none where its time is that of a motion.
fn chosen(folder: &Path, case: &Case<2>, stage: Option<usize>) -> Vec<(Frame, Option<String>)> {
    let moves = |&number: &usize| matches!(case.stages[number].kind, StageKind::Dynamic(_));
    let motion = stage.or_else(|| (0..case.stages.len()).rfind(moves));
    let mut frames: Vec<(Frame, Option<String>)> = if let Some(number) = motion.filter(moves) {
        let moving = pvd::motion(folder, number).into_iter();
        moving.map(|frame| (frame, None)).collect()
    } else {
        let all = pvd::frames(folder, pvd::PARTICLES).unwrap_or_default();
        let name = stage.map(|number| case.stages[number].name.as_str());
        let in_stage = |frame: &Frame| name.is_none_or(|name| frame.stage == name);
        let steps = whereabouts(&all, &case.stages).into_iter();
        let all = all.into_iter().zip(steps.map(|place| Some(place.when)));
        all.filter(|(frame, _)| in_stage(frame)).collect()
    };
    let count = frames.len();
    if count > MOST {
        let last = count - 1;
        let mut kept = (0..MOST).map(|k| k * last / (MOST - 1)).peekable();
        let mut place = 0;
        frames.retain(|_| {
            let is_kept = kept.next_if_eq(&place).is_some();
            place += 1;
            is_kept
        });
    }
    frames
}

/// The pace of a motion that takes so long: the fastest of some that can be followed.
fn pace_of(lasts: f64) -> f64 {
    let slow_enough = |pace: &f64| lasts / pace >= SHORTEST;
    let found = PACES.into_iter().find(slow_enough);
    found.unwrap_or(PACES[PACES.len() - 1])
}

/// The title of a frame.
fn label(frame: &Frame, step: Option<&str>, pace: Option<f64>) -> String {
    let Some(pace) = pace else {
        let step = step.map_or_else(String::new, |step| format!(", {step}"));
        return format!("{}{step}", frame.stage);
    };
    let slower = 1.0 / pace;
    let how = match slower {
        _ if (slower - 1.0).abs() < 1e-9 => "as fast as it was".to_owned(),
        _ if slower > 1.0 => format!("{} times slower", short(slower)),
        _ => format!("{} times faster", short(pace)),
    };
    format!("t = {:.3} s, {how}", frame.time)
}

/// Reads a frame.
fn scene(
    folder: &Path,
    Frame { file, stage, .. }: &Frame,
    (case, pieces): (&Case<2>, &Pieces),
    field: Field,
) -> Result<Scene, ReportError> {
    let path = folder.join(file);
    let text = fs::read_to_string(&path).map_err(|source| ResultsError::File {
        path: path.clone(),
        source,
    })?;
    let unread = || ReportError::NoFilm {
        why: format!("{} cannot be read as a frame in the plane", path.display()),
    };
    let frame = read::Frame::of(&text).ok_or_else(unread)?;
    let particles = FrameParticles::<2>::of(&frame).ok_or_else(unread)?;
    let half_length = |&number: &usize| pieces.half_length(number);
    let halves: Option<Vec<_>> = particles.number.iter().map(half_length).collect();
    let values = read_back::values(&frame, field).ok_or_else(|| ReportError::NoFilm {
        why: format!("its frames have no {}", field.name()),
    })?;
    let beside = |stem: &str, style| {
        let file = file.replace(pvd::PARTICLES, stem);
        lines(&folder.join(file), style)
    };
    let mut over = beside(pvd::RIGID, OutlineStyle::Block);
    over.extend(beside(pvd::REINFORCEMENT, OutlineStyle::Member));
    let places = particles.x.iter().map(|x| x[0]);
    let ends = places.fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(x), b.max(x)]);
    if let Some(number) = case.stages.iter().position(|other| other.name == *stage) {
        over.extend(water::tables_after(case, number, ends));
    }
    Ok(Scene {
        half_length0: halves.ok_or_else(unread)?,
        particles,
        values,
        over,
    })
}

/// The lines of structures in a frame, those that go on from one another joined; none where the file is not there.
fn lines(path: &Path, style: OutlineStyle) -> Vec<Outline> {
    let read = || {
        let text = fs::read_to_string(path).ok()?;
        read::Frame::of(&text)?.corners(2)
    };
    let corners = read().unwrap_or_default();
    let mut all: Vec<Outline> = Vec::new();
    for [from, to] in corners.as_chunks::<2>().0 {
        let [from, to] = [from, to].map(|point| [point[0], point[1]]);
        match all.last_mut() {
            Some(last) if last.points.last() == Some(&from) => last.points.push(to),
            _ => all.push(Outline {
                points: vec![from, to],
                style,
            }),
        }
    }
    all
}

/// Unit and colours of all frames.
struct Look {
    scale: Scale,
    colours: Colours,
    label: String,
}

impl Look {
    fn of(field: Field, scenes: &[Scene], case: &Case<2>) -> Self {
        let all: Vec<f64> = scenes
            .iter()
            .flat_map(|scene| scene.values.clone())
            .collect();
        let scale = Scale::of(field.dimension(), all.iter().copied());
        let colours = Colours::of(field, &scale.apply(&all));
        let shown = scale
            .apply(&all)
            .into_iter()
            .filter(|value| value.is_finite());
        let ends = shown.fold((f64::MAX, f64::MIN), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        let total = if case.has_pore_water() && field.is_total() {
            "total "
        } else {
            ""
        };
        Self {
            label: format!(
                "{total}{}{}",
                fields::label_in(axes_of(case), field, scale),
                colours.note()
            ),
            colours: Colours {
                range: colours
                    .range
                    .or(Some(ends).filter(|&(a, b)| a < b && AxisScale::Linear.accepts((a, b)))),
                ..colours
            },
            scale,
        }
    }
}

/// Data that all frames share.
struct Stage<'a> {
    case: &'a Case<2>,
    pieces: &'a Pieces,
    look: Look,
    window: [(f64, f64); 2],
}

impl Stage<'_> {
    /// The picture of a frame.
    fn draw(&self, label: &str, scene: &Scene) -> Result<Drawing, ReportError> {
        let carriers = scene.carriers();
        let (domains, whose) = self.pieces.now(carriers);
        let outlines = edges(self.case, self.pieces, carriers).into_iter();
        let look = &self.look;
        let plot = FieldPlot {
            title: titled(&self.case.title, label),
            domains,
            values: (whose.iter())
                .map(|&k| scene.values[k] / look.scale.divide_by)
                .collect(),
            label: look.label.clone(),
            range: look.colours.range,
            map: look.colours.map,
            outlines: outlines.chain(scene.over.iter().cloned()).collect(),
            x_range: Some(self.window[0]),
            y_range: Some(self.window[1]),
            ..FieldPlot::default()
        };
        Ok(plot.draw()?)
    }
}

impl Scene {
    fn carriers(&self) -> Carriers<'_> {
        Carriers {
            x: &self.particles.x,
            def_grad: &self.particles.def_grad,
            half_length0: &self.half_length0,
            number: &self.particles.number,
        }
    }
}

/// The part of the plane in which the bodies have been, with some room around.
fn window(pieces: &Pieces, scenes: &[Scene]) -> [(f64, f64); 2] {
    let edges = scenes
        .iter()
        .flat_map(|scene| pieces.edges(scene.carriers()));
    let points = edges.flatten();
    let start = [(f64::MAX, f64::MIN); 2];
    let ends = points.fold(start, |ends, point| {
        [0, 1].map(|axis| {
            let (low, high): (f64, f64) = ends[axis];
            (low.min(point[axis]), high.max(point[axis]))
        })
    });
    let room = ROOM
        * ends
            .iter()
            .fold(0.0, |most: f64, (low, high)| most.max(high - low));
    ends.map(|(low, high)| (low - room, high + room))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pace_is_the_fastest_that_can_be_followed() {
        let close = |lasts: f64, pace: f64| assert!((pace_of(lasts) - pace).abs() < 1e-12);
        close(10.0, 1.0);
        close(0.42, 0.1);
        close(0.41, 0.1);
        close(1e-3, 0.01);
    }

    /// GOAL: a film takes the time that it is said to take, at every pace. CASE: 101 frames, 0.1 s apart, ten times and 10000 times faster, and
    /// so slowly that a frame would stay for hours. ORACLE: no frame stays for less than 0.02 s or for more than 655.35 s.
    #[test]
    fn frames_stay_as_long_as_a_film_can_show() {
        let frames = || -> Vec<(Frame, ())> {
            let frame = |k: i32| Frame {
                time: 0.1 * f64::from(k),
                stage: "slide".to_owned(),
                file: String::new(),
            };
            (0..=100).map(|k| (frame(k), ())).collect()
        };
        let times = |pace: f64| -> Vec<f64> {
            let kept = at_pace(frames(), pace).unwrap().into_iter();
            kept.map(|frame| frame.0.time).collect()
        };
        assert_eq!(times(1.0).len(), 101);
        assert_eq!(times(5.0).len(), 101);
        for pace in [10.0, 30.0, 70.0] {
            let kept = times(pace);
            assert!(kept.windows(2).all(|two| two[1] - two[0] > 0.0199 * pace));
            assert!((kept[kept.len() - 1] - 10.0).abs() < 1e-9 && kept[0] < 1e-9);
        }
        assert_eq!(times(10.0).len(), 51);
        assert_eq!(times(1e4).len(), 2);
        let slow = at_pace(frames(), 1e-5).unwrap_err().to_string();
        assert!(slow.contains("a frame would stay for 1.000e4 s"), "{slow}");
        assert!(slow.contains("--pace 1.6"), "{slow}");
    }

    #[test]
    fn a_frame_says_its_time_and_how_fast_it_is_shown() {
        let frame = Frame {
            time: 0.125,
            stage: "slide".to_owned(),
            file: String::new(),
        };
        assert_eq!(
            label(&frame, None, Some(0.1)),
            "t = 0.125 s, 10 times slower"
        );
        assert_eq!(
            label(&frame, None, Some(1.0)),
            "t = 0.125 s, as fast as it was"
        );
        assert_eq!(
            label(&frame, None, Some(10.0)),
            "t = 0.125 s, 10 times faster"
        );
        assert_eq!(label(&frame, Some("step 7"), None), "slide, step 7");
    }
}
