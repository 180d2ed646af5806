//! Soil whose law has to know the stresses that it begins with.

use igimp_model::Strength;
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::stages::StageForm;
use igimp_schema::text::clip;

use crate::build::bodies::sequence::Scene;
use crate::build::context::About;

/// Refuses modified Cam-clay that does not begin at rest under its weight: by the first stage, and of all bodies that are placed.
/// Soil that comes to be of it later begins with the stresses that it has.
pub(super) fn check<const D: usize>(about: &About<'_, D>, problems: &mut Problems) {
    let (context, place) = (about.context, about.stage.form.place);
    let start = &context.sequence.start;
    let starts_at_rest = matches!(&*about.stage.form, StageForm::K0(_));
    for (index, material) in context.materials.iter().enumerate() {
        let Some(material) = material else { continue };
        if !matches!(material.strength, Strength::ModifiedCamClay(_)) {
            continue;
        }
        let bodies = start.present.len();
        let is_in =
            |scene: &Scene, body: usize| scene.present[body] && scene.material[body] == Some(index);
        let at_start = |body: usize| is_in(start, body);
        // Soil that comes to be of it where it lies has its stresses, of which a body that is placed has none.
        let stages = 0..context.stages.len();
        let is_placed = |(stage, body): (usize, usize)| {
            let [before, after] = [
                context.sequence.before(stage),
                &context.sequence.ends[stage],
            ];
            !before.present[body] && is_in(after, body)
        };
        let mut built = stages.flat_map(|stage| (0..bodies).map(move |body| (stage, body)));
        let later = built.any(is_placed);
        let name = clip(&material.name, 40);
        if (0..bodies).any(at_start) && !starts_at_rest {
            problems
                .error(
                    place,
                    format!("`{name}` is modified Cam-clay, whose first stage has to be of type k0"),
                )
                .help("its stiffness and its preconsolidation follow from the stresses that it begins with");
        }
        if later {
            problems
                .error(
                    place,
                    format!("`{name}` is modified Cam-clay and is placed by a later stage, without stresses to begin with"),
                )
                .help("give soil that is placed another model, like \"mohr-coulomb\"");
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::CaseFile;
    use crate::shipped::find;

    /// GOAL: clay that remembers begins at rest, is placed by no later stage, and is not reduced; the words say why.
    #[test]
    fn clay_that_cannot_begin_is_refused() {
        let text = find("soft_clay_fill").unwrap().text;
        let refused = |text: &str, words: &str| {
            let error = CaseFile::parse("clay.toml", text, &[])
                .unwrap_err()
                .to_string();
            assert!(error.contains(words), "{error}");
        };
        let gravity = text.replace("type = \"k0\" ", "type = \"gravity\" ");
        refused(
            &gravity,
            "`clay` is modified Cam-clay, whose first stage has to be of type k0",
        );
        let search = "[[stages]]\nname = \"safe\"\ntype = \"strength-reduction\"\n";
        refused(
            &format!("{text}\n{search}"),
            "the material `clay` is modified Cam-clay: its strength is a result of the path",
        );
        let list = CaseFile::parse("clay.toml", &format!("{text}\n{search}"), &[]).unwrap_err();
        let stage = "| type = \"strength-reduction\"";
        assert!(list.to_string().contains(stage), "{list}");
        let others = format!("{text}\n{search}materials = [\"sand\"]\n");
        CaseFile::parse("clay.toml", &others, &[]).unwrap();
        let jaky = text.replace("k0 = 0.70835", "k0 = \"jaky\"");
        let file = CaseFile::parse("clay.toml", &jaky, &[]).unwrap();
        // sin φ = 3 M/(6 + M) = 3/7.
        let k0 = file.case().materials[1].k0.unwrap();
        assert!((k0 - 4.0 / 7.0).abs() < 1e-12, "{k0}");
    }
}
