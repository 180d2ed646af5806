//! Which bodies are there at the end of every stage, of what, and which water: what construction stages lead to.
//!
//! What a stage names wrongly changes nothing here; it is reported where the stage is built.

use std::rc::Rc;

use igimp_model::BodyPart;
use igimp_schema::tree::Node;

use crate::build::AllNames;

/// What is there at a time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Scene {
    /// By body.
    pub(crate) present: Vec<bool>,
    /// By body, as far as it is known.
    pub(crate) material: Vec<Option<usize>>,
    /// Condition of the water; none: there is no water.
    pub(crate) water: Option<usize>,
}

/// The scenes of a case.
#[derive(Debug)]
pub(crate) struct Sequence {
    /// Before the first stage.
    pub(crate) start: Rc<Scene>,
    /// At the end of each stage.
    pub(crate) ends: Vec<Rc<Scene>>,
    /// What each stage starts from; none: from the start.
    from: Vec<Option<usize>>,
}

impl Sequence {
    pub(crate) fn new<const D: usize>(
        tree: &Node,
        names: &AllNames,
        bodies: &[Option<BodyPart<D>>],
    ) -> Self {
        let later = placed(tree);
        let items = tree.items_at("bodies").iter();
        let is_there = |node: &Node| {
            node.text_at("name")
                .is_none_or(|name| !later.contains(&name))
        };
        let start = Scene {
            present: items.map(is_there).collect(),
            material: bodies
                .iter()
                .map(|body| body.as_ref().map(|body| body.material))
                .collect(),
            water: (!tree.items_at("water").is_empty()).then_some(0),
        };
        let mut sequence = Self {
            start: Rc::new(start),
            ends: Vec::new(),
            from: Vec::new(),
        };
        for (index, node) in tree.items_at("stages").iter().enumerate() {
            let stated = node.text_at("start_from");
            let from = stated.and_then(|name| names.stages.position(name));
            let from = from.filter(|from| *from < index);
            let before = from.map_or(&sequence.start, |from| &sequence.ends[from]);
            let mut shared = Rc::clone(before);
            if node.text_at("type") == Some("construction") {
                let scene = Rc::make_mut(&mut shared);
                for (key, is_there) in [("place", true), ("remove", false)] {
                    let named = node.items_at(key).iter().filter_map(Node::text);
                    for body in named.filter_map(|name| names.bodies.position(name)) {
                        scene.present[body] = is_there;
                    }
                }
                for change in node.items_at("materials") {
                    let body = change.text_at("body");
                    let body = body.and_then(|name| names.bodies.position(name));
                    let material = change.text_at("material");
                    let material = material.and_then(|name| names.materials.position(name));
                    if let (Some(body), Some(material)) = (body, material) {
                        scene.material[body] = Some(material);
                    }
                }
                let water = node.text_at("water");
                let water = water.and_then(|name| names.water.position(name));
                scene.water = water.or(scene.water);
            }
            sequence.ends.push(shared);
            sequence.from.push(from);
        }
        sequence
    }

    /// What a stage starts from.
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

    /// What is there when a condition of the water is first in force; at the start if it never is.
    pub(crate) fn first_with(&self, water: usize) -> &Scene {
        let mut scenes = self.scenes();
        scenes
            .find(|scene| scene.water == Some(water))
            .unwrap_or(&self.start)
    }
}

/// Names of the bodies that construction stages place.
pub(crate) fn placed(tree: &Node) -> Vec<&str> {
    let stages = tree.items_at("stages").iter();
    stages
        .filter(|stage| stage.text_at("type") == Some("construction"))
        .flat_map(|stage| stage.items_at("place"))
        .filter_map(Node::text)
        .collect()
}
