//! Keys of materials that a case states and nothing of it asks for.

use igimp_model::{Case, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::text::clip;
use igimp_schema::tree::Node;

/// Warns of `k0` without a stage that begins at rest, and of `saturated_unit_weight` without water.
pub(crate) fn check_unused<const D: usize>(tree: &Node, case: &Case<D>, problems: &mut Problems) {
    let is_k0 = |kind: &StageKind| matches!(kind, StageKind::K0);
    let begins_at_rest = case.stages.iter().any(|stage| is_k0(&stage.kind));
    let Ok(materials) = Root::<D>::materials(tree) else {
        return;
    };
    for material in &materials.0 {
        let Ok(Ok(common)) = material.value.as_ref().map(|own| own.common.as_ref()) else {
            continue;
        };
        let name = clip(&material.name, 40);
        if let (false, Ok(Some(own))) = (begins_at_rest, &common.k0) {
            let message = format!("`k0` of `{name}` has no effect: no stage is of type k0");
            problems
                .warning(own.place, message)
                .help("type = \"k0\" in place of a first stage of gravity, or remove it");
        }
        if let (true, Ok(Some(own))) = (case.water.is_empty(), &common.saturated_unit_weight) {
            let message = format!(
                "`saturated_unit_weight` of `{name}` has no effect: there is no water in this case"
            );
            problems
                .warning(own.place, message)
                .help("add [[water]] with a level, or remove it");
        }
    }
}
