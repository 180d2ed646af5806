//! The context of a stage: all that is built before the stages.

use igimp_model::{BodyPart, Load, Material};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::stages::Stage;
use igimp_schema::tree::read::At;
use igimp_schema::tree::{Node, Wrong};

use crate::build::Thing;
use crate::build::bodies::sequence::Sequence;
use crate::build::bodies::site::Soil;
use crate::build::{AllNames, Site};

/// The parts that stages name.
pub(crate) struct Context<'a, const D: usize> {
    pub(crate) tree: &'a Node,
    /// The stages as they are stated.
    pub(crate) stages: &'a [Thing<Stage>],
    pub(crate) names: &'a AllNames,
    pub(crate) materials: &'a [Option<Material>],
    pub(crate) bodies: &'a [Option<BodyPart<D>>],
    pub(crate) loads: &'a [Option<Load<D>>],
    pub(crate) soil: &'a dyn Soil<D>,
    /// The ground of the plane; none in space.
    pub(crate) site: Option<&'a Site>,
    pub(crate) sequence: &'a Sequence,
}

impl<const D: usize> Context<'_, D> {
    /// The stages that a stage follows, from the one that it starts from.
    pub(crate) fn before(&self, index: usize) -> impl Iterator<Item = &At<Stage>> {
        let before = move |index: usize| {
            let named = self
                .stages
                .get(index)?
                .as_ref()
                .and_then(|stage| stage.start_from());
            let named = named.and_then(|name| self.names.stages.position(name));
            named.filter(|&k| k < index).or(index.checked_sub(1))
        };
        let all = std::iter::successors(before(index), move |&index| before(index));
        all.filter_map(|index| self.stages.get(index)?.as_ref())
    }

    /// Index of the monitor that a key names, if it names one.
    pub(crate) fn monitor(
        &self,
        monitor: Option<&At<String>>,
        stage: &str,
        problems: &mut Problems,
    ) -> Result<Option<usize>, Wrong> {
        let monitors = &self.names.monitors;
        monitors.find_optional(monitor, &format!("stage `{stage}` watches"), problems)
    }

    /// Whether a material is that of a body.
    pub(crate) fn is_used(&self, material: usize) -> bool {
        let mut scenes = self.sequence.scenes();
        scenes.any(|scene| {
            scene
                .material
                .iter()
                .any(|entry| entry.is_none_or(|index| index == material))
        })
    }
}

/// A stage among the others.
pub(crate) struct About<'a, const D: usize> {
    pub(crate) context: &'a Context<'a, D>,
    pub(crate) index: usize,
    pub(crate) stage: &'a At<Stage>,
    /// Its name, for messages.
    pub(crate) name: &'a str,
}
