//! Keys of materials that a case states and nothing of it asks for.

use std::iter::once;

use igimp_model::{Case, Material, PoreSource, Profile, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::text::clip;
use igimp_schema::tree::Node;

/// Warns of `k0` without a stage that begins at rest, and of `saturated_unit_weight` without a table of water that would saturate
/// soil: one of a condition, or the level that a strength by stress states.
pub(crate) fn check_unused<const D: usize>(tree: &Node, case: &Case<D>, problems: &mut Problems) {
    let is_k0 = |kind: &StageKind| matches!(kind, StageKind::K0);
    let begins_at_rest = case.stages.iter().any(|stage| is_k0(&stage.kind));
    let saturates = |source: &PoreSource| {
        !matches!(
            source,
            PoreSource::Dry | PoreSource::Ratio(_) | PoreSource::Points(_)
        )
    };
    let mut sources = (case.water.iter())
        .flat_map(|water| once(&water.source).chain(water.bodies.iter().map(|body| &body.1)));
    let has_level = |soil: &Material| match &soil.profiles.strength {
        Some(Profile::StressShare(share)) => share.water_level.is_some(),
        _ => false,
    };
    let saturates_none = !sources.any(saturates) && !case.materials.iter().any(has_level);
    let Ok(materials) = Root::<D>::materials(tree) else {
        return;
    };
    for material in &materials.0 {
        let Ok(Ok(common)) = material.value.as_ref().map(|table| table.common.as_ref()) else {
            continue;
        };
        let name = clip(&material.name, 40);
        if let (false, Ok(Some(k0))) = (begins_at_rest, &common.k0) {
            let message = format!("`k0` of `{name}` has no effect: no stage is of type k0");
            problems
                .warning(k0.place, message)
                .help("type = \"k0\" in place of a first stage of gravity, or remove it");
        }
        if let (true, Ok(Some(weight))) = (saturates_none, &common.saturated_unit_weight) {
            let why = if case.water.is_empty() {
                "there is no water in this case"
            } else {
                "no water of this case has a table below which soil is saturated"
            };
            let message = format!("`saturated_unit_weight` of `{name}` has no effect: {why}");
            problems
                .warning(weight.place, message)
                .help("add [[water]] with a level, or remove it");
        }
    }
}
