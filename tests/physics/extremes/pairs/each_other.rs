//! Grains thrown at each other.

use super::in_space::SOLID;
use super::in_the_plane::FLAT;
use super::*;

/// Throws each grain at the middle of each other one, half of the time across a period: the target
/// is hit, or the run reports that it may not have been.
fn throw_at_each_other<S: Space>(grains: &[(&str, Grain)]) {
    let mut rng = Pcg64::seed_from_u64(20);
    let mut silent = Vec::new();
    let (mut hit, mut reported, mut reported_seen) = (0, 0, 0);
    for (one, thrown) in grains {
        for (other, target) in grains {
            for (k, speed) in SPEEDS.into_iter().enumerate() {
                let throw = Throw::any(&mut rng, speed);
                let from = throw.from + 1.1 * R;
                let period = 2.5 * (from + 4.0 * throw.step).max(0.2);
                let across = k % 2 == 0;
                // The target is near the border of the period, over which it is hit.
                let x = if across { 0.5 * period - 0.5 * R } else { 0.0 };
                let start = if across { x + from - period } else { x + from };
                let v = place::<S>(-throw.step / STEP, 0.0, 0.0);
                let spin = match S::D {
                    2 => format!("[{:?}]", throw.spin),
                    _ => format!("[0.0, {:?}, 0.0]", throw.spin),
                };
                let sketch = Sketch {
                    step: STEP,
                    gravity: 0.0,
                    grains: thrown(
                        &place::<S>(start, 0.0, 0.0),
                        &format!(", velocity: {v}, spin: {spin}"),
                        throw.turned,
                    ) + &target(&place::<S>(x, 0.0, 0.0), "", 0.7 * throw.turned),
                    more: if across {
                        format!("periodic: (x: {period:?}),")
                    } else {
                        String::new()
                    },
                    ..Sketch::default()
                };
                let what = format!(
                    "{one} on {other}: {speed} radii a step, from {:.3} radii, turned {:.3}, spin {:.2}, across a period: {across}",
                    from / R,
                    throw.turned,
                    throw.spin
                );
                let mut s: Simulation<S> = sketch.build().unwrap_or_else(|e| panic!("{what}: {e}"));
                for _ in 0..(from / throw.step).ceil() as usize + AFTER {
                    s.step().unwrap_or_else(|e| panic!("{what}: {e}"));
                }
                let [slower, faster] = {
                    let speeds = s
                        .state
                        .bodies
                        .grains()
                        .map(|b| -s.state.bodies.velocity[b][0]);
                    let mut speeds: Vec<f64> = speeds.collect();
                    speeds.sort_by(f64::total_cmp);
                    [speeds[0], speeds[1]]
                };
                if s.state.network.step_size.warning().is_some() {
                    let seen = throw.is_seen(from, 2.0 * R, 0.5);
                    let balls = [one, other].iter().all(|n| ["disk", "sphere"].contains(n));
                    match (seen, balls) {
                        (true, true) => {
                            silent.push(format!("{what}; reported, although it is seen"))
                        }
                        (true, false) => reported_seen += 1,
                        _ => reported += 1,
                    }
                } else if slower != 0.0 && faster != throw.step / STEP {
                    hit += 1;
                } else {
                    silent.push(what);
                }
            }
        }
    }
    let total = hit + reported + reported_seen;
    println!(
        "{}D: {hit} hit, {reported} reported, {reported_seen} although seen",
        S::D
    );
    // At most a quarter of the throws is reported, which is also the bound for walls.
    assert!(4 * reported < total, "{reported} of {total} reported");
    // Both grains rotate, by more than a radian in most throws.
    assert!(
        10 * reported_seen < 3 * total,
        "{reported_seen} of {total} reported, although seen"
    );
    assert!(
        silent.is_empty(),
        "{} not hit:\n{}",
        silent.len(),
        silent.join("\n")
    );
}

#[test]
fn grains_meet_each_other() {
    throw_at_each_other::<Dim2>(&FLAT);
    throw_at_each_other::<Dim3>(&SOLID);
}
