//! Whether the ground can be wet as conditions of the water say.

use std::collections::HashMap;

use igimp_model::{
    BodyPart, Drainage, PoreSource, Profile, Raster, SeepageCase, Strength, WaterCondition,
};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::materials::MaterialCommon;
use igimp_schema::schema::stages::Stage;
use igimp_schema::schema::water::Water;
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::Node;
use igimp_schema::tree::read::At;

use super::Around;
use crate::build::Thing;
use crate::build::bodies::sequence::Scene;
use crate::build::ground::{Above, Earth, Surface, UprightFace};
use crate::build::materials::profiles::reach;
use igimp_model::Material;

/// Refuses tables that stand above the ground unmeant, and what water cannot do to materials; warns of conditions that
/// do nothing.
pub(crate) fn check<const D: usize>(
    around: &Around<'_, D>,
    conditions: &[Option<WaterCondition>],
    problems: &mut Problems,
) {
    let Around {
        earth, sequence, ..
    } = around;
    if !earth.is_complete() || conditions.is_empty() {
        return;
    }
    let mut checker = Checker {
        around,
        conditions,
        surfaces: HashMap::new(),
        seen: Vec::new(),
        refused: Vec::new(),
        unweighed: Vec::new(),
    };
    checker.scene(&sequence.start, None, problems);
    strengths(around, conditions, problems);
    for (index, end) in sequence.ends.iter().enumerate() {
        if end != sequence.before(index) {
            checker.scene(end, Some(index), problems);
        }
    }
    through_one_ground(around, conditions, problems);
    let mut called = around.stages.iter().flatten().filter_map(called_water);
    if called.any(|name| around.names.water.position(name).is_none()) {
        // A name that is not defined may be a slip for one that is not used.
        return;
    }
    for (index, water) in around.stated.iter().enumerate() {
        let is_used = sequence.scenes().any(|scene| scene.water == Some(index));
        if let Some(water) = water
            && !is_used
        {
            let name = clip(&water.name, 40);
            problems
                .warning(
                    water.name.place,
                    format!("no stage calls for the water `{name}`"),
                )
                .help("write water = \"NAME\" in a stage of type construction; the first condition holds from the start");
        }
    }
}

/// Refuses a second call for water that flows where other bodies are there: its flow is that through the ground of the first.
fn through_one_ground<const D: usize>(
    around: &Around<'_, D>,
    conditions: &[Option<WaterCondition>],
    problems: &mut Problems,
) {
    for (stage, scene) in around.sequence.ends.iter().enumerate() {
        let Some(called) = around.stages[stage].as_ref().and_then(called_water) else {
            continue;
        };
        let Some(index) = around.names.water.position(called) else {
            continue;
        };
        let source = conditions[index].as_ref().map(|water| &water.source);
        let first = around.sequence.first_with(index);
        let bodies_differ = first.present != scene.present;
        let is_drawn_down = around.stated[index]
            .as_ref()
            .is_some_and(|water| water.inside.is_some());
        let is_other = match source {
            Some(PoreSource::Seepage(_)) => {
                let soil = |of: &Scene| -> Vec<Option<usize>> {
                    let bodies = std::iter::zip(&of.present, &of.material);
                    bodies
                        .map(|(there, soil)| soil.filter(|_| *there))
                        .collect()
                };
                bodies_differ || soil(first) != soil(scene)
            }
            _ => is_drawn_down && bodies_differ,
        };
        if is_other {
            problems
                .error(
                    called.place,
                    format!(
                        "the water `{}` flows through the ground in which it is called first, and here the ground is another",
                        clip(called, 40)
                    ),
                )
                .help("give this ground a condition of its own in [[water]], with the same keys under another name");
        }
    }
}

/// Refuses strengths by the effective stress at rest where that is of water which flows: it is not known as the file is read.
fn strengths<const D: usize>(
    around: &Around<'_, D>,
    conditions: &[Option<WaterCondition>],
    problems: &mut Problems,
) {
    let (Some(Some(first)), Some(Some(stated))) = (conditions.first(), around.stated.first())
    else {
        return;
    };
    let by_stress = |soil: &&Material| matches!(&soil.profiles.strength, Some(Profile::StressShare(share)) if share.water_level.is_none());
    let mut materials = around.materials.iter().flatten().filter(by_stress);
    if let (PoreSource::Seepage(_), Some(material)) = (&first.source, materials.next()) {
        let (water, soil) = (clip(&stated.name, 40), clip(&material.name, 40));
        let text = format!(
            "the strength of `{soil}` goes with the effective stress, and the water `{water}` that counts for it flows"
        );
        problems.error(stated.name.place, text).help(
            "add water_level = \"5 m\" to the strength, or begin with a condition that has a level",
        );
    }
}

struct Checker<'a, const D: usize> {
    around: &'a Around<'a, D>,
    conditions: &'a [Option<WaterCondition>],
    surfaces: HashMap<Vec<bool>, Box<dyn Surface>>,
    /// Conditions that have been found wrong: of each one place is enough.
    seen: Vec<usize>,
    /// Materials whose friction by total stress was refused.
    refused: Vec<usize>,
    /// Materials reported as wet without a weight of full pores.
    unweighed: Vec<usize>,
}

impl<const D: usize> Checker<'_, D> {
    /// Checks what is there at the start, or at the end of a stage.
    fn scene(&mut self, scene: &Scene, stage: Option<usize>, problems: &mut Problems) {
        let around = self.around;
        let Some(index) = scene.water else { return };
        let Some(condition) = self.conditions.get(index).and_then(Option::as_ref) else {
            return;
        };
        if self.seen.contains(&index) || !scene.present.contains(&true) {
            return;
        }
        let Some(stated) = &around.stated[index] else {
            return;
        };
        let surface = (self.surfaces)
            .entry(scene.present.clone())
            .or_insert_with(|| around.surface(scene));
        let before = problems.errors();
        let label = format!("the water `{}`", clip(&condition.name, 40));
        let (place, when) = when(stage.map(|stage| &around.stages[stage]), stated);
        match &condition.source {
            PoreSource::Dry => {}
            PoreSource::Seepage(flow) => {
                self.permeable((scene, flow), (place, &label, &when), problems);
            }
            PoreSource::Points(raster) => points(
                raster,
                (around, scene, &**surface),
                (stated, &label, &when),
                problems,
            ),
            PoreSource::Table(_) | PoreSource::Surface(_) | PoreSource::Drained(_) => {
                let is_pond = stated.pond.as_ref().is_none_or(|pond| **pond);
                drawn(
                    (&condition.source, is_pond),
                    &**surface,
                    (place, &label, &when),
                    problems,
                );
            }
            PoreSource::Ratio(_) => {
                if let Some(face) = surface.upright_face() {
                    behind_face::<D>(&face, place, &when, problems);
                }
            }
        }
        let bodies = std::iter::zip(around.bodies, &scene.present);
        let mut there = bodies.filter_map(|(part, present)| part.as_ref().filter(|_| *present));
        let is_table = matches!(
            condition.source,
            PoreSource::Table(_) | PoreSource::Surface(_) | PoreSource::Drained(_)
        );
        if is_table && !there.any(|part| is_wet(around.earth, &condition.source, part)) {
            problems
                .warning(
                    place,
                    format!("{label} lies below all bodies, and wets none{when}"),
                )
                .help("write dry = true if that is meant");
        }
        self.materials(scene, condition, (stated, &label), problems);
        if problems.errors() > before {
            self.seen.push(index);
        }
    }

    /// Refuses bodies without a permeability where seepage is computed, and without storage where it is followed in time.
    fn permeable(
        &self,
        (scene, flow): (&Scene, &SeepageCase),
        (place, label, when): (Place, &str, &str),
        problems: &mut Problems,
    ) {
        let there = (0..scene.present.len()).filter(|&body| scene.present[body]);
        let mut materials: Vec<usize> = there.filter_map(|body| scene.material[body]).collect();
        materials.sort_unstable();
        materials.dedup();
        for number in materials {
            let material = self.around.materials[number].as_ref();
            if let Some(material) = material.filter(|soil| soil.permeability.is_none()) {
                problems
                    .error(
                        place,
                        format!(
                            "{label} flows through `{}`, which has no permeability{when}",
                            clip(&material.name, 40)
                        ),
                    )
                    .help("write permeability = \"1e-6 m/s\" in the material; clay 1e-9, silt 1e-7, sand 1e-4");
            }
            let yields = |soil: &Material| soil.permeability.is_none_or(|law| law.drainable > 0.0);
            let drains = flow.in_time.is_some() && !flow.conditions.confined;
            if let Some(material) = material.filter(|soil| drains && !yields(soil)) {
                problems
                    .error(
                        place,
                        format!(
                            "{label} changes in time, and nothing says how much water drains from `{}`{when}",
                            clip(&material.name, 40)
                        ),
                    )
                    .help("write permeability = { horizontal = \"1e-6 m/s\", drainable = 0.1 }; clay 0.03, silt 0.1, sand 0.25");
            }
        }
    }

    /// Checks what the condition does to the materials of the bodies that are there.
    fn materials(
        &mut self,
        scene: &Scene,
        condition: &WaterCondition,
        (stated, label): (&Water, &str),
        problems: &mut Problems,
    ) {
        let around = self.around;
        for (body, part) in around.bodies.iter().enumerate() {
            let Some(part) = part.as_ref().filter(|_| scene.present[body]) else {
                continue;
            };
            let material =
                scene.material[body].and_then(|k| Some((k, around.materials[k].as_ref()?)));
            let Some((number, material)) = material else {
                continue;
            };
            let is_below_table = matches!(
                condition.source,
                PoreSource::Table(_)
                    | PoreSource::Surface(_)
                    | PoreSource::Drained(_)
                    | PoreSource::Seepage(_)
            ) && condition.bodies.iter().all(|(named, _)| *named != body);
            if is_below_table
                && material.saturated.is_none()
                && material.unit_weight > 0.0
                && !self.unweighed.contains(&number)
                && is_wet(around.earth, &condition.source, part)
            {
                self.unweighed.push(number);
                unweighed::<D>(around.tree, number, (label, material), problems);
            }
            if material.drainage != Drainage::Total {
                continue;
            }
            let row = condition
                .bodies
                .iter()
                .position(|(named, _)| *named == body);
            if let Some(row) = row
                && condition.bodies[row].1 != PoreSource::Dry
            {
                problems
                    .error(
                        (stated.bodies[row].as_ref().ok()).map(|at| at.place),
                        format!(
                            "{label} gives `{}` a pore pressure of its own, but `{}` has strength by total stress, where there is none",
                            clip(&part.name, 40),
                            clip(&material.name, 40)
                        ),
                    )
                    .help("write dry = true there, or drainage = \"drained\" or \"undrained\" in the material, with strength by effective stress");
                continue;
            }
            let has_friction = matches!(
                material.strength,
                Strength::MohrCoulomb { friction_angle, .. }
                | Strength::DruckerPrager { friction_angle, .. } if friction_angle > 0.0
            );
            let is_wet = || row.is_none() && is_wet(around.earth, &condition.source, part);
            if has_friction && !self.refused.contains(&number) && is_wet() {
                self.refused.push(number);
                let place = common::<D>(around.tree, number, |keys| {
                    keys.drainage.as_ref().ok()?.as_ref().map(|at| at.place)
                });
                problems
                    .error(
                        place,
                        format!(
                            "{label} wets `{}`, and `{}` has friction by total stress: the water would make it stronger",
                            clip(&part.name, 40),
                            clip(&material.name, 40)
                        ),
                    )
                    .help("friction goes with effective stress: drainage = \"drained\", or \"undrained\" where water cannot leave")
                    .help("for undrained strength by total stress use model = \"tresca\" with cu");
            }
        }
    }
}

/// Refuses a drawn surface that ends above the ground, or stands above it where no pond is meant or not level.
fn drawn(
    (source, is_pond): (&PoreSource, bool),
    surface: &dyn Surface,
    (place, label, when): (Place, &str, &str),
    problems: &mut Problems,
) {
    let [highest, sloping] = surface.above(source);
    if let Some(at) = surface.uncovered(source) {
        problems
            .error(
                place,
                format!("the surface of {label} does not reach the ground at {at}{when}"),
            )
            .help("take a survey that reaches over all bodies, and has no holes there");
    } else if let Some(above) = highest.filter(|_| !is_pond) {
        above_ground(&above, place, (label, when), problems);
    } else if let Some(above) = sloping {
        problems
            .error(
                place,
                format!(
                    "{label} is not level where it stands above the ground{when}: {} m above it at {}",
                    number(above.by),
                    above.at
                ),
            )
            .help("a pond is level: let the line meet the ground before it goes up or down");
    }
}

/// Refuses a share of the overburden as pressure behind an upright face.
fn behind_face<const D: usize>(
    face: &UprightFace,
    place: Place,
    when: &str,
    problems: &mut Problems,
) {
    let UprightFace { at, levels } = face;
    let up = if D == 2 { "y" } else { "z" };
    problems
        .error(
            place,
            format!(
                "r_u puts pressure behind the upright face at {at}, from {up} = {} m to {} m{when}",
                number(levels[0]),
                number(levels[1])
            ),
        )
        .help(
            "nothing would hold the water there: slope the face, or draw the table as line = [...]",
        );
}

/// Where something is said that every material has.
fn common<const D: usize>(
    tree: &Node,
    number: usize,
    place: impl Fn(&MaterialCommon) -> Option<Place>,
) -> Option<Place> {
    let materials = Root::<D>::materials(tree).ok()?;
    let material = materials.0.get(number)?.value.as_ref().ok()?;
    place(material.common.as_ref().ok()?)
}

/// Says that soil weighs the same above and below the water table.
fn unweighed<const D: usize>(
    tree: &Node,
    number: usize,
    (label, material): (&str, &Material),
    problems: &mut Problems,
) {
    let place = common::<D>(tree, number, |keys| {
        keys.unit_weight.as_ref().ok().map(|at| at.place)
    });
    problems
        .warning(
            place,
            format!(
                "{label} wets `{}`, which weighs below the table what it weighs above",
                clip(&material.name, 40)
            ),
        )
        .help("saturated_unit_weight is the weight of soil and water together: mostly 1 to 3 kN/m3 more")
        .help("write it with the value of unit_weight if that is meant");
}

/// Share of the greatest pressure on the ground that is reported \[-\].
const ON_GROUND: f64 = 0.02;

/// Refuses points that do not reach over the soil; warns of pressure on the ground that is not said to be free water.
fn points<const D: usize>(
    raster: &Raster,
    (around, scene, surface): (&Around<'_, D>, &Scene, &dyn Surface),
    (stated, label, when): (&Water, &str, &str),
    problems: &mut Problems,
) {
    let Some(points) = &stated.pressures.u else {
        return;
    };
    let parts = std::iter::zip(around.bodies, &scene.present);
    let there = parts.filter_map(|(part, present)| part.as_ref().filter(|_| *present));
    let outlines: Vec<_> = there.map(|part| around.earth.front_outline(part)).collect();
    let polygons: Vec<&[[f64; 2]]> = outlines.iter().map(|outline| &outline[..]).collect();
    let of = format!("the soil that {label} is for{when}");
    if reach(raster, (points.place, "u"), (&polygons, &of), problems).is_err() {
        return;
    }
    let greatest = raster.values.iter().flatten().copied().fold(0.0, f64::max);
    let most = surface.most_on_ground(raster);
    let is_meant = stated.pond.as_ref().is_some_and(|pond| **pond);
    if let Some((at, pressure)) =
        most.filter(|(_, pressure)| !is_meant && *pressure > ON_GROUND * greatest)
    {
        problems
            .warning(
                points.place,
                format!(
                    "{label} presses on the ground with {} kPa at {at}{when}, as free water would",
                    number((pressure / 1e2).round() / 1e1)
                ),
            )
            .help("write pond = true if free water stands there; else let the points have no pressure on the ground");
    }
}

/// The place of an error in a condition, and its time.
fn when(stage: Option<&Thing<Stage>>, water: &At<Water>) -> (Place, String) {
    let stated = [
        water.tables.line.as_ref().map(|at| at.place),
        water.tables.level.as_ref().map(|at| at.place),
        water.tables.surface.as_ref().map(|at| at.place),
        water.inside.as_ref().map(|at| at.place),
        water.pressures.r_u.as_ref().map(|at| at.place),
        water.pressures.u.as_ref().map(|at| at.place),
        water.seepage.as_ref().map(|at| at.place),
    ];
    let place = stated.into_iter().flatten().next().unwrap_or(water.place);
    let Some(Some(stage)) = stage else {
        return (place, String::new());
    };
    let name = clip(&stage.name, 40);
    if called_water(stage).is_some() {
        return (place, format!(" in stage `{name}`"));
    }
    let changed = stage.construction().into_iter();
    let changed = changed.flat_map(|job| [&job.remove, &job.place]).flatten();
    let mut changed = changed
        .filter(|list| !list.is_empty())
        .map(|list| list.place);
    (
        changed.next().unwrap_or(stage.name.place),
        format!(" after stage `{name}`"),
    )
}

/// The condition of the water that a stage calls for.
fn called_water(stage: &At<Stage>) -> Option<&At<String>> {
    stage.construction()?.water_condition()
}

fn above_ground(above: &Above, place: Place, (label, when): (&str, &str), problems: &mut Problems) {
    problems
        .error(
            place,
            format!(
                "{label} stands {} m above the ground at {}{when}",
                number(above.by),
                above.at
            ),
        )
        .help("a line above the ground presses on it as a pond does: draw it along the surface there, or below")
        .help("write pond = true if free water stands there");
}

/// Whether there is pressure in a body.
fn is_wet<const D: usize>(earth: &dyn Earth<D>, source: &PoreSource, part: &BodyPart<D>) -> bool {
    match source {
        PoreSource::Dry => false,
        PoreSource::Ratio(ratio) => *ratio > 0.0,
        PoreSource::Seepage(_) => true,
        PoreSource::Points(_)
        | PoreSource::Table(_)
        | PoreSource::Surface(_)
        | PoreSource::Drained(_) => earth.wets(source, part),
    }
}
