//! Level ground, which K₀ stresses need.

use igimp_schema::text::point;

use crate::build::bodies::site::Site;

/// Why the ground is not level; `None` when it is.
pub(crate) fn uneven(site: &Site) -> Option<String> {
    let surface = site.surface();
    let round_off = 10.0 * site.round_off;
    for [from, to] in surface {
        if (from[1] - to[1]).abs() > round_off {
            return Some(format!(
                "the surface is inclined from {} to {}",
                point(*from),
                point(*to)
            ));
        }
    }
    let highest = surface.iter().max_by(|a, b| a[0][1].total_cmp(&b[0][1]))?;
    surface
        .iter()
        .find(|edge| highest[0][1] - edge[0][1] > round_off)
        .map(|edge| {
            format!(
                "the surface has steps: {} and {}",
                point(edge[0]),
                point(highest[0])
            )
        })
}
