//! Bodies that come to another material: memory that the new law lacks.

use igimp_material::InternalVariable;
use igimp_model::{Case, Material, ParameterValue, Profile, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::stages::Construction;
use igimp_schema::text::clip;
use igimp_schema::tree::Node;

use crate::build::things;

/// Warns of internal variables that a new law of soil does not keep. Warns too of a ratio of overconsolidation that soil with a
/// preconsolidation pressure does not take over.
pub(crate) fn check<const D: usize>(tree: &Node, case: &Case<D>, problems: &mut Problems) {
    let cell = case.grid.largest_cell()[D - 1];
    let stated = things(Root::<D>::stages(tree));
    for (stage, stated) in std::iter::zip(&case.stages, stated) {
        let (StageKind::Construction(kind), Some(stated)) = (&stage.kind, stated) else {
            continue;
        };
        let Some(changes) = stated.construction().map(Construction::changes) else {
            continue;
        };
        for (change, &(body, material)) in std::iter::zip(changes.iter().flatten(), &kind.materials)
        {
            if kind.place.contains(&body) {
                continue;
            }
            let before = &case.materials[case.material_after(stage.start_from, body)];
            let after = &case.materials[material];
            let shown = clip(&case.bodies[body].name, 40);
            let [from, to] = [before, after].map(|soil| clip(&soil.name, 40));
            let lost = forgotten((before, after), cell);
            if !lost.is_empty() {
                let are = if lost.len() == 1 { "is" } else { "are" };
                let message = format!(
                    "stage `{}` makes `{shown}` of `{to}`: {} that it has by `{from}` {are} lost",
                    clip(&stage.name, 40),
                    lost.join(" and "),
                );
                problems
                    .warning(change.material.place, message)
                    .help("that is right of soil that is taken out or treated; a material of the same model keeps what soil remembers");
            }
            if let (Some(stayed), Some(stated)) = (ocr_of(before), ocr_of(after))
                && stayed != stated
            {
                let message = format!(
                    "`ocr` of `{to}` has no effect on `{shown}`, which keeps its preconsolidation pressure"
                );
                problems
                    .warning(change.material.place, message)
                    .help("ocr is of soil that a stage of type k0 begins with, or that is placed");
            }
        }
    }
}

/// Internal variables of the law of one material that another does not keep.
fn forgotten((before, after): (&Material, &Material), cell: f64) -> Vec<String> {
    let (Ok(before), Ok(after)) = (before.law_on(cell), after.law_on(cell)) else {
        return Vec::new();
    };
    let is_kept = |variable: &InternalVariable| {
        let mut known = after.internal_variables().iter();
        variable.follows_stress || known.any(|other| variable.is_remembered_as(other))
    };
    (before.internal_variables().iter())
        .filter(|variable| !is_kept(variable))
        .map(|variable| format!("the {}", variable.name))
        .collect()
}

/// The ratio of overconsolidation of a law that has one, and how it varies.
fn ocr_of(material: &Material) -> Option<(ParameterValue, Option<&Profile>)> {
    let ocr = (material.strength.parameters().into_iter()).find(|entry| entry.key == "ocr")?;
    Some((ocr.value, material.profiles.of_parameter("ocr")))
}
