use super::*;

fn point(factor: f64, work: f64, displacement: f64, dissipated: f64) -> PathPoint {
    PathPoint {
        factor,
        work,
        displacement,
        dissipated,
        ..PathPoint::default()
    }
}

/// λ = 1.5 − 0.5/ω at works 1, 2, 4, ...
fn rises_to_a_limit(dissipated: f64) -> Vec<PathPoint> {
    (0..12)
        .map(|k| {
            let work = 2.0_f64.powi(k);
            point(1.5 - 0.5 / work, work, work, dissipated)
        })
        .collect()
}

fn first_end(points: &[PathPoint]) -> Option<(usize, PathEnd, PathPoint)> {
    (1..=points.len()).find_map(|n| {
        let (end, limit) = end(&points[..n], Course::RISING, None)?;
        Some((n, end, limit))
    })
}

/// GOAL: a path ends where it is a mechanism and flat, and not where it is one of the two.
/// ORACLE: λ rises by 0.5/ω over λ in the doubling to ω, by hand: by 1.3e-3 in that to 256, and by 6.5e-4 in that to 512.
#[test]
fn a_limit_is_flat_and_a_mechanism() {
    let mut points = rises_to_a_limit(0.995);
    for point in &mut points[..8] {
        point.dissipated = 0.5;
    }
    points[7].dissipated = 0.99 - 1e-9;
    let (n, end, limit) = first_end(&points).unwrap();
    assert_eq!((n, end), (10, PathEnd::Limit));
    assert!(limit.work > 256.0 && limit.work < 512.0, "{}", limit.work);
    assert_eq!(
        first_end(&rises_to_a_limit(0.98)).map(|found| found.1),
        None
    );
    let found = rise(&points[..6], Course::RISING, &points[5]).unwrap();
    let exact = (1.5 - 0.5 / 32.0) / (1.5 - 0.5 / 16.0) - 1.0;
    assert!((found - exact).abs() < 1e-14);
}

/// GOAL: the equilibrium that tells the factor does not go by steps.
/// ORACLE: the same path with twice as many points; interpolation errs by the curvature of a doubling.
#[test]
fn other_steps_tell_the_same_factor() {
    let path = |per_doubling: i32| -> Vec<PathPoint> {
        (0..16 * per_doubling)
            .map(|k| {
                let work = 2.0_f64.powf(f64::from(k) / f64::from(per_doubling));
                point(1.5 - 0.05 / work, work, work, 1.0 - 0.1 / work)
            })
            .collect()
    };
    let factors = [1, 2, 5].map(|per| first_end(&path(per)).unwrap().2.factor);
    for factor in factors {
        assert!((factor / factors[2] - 1.0).abs() < 2e-4, "{factors:?}");
    }
}

#[test]
fn a_factor_that_rises_on_is_none_that_falls() {
    let rising: Vec<PathPoint> = (0..14)
        .map(|k| {
            let work = 2.0_f64.powi(k);
            let dissipated = if k < 3 { 0.985 } else { 0.995 };
            point(1.0 + 0.005 * f64::from(k), work, work, dissipated)
        })
        .collect();
    // 0.99 is passed at the middle of ω = 4 and 8: four times that is 2^4.5.
    let (n, found, limit) = first_end(&rising).unwrap();
    assert_eq!((n, found), (6, PathEnd::StillRising));
    assert!(
        (limit.work - 2.0_f64.powf(4.5)).abs() < 1e-6,
        "{}",
        limit.work
    );
    assert!((limit.factor - 1.0225).abs() < 1e-9);
    let (found, limit) = end(&rising[..6], Course::RISING, Some(20.0)).unwrap();
    assert_eq!(found, PathEnd::Displacement);
    assert!((limit.displacement - 20.0).abs() < 1e-9);
    // A mechanism of the skin: its factor rises by 2 % in a doubling.
    let steep: Vec<PathPoint> = (0..14)
        .map(|k| {
            let work = 2.0_f64.powi(k);
            point(1.0 + 0.02 * f64::from(k), work, work, 0.995)
        })
        .collect();
    assert_eq!(first_end(&steep).map(|found| found.1), None);
    let mut fallen = steep[..6].to_vec();
    fallen.push(point(1.05, 64.0, 40.0, 0.9));
    let (found, limit) = end(&fallen, Course::RISING, None).unwrap();
    assert_eq!((found, limit.factor), (PathEnd::Fallen, 1.1));
}

#[test]
fn points_between_are_interpolated() {
    let points = [
        point(1.0, 1.0, 0.01, 0.9),
        point(1.2, 2.0, 0.02, 0.98),
        point(1.25, 4.0, 0.08, 1.0),
    ];
    let mut early = points.to_vec();
    early.insert(0, point(0.9, 0.5, 0.001, 0.995));
    assert_eq!(mechanism(&early), mechanism(&points));
    assert_eq!(mechanism(&points[..2]), None);
    let found = mechanism(&points).unwrap();
    assert!((found.factor - 1.225).abs() < 1e-12);
    assert!((found.displacement - 0.04).abs() < 1e-12);
    let found = at_displacement(&points, 0.05).unwrap();
    assert!((found.factor - 1.225).abs() < 1e-12);
    assert!(at_displacement(&points, 0.1).is_none());
    assert!((knee(&points, Course::RISING).unwrap().factor - 1.2).abs() < 1e-12);
}

/// GOAL: a factor that falls has the limit of its mirror image.
/// ORACLE: the path of a factor that rises from zero, with the other sign.
#[test]
fn a_factor_that_falls_is_the_mirror_image_of_one_that_rises() {
    let risen = rises_to_a_limit(0.995);
    let mut fallen_back = risen[..6].to_vec();
    fallen_back.push(point(1.3, 64.0, 64.0, 0.9));
    let down = Course::between(0.0, -2.0);
    for path in [risen, fallen_back] {
        let mirrored: Vec<PathPoint> = (path.iter())
            .map(|&point| PathPoint {
                factor: -point.factor,
                ..point
            })
            .collect();
        for n in 1..=path.len() {
            let found = end(&path[..n], Course::RISING, None);
            let other = end(&mirrored[..n], down, None);
            assert_eq!(
                found.map(|(end, at)| (end, -at.factor, at.work)),
                other.map(|(end, at)| (end, at.factor, at.work))
            );
        }
        let of = |points: &[PathPoint], course| PathSummary {
            end: PathEnd::Limit,
            limit: points.last().copied(),
            rise: rise(points, course, points.last().unwrap()),
            points: points.to_vec(),
            ..PathSummary::default()
        };
        let (summary, other) = (of(&path, Course::RISING), of(&mirrored, down));
        assert_eq!(summary.rise, other.rise);
        let negative = |(a, b): (Option<f64>, Option<f64>)| (a.map(|a| -a), b.map(|b| -b));
        assert_eq!(interval(&summary), negative(interval(&other)));
        let knees = [knee(&path, Course::RISING), knee(&mirrored, down)];
        assert_eq!(knees[0].map(|at| -at.factor), knees[1].map(|at| at.factor));
    }
}

/// GOAL: a support that is lowered through zero has a limit, and its way counts where its factor is nothing.
/// ORACLE: by hand, λ = 1 − 1.2 (1 − 1/ω): it goes by 1.2/ω in the doubling to ω, of a way of 1.2.
#[test]
fn a_factor_that_passes_zero_has_a_scale() {
    let points: Vec<PathPoint> = (0..14)
        .map(|k| {
            let work = 2.0_f64.powi(k);
            let dissipated = if k < 10 { 0.5 } else { 0.995 };
            point(1.0 - 1.2 * (1.0 - 1.0 / work), work, work, dissipated)
        })
        .collect();
    let course = Course::between(1.0, -1.0);
    let ended = (1..=points.len()).find_map(|n| end(&points[..n], course, None));
    let (found, limit) = ended.unwrap();
    assert_eq!(found, PathEnd::Limit);
    assert!(limit.work > 1024.0 && limit.work < 4096.0, "{}", limit.work);
    let rise = rise(&points, course, &points[10]).unwrap();
    let way = 1.2 * (1.0 - 1.0 / 512.0);
    assert!((rise - 1.2 / 1024.0 / way).abs() < 1e-12, "{rise}");
}

/// GOAL: the interval of a factor that has fallen holds the peak between equilibria, and is finite where a step did no work.
/// ORACLE: λ = 2 − (ω − 3)² with its peak of 2, sampled on either side of it in steps of other places.
#[test]
fn a_peak_between_equilibria_lies_in_the_interval() {
    for offset in [0.0, 0.05, 0.15, 0.25, 0.3, 0.39] {
        let works = (0..10).map(|k| 1.0 + offset + 0.4 * f64::from(k));
        let points: Vec<_> = works
            .map(|work| point(2.0 - (work - 3.0).powi(2), work, work, 1.0))
            .collect();
        let largest = points.iter().map(|point| point.factor).fold(0.0, f64::max);
        let above = (1.0 + above_peak(&points, Course::RISING)) * largest;
        assert!((2.0..2.5).contains(&above), "{offset} {largest} {above}");
    }
    let still = [
        point(1.0, 1.0, 0.0, 0.0),
        point(1.2, 1.0, 0.0, 0.0),
        point(1.1, 2.0, 1.0, 1.0),
    ];
    assert!((above_peak(&still, Course::RISING) - 0.2 / 1.2).abs() < 1e-12);
    assert!(above_peak(&still[..2], Course::RISING).abs() < 1e-12);
}
