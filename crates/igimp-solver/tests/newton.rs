//! explore
mod body_support;
use body_support::*;
use igimp_solver::*;
#[test]
fn explore() {
    let grid = unit_grid([7, 5]);
    for g in [1.1, 1.3, 1.5, 1.8] {
        for (name, law) in laws() {
            for (label, method) in methods() {
                let mut body = shifted_block(&grid, [0, 0], [4, 3], [0.15, 0.1]);
                let c = conditions(&grid, &standing(&grid), &law, g);
                let s = NewtonSettings {
                    tolerance: 1e-12,
                    ..NewtonSettings::default()
                };
                match step(&mut body, &method, &c, (0.0, 1.0), &s, &mut workspace()) {
                    Ok((r, _)) => {
                        let o: Vec<String> =
                            r.residuals.iter().map(|r| format!("{r:.1e}")).collect();
                        println!(
                            "{g} {name:25} {label:30} {:.2} {}",
                            r.plastic_share,
                            o.join(" ")
                        );
                    }
                    Err(e) => println!("{g} {name} {label} {:?} {:?}", e.failure, e.residuals),
                }
            }
        }
    }
}
