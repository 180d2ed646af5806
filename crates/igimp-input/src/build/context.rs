//! What a stage is built from: everything that is there before the stages.

use igimp_model::{BodyPart, Load, Material};
use igimp_schema::diagnostic::Problems;
use igimp_schema::names::Mention;
use igimp_schema::tree::{Node, Wrong};

use crate::build::bodies::sequence::Sequence;
use crate::build::bodies::site::Soil;
use crate::build::{AllNames, Site};

/// What stages refer to.
pub(crate) struct Context<'a, const D: usize> {
    pub(crate) tree: &'a Node,
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
    pub(crate) fn before(&self, index: usize) -> impl Iterator<Item = &Node> {
        let before = move |index: usize| {
            let named = self.stage_nodes().get(index)?.text_at("start_from");
            let named = named.and_then(|name| self.names.stages.position(name));
            named.filter(|&k| k < index).or(index.checked_sub(1))
        };
        let all = std::iter::successors(before(index), move |&index| before(index));
        all.filter_map(|index| self.stage_nodes().get(index))
    }

    pub(crate) fn stage_nodes(&self) -> &[Node] {
        self.tree.items_at("stages")
    }

    /// Type of a stage.
    pub(crate) fn type_of(&self, index: usize) -> Option<&str> {
        self.stage_nodes().get(index)?.text_at("type")
    }

    /// Index of the monitor that a key names, if it names one.
    pub(crate) fn monitor(
        &self,
        monitor: Option<&impl Mention>,
        who: &str,
        problems: &mut Problems,
    ) -> Result<Option<usize>, Wrong> {
        let who = format!("stage `{who}` watches");
        self.names.monitors.find_optional(monitor, &who, problems)
    }

    /// Whether a material is that of a body.
    pub(crate) fn is_used(&self, material: usize) -> bool {
        let mut scenes = self.sequence.scenes();
        scenes.any(|scene| {
            scene
                .material
                .iter()
                .any(|own| own.is_none_or(|own| own == material))
        })
    }
}
