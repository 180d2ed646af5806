//! Which bodies are there at the end of every stage, of what, and which water: what construction stages lead to.
//!
//! A wrong name in a stage changes nothing here; it is reported where the stage is built.

use std::rc::Rc;

use igimp_model::BodyPart;
use igimp_schema::schema::bodies::Body;
use igimp_schema::schema::stages::{Construction, Stage};

use crate::build::AllNames;
use crate::build::Thing;

/// Bodies, materials and water at a time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Scene {
    /// By body.
    pub(crate) present: Vec<bool>,
    /// By body, as far as it is known.
    pub(crate) material: Vec<Option<usize>>,
    /// Condition of the water; none: there is no water.
    pub(crate) water: Option<usize>,
}

impl Scene {
    /// Changes it as a stage of construction does.
    fn build(&mut self, stage: &Construction, names: &AllNames) {
        for (list, is_there) in [(stage.placed(), true), (stage.removed(), false)] {
            for body in list.iter().filter_map(|name| names.bodies.position(name)) {
                self.present[body] = is_there;
            }
        }
        for change in stage.changes().iter().flatten() {
            let body = names.bodies.position(&change.body);
            let material = names.materials.position(&change.material);
            if let (Some(body), Some(material)) = (body, material) {
                self.material[body] = Some(material);
            }
        }
        let water = stage.water_condition();
        let water = water.and_then(|name| names.water.position(name));
        self.water = water.or(self.water);
    }
}

/// The scenes of a case.
#[derive(Debug)]
pub(crate) struct Sequence {
    /// Before the first stage.
    pub(crate) start: Rc<Scene>,
    /// At the end of each stage.
    pub(crate) ends: Vec<Rc<Scene>>,
    /// The stage that each starts from; none: from the start.
    from: Vec<Option<usize>>,
}

impl Sequence {
    pub(crate) fn new<const D: usize>(
        (tables, stages): (&[Thing<Body>], &[Thing<Stage>]),
        has_water: bool,
        names: &AllNames,
        bodies: &[Option<BodyPart<D>>],
    ) -> Self {
        let later = placed(stages);
        let is_there = |table: &Thing<Body>| {
            (table.as_ref()).is_none_or(|body| !later.contains(&body.name.as_str()))
        };
        let start = Scene {
            present: tables.iter().map(is_there).collect(),
            material: bodies
                .iter()
                .map(|body| body.as_ref().map(|body| body.material))
                .collect(),
            water: has_water.then_some(0),
        };
        let mut sequence = Self {
            start: Rc::new(start),
            ends: Vec::new(),
            from: Vec::new(),
        };
        for (index, stage) in stages.iter().enumerate() {
            let stated = stage.as_ref().and_then(|stage| stage.start_from());
            let from = stated.and_then(|name| names.stages.position(name));
            let from = from.filter(|from| *from < index);
            let before = from.map_or(&sequence.start, |from| &sequence.ends[from]);
            let mut shared = Rc::clone(before);
            if let Some(construction) = stage.as_ref().and_then(|stage| stage.construction()) {
                Rc::make_mut(&mut shared).build(construction, names);
            }
            sequence.ends.push(shared);
            sequence.from.push(from);
        }
        sequence
    }

    /// The scene that a stage starts from.
    pub(crate) fn before(&self, stage: usize) -> &Rc<Scene> {
        self.from[stage].map_or(&self.start, |from| &self.ends[from])
    }

    /// The stage that a stage starts from; none: from the start.
    pub(crate) fn from(&self, stage: usize) -> Option<usize> {
        self.from[stage]
    }

    /// All scenes.
    pub(crate) fn scenes(&self) -> impl Iterator<Item = &Scene> {
        let all = std::iter::once(&self.start).chain(&self.ends);
        all.map(|scene| &**scene)
    }

    /// Whether two bodies are there at the same time.
    pub(crate) fn are_together(&self, a: usize, b: usize) -> bool {
        self.scenes()
            .any(|scene| scene.present[a] && scene.present[b])
    }

    /// The scene when a condition of the water is first in force; at the start if it never is.
    pub(crate) fn first_with(&self, water: usize) -> &Scene {
        let mut scenes = self.scenes();
        scenes
            .find(|scene| scene.water == Some(water))
            .unwrap_or(&self.start)
    }
}

/// Names of the bodies that construction stages place.
pub(crate) fn placed(stages: &[Thing<Stage>]) -> Vec<&str> {
    let stages = stages.iter().flatten();
    stages
        .filter_map(|stage| stage.construction())
        .flat_map(Construction::placed)
        .map(|name| name.as_str())
        .collect()
}
