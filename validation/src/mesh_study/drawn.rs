//! Drawn values: a limit, an error that falls with an order of convergence, and the noise of a search.

use std::fmt::Write as _;

use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::mesh_study::{Computed, Convergence, estimate};
use igimp_results::tables::table::Table;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::coverage::median;
use crate::harness::study::{RunRecord, Study};

/// How many values are drawn.
const DRAWS: usize = 20_000;
/// The orders that are drawn \[-\].
const ORDERS: [f64; 2] = [0.5, 2.0];
/// The least order that is thought possible of soil \[-\].
const BELIEVED: f64 = 2.0 / 3.0;
/// How far the coarse mesh lies above the limit, as a share of it: that of slopes on ten cells \[-\].
const ERRORS: [f64; 2] = [0.005, 0.06];
/// Half-widths of the intervals of a path and of trials, as shares of the limit \[-\].
const NOISE: [(&str, f64); 2] = [("a path", 5e-4), ("trials", 2.5e-3)];

const DRAWN: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "the limit that the values were drawn about",
    locator: "orders evenly from 1/2 to 2, of which 8/9 lie above 2/3, the least that two meshes allow for",
};

/// Numbers that look like chance and are always the same (Steele, Lea and Flood 2014, SplitMix64).
struct Chance(u64);

impl Chance {
    /// The next number from a to b.
    fn between(&mut self, [a, b]: [f64; 2]) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^= bits >> 31;
        a + (b - a) * (bits >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The coverage of drawn values.
#[derive(Default)]
struct Drawn {
    /// Covered and counted, of all orders.
    all: [usize; 2],
    /// The same of orders that are thought possible.
    believed: [usize; 2],
    widths: Vec<f64>,
}

/// Values on so many meshes, with noise of a half-width.
fn draw(meshes: u32, half_width: f64) -> Drawn {
    let mut chance = Chance(u64::from(meshes));
    let mut drawn = Drawn::default();
    for _ in 0..DRAWS {
        let order = chance.between(ORDERS);
        let error = chance.between(ERRORS);
        let values: Vec<Computed> = (0..meshes)
            .map(|mesh| {
                let h = 0.5_f64.powi(mesh as i32);
                Computed {
                    h,
                    value: 1.0 + error * h.powf(order) + chance.between([-half_width, half_width]),
                    half_width,
                }
            })
            .collect();
        let Some(found) = estimate(&values, Convergence::SOIL) else {
            continue;
        };
        let covers = usize::from((found.value - 1.0).abs() <= found.uncertainty + 1e-9);
        drawn.all[0] += covers;
        drawn.all[1] += 1;
        if order >= BELIEVED {
            drawn.believed[0] += covers;
            drawn.believed[1] += 1;
        }
        drawn.widths.push(2.0 * found.uncertainty / found.value);
    }
    drawn
}

/// Draws values on two and three meshes with the noise of both searches, and counts how often the limit is covered.
pub(super) fn report(study: &mut Study) -> Result<(), CaseError> {
    let mut table = Table::new(
        "drawn",
        &[
            "meshes",
            "half_width_[-]",
            "covered,_orders_1/2_to_2_[-]",
            "covered,_orders_2/3_to_2_[-]",
            "median_width_[-]",
        ],
    );
    let mut note = format!(
        "{DRAWS} drawn values, orders 1/2 to 2: meshes, search; covered [%]; of orders from 2/3 [%]; median width [%]\n"
    );
    for meshes in [2, 3] {
        for (search, half_width) in NOISE {
            let mut drawn = draw(meshes, half_width);
            let share = |[covered, counted]: [usize; 2]| covered as f64 / counted as f64;
            let (all, believed) = (share(drawn.all), share(drawn.believed));
            let width = median(&mut drawn.widths);
            let _ = writeln!(
                note,
                "  {meshes}, {search}; {:.1}; {:.1}; {:.2}",
                100.0 * all,
                100.0 * believed,
                100.0 * width
            );
            table.push(vec![f64::from(meshes), half_width, all, believed, width]);
            let name = format!("drawn values, {meshes} meshes, intervals of {search}");
            let run = study.run(RunRecord::sum(name, &[]));
            study.check(
                run,
                "share covered, orders 2/3 to 2 [-]",
                DRAWN.says(1.0),
                Band::AtLeast(0.9999),
                believed,
            );
            let expected = if meshes == 2 { 8.0 / 9.0 } else { 0.95 };
            study.check(
                run,
                "share covered, orders 1/2 to 2 [-]",
                DRAWN.says(expected),
                Band::AtLeast(expected - 0.01),
                all,
            );
        }
    }
    study.notes.push(note);
    Ok(table.write_csv(&study.folder)?)
}
