//! GOAL: numbers that the page of cases tells as computed are those of the program, within the digits told.
//! ORACLE: the page. The cases are run whole, and are those that take a moment; the page names the others.

use std::fs;
use std::path::Path;

use igimp_input::shipped::SHIPPED;

use crate::{Ran, ran, ran_in_space};

fn page() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/cases.md");
    fs::read_to_string(path).unwrap()
}

/// Numbers of a text, and half the last digit of each.
fn numbers(text: &str) -> Vec<(f64, f64)> {
    let words = text.split([' ', ',', ';']);
    let number = |word: &str| {
        let value: f64 = word.parse().ok()?;
        let decimals = word.split_once('.').map_or(0, |(_, after)| after.len());
        Some((value, 0.5 * 10_f64.powi(-(decimals as i32))))
    };
    words.filter_map(number).collect()
}

/// Holds the computed numbers in the row of a case.
fn hold(name: &str, found: &[f64]) {
    let begin = format!("| [`{name}`]");
    let page = page();
    let row = page.lines().find(|line| line.starts_with(&begin)).unwrap();
    let printed = numbers(row.split('|').nth(4).unwrap());
    assert_eq!(printed.len(), found.len(), "{name}: {row}");
    for (&(value, half), found) in std::iter::zip(&printed, found) {
        assert!(
            (found - value).abs() <= half * (1.0 + 1e-9),
            "{name}: {value} on the page, {found} computed"
        );
    }
}

impl<const D: usize> Ran<D> {
    /// Largest displacement at the end \[m\].
    fn displaced(&self) -> f64 {
        self.run.summary.stages.last().unwrap().largest_displacement
    }

    /// Time in motion of the last stage \[s\].
    fn rested(&self) -> f64 {
        let last = self.run.summary.stages.last().unwrap();
        last.energy.as_ref().unwrap().time
    }

    /// No number, of a case that meets all that is exact.
    fn exact(&self) -> [f64; 0] {
        assert!(self.meets_its_checks());
        []
    }

    /// Largest ordinate of a curve.
    fn deepest(&self, curve: &str) -> f64 {
        let points = self.curve(curve).into_iter();
        points.map(|point| point[1]).fold(f64::NAN, f64::max)
    }

    /// Slide of a rigid block on the ground that was shaken \[m\].
    fn slid(&self) -> f64 {
        let stages = self.run.summary.stages.iter();
        let mut blocks = stages.rev().filter_map(|stage| stage.newmark.as_ref());
        blocks.next().unwrap().displacement
    }
}

/// A test each, so that they run side by side.
macro_rules! held {
    ($($name:ident, $run:ident, $case:ident: $found:expr;)*) => {
        const HELD: &[&str] = &[$(stringify!($name)),*];
        $(#[test]
        fn $name() {
            let $case = $run(stringify!($name), &[]);
            hold(stringify!($name), &$found);
        })*
    };
}

held! {
    column, ran, case: [case.measured("height over initial height")];
    von_mises_slope, ran, case: [case.measured("largest displacement")];
    mohr_coulomb_slope, ran, case: case.factor_of_safety(0);
    slope, ran, case: case.factor_of_safety(1);
    layered_slope, ran, case: case.factor_of_safety(1);
    undrained_slope, ran, case: [case.measured("load-displacement at 0.05")];
    sensitive_slope, ran, case: [case.measured("factor of safety")];
    rock_slope, ran, case: case.factor_of_safety(1);
    vertical_cut, ran, case: [case.measured("load-displacement at 0.02")];
    nailed_cut, ran, case: [case.measured("factor of safety")];
    bearing_capacity, ran, case: [case.measured("load-settlement, end")];
    circular_footing, ran, case: [case.measured("load-settlement, end")];
    anisotropic_footing, ran, case: [case.measured("load-settlement, end")];
    dense_sand_footing, ran, case: [1e-3 * case.end_of("load-settlement")];
    two_layer_footing, ran, case: [case.measured("q over cu of the crust")];
    strip_load, ran, case: [case.measured("load-settlement, end")];
    embankment, ran, case: [case.measured("vertical stress in the clay below the axis")];
    k0_ground, ran, case: case.exact();
    soft_clay_fill, ran, case: [case.measured("settlement")];
    cantilever, ran, case: [case.measured("small deflection in mm"), case.measured("deflection at 1")];
    earthquake_slope, ran, case: [case.slid(), case.displaced()];
    column_collapse, ran, case: [case.rested()];
    landslide_dynamic, ran, case: [case.displaced()];
    impact, ran, case: [case.deepest("settlement") - 0.5];
    block, ran, case: [case.measured("height on the axis at rest")];
    contact_footing, ran, case: [
        case.measured("resistance N at a fifth of the width"),
        case.measured("resistance N after it was pulled"),
    ];
    eccentric_footing, ran, case: [case.measured("resistance N")];
    wall, ran, case: [case.measured("active pressure"), case.measured("passive pressure")];
    plate_anchor, ran, case: [case.measured("break-out factor")];
    wedge, ran, case: [case.measured("resistance P over depth and strength")];
    dam_drawdown, ran, case: [
        case.measured("factor of safety dry"),
        case.measured("factor of safety with a full pool"),
    ];
    dam_seepage, ran, case: [case.measured("factor of safety")];
    consolidation, ran, case: [case.measured("degree after one year"), case.measured("degree after ten years")];
    vertical_drain, ran, case: [case.measured("degree after 20 days"), case.measured("degree after 100 days")];
    well, ran, case: [1e3 * case.measured("discharge")];
    excavation, ran, case: [
        case.measured("effective vertical stress at rest"),
        case.measured("effective vertical stress below the pit"),
    ];
    embankment_lifts, ran, case: [case.measured("factor of safety")];
    footing_3d, ran_in_space, case: [case.measured("bearing capacity factor")];
    slope_3d, ran_in_space, case: [case.measured("stability number")];
    landslide_3d, ran_in_space, case: [case.measured("factor of safety")];
}

#[test]
fn the_page_names_the_cases_that_are_not_held() {
    let page = page();
    let begin = page.find("no test holds the numbers of").unwrap();
    let sentence = page[begin..].split(". ").next().unwrap();
    let named: Vec<&str> = sentence.split('`').skip(1).step_by(2).collect();
    let names = SHIPPED.iter().map(|case| case.name);
    let others: Vec<&str> = names.filter(|name| !HELD.contains(name)).collect();
    assert_eq!(named, others);
}
