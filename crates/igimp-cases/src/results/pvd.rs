//! Collections of frames for ParaView.

/// Frames and collections that a run writes: particles and grid.
const STEMS: [&str; 2] = ["particles", "grid"];

/// Whether a file of `paraview/` has a name that a run gives: `STEM.pvd`, `STEM_0001.vtu`.
pub(super) fn is_our_name(name: &str) -> bool {
    STEMS.iter().any(|stem| {
        let Some(end) = name.strip_prefix(stem) else {
            return false;
        };
        end == ".pvd" || frame_number(end).is_some()
    })
}

/// Number of a frame from the end of its name, such as `_0001.vtu`.
fn frame_number(end: &str) -> Option<usize> {
    let digits = end.strip_prefix('_')?.strip_suffix(".vtu")?;
    let is_number = digits.len() >= 4 && digits.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| digits.parse().ok())?
}
