//! Located optima against closed forms and a program of its own (`tests/peers/true_optimum.py`):
//! what is certified is right to many digits, and nothing else is certified.

use fdcc::{Executor, Model, Options, Solution, Start};
use fdcc_compiler::{Arc, Mode, PhaseOfModes, with_modes};
use fdcc_runtime::problem::ControlShape;
use std::path::{Path, PathBuf};

/// Certified is never further from the reference than this, for its size.
const RIGHT: f64 = 1e-8;

/// What is certified today; a row that goes is a loss.
const CERTIFIED: &[&str] = &[
    "models/block",
    "models/bounce",
    "models/coulomb_energy",
    "models/coulomb_rest",
    "models/coulomb_reverse",
    "models/puck",
    "models/slider_fit",
    "models/stacked",
    "models/turbo",
    "right/dc_motor",
    "right/inclined_plane",
    "right/pension",
    "right/pushed_table",
    "switched/belt",
    "switched/cart_pole_friction",
    "switched/corner",
    "switched/drag_regimes",
    "switched/eclipse",
    "switched/free_time",
    "switched/fuel_abs",
    "switched/gear_loss",
    "switched/hard_pull",
    "switched/heater",
    "switched/hysteresis_car",
    "switched/ice_patch",
    "switched/load_lets_go",
    "switched/moving_wall",
    "switched/nearly_together",
    "switched/overdrive",
    "switched/paddle",
    "switched/power_limit",
    "switched/puck_aside",
    "switched/relay",
    "switched/ricochet",
    "switched/sand_and_road",
    "switched/shoreline",
    "switched/speed_limit",
    "switched/springs",
    "switched/stay",
    "switched/stribeck",
    "switched/swing_up",
    "switched/three_relays",
    "switched/thrust_hopper",
    "switched/to_the_bound",
    "switched/toll",
    "switched/touch_friction",
    "switched/turn_round",
    "switched/twins",
    "switched/twins_apart",
    "switched/two_contacts",
    "switched/two_pedals",
    "switched/two_relays",
    "switched/uphill_soon",
    "switched/valve_motor",
    "switched/wall",
    "switched/window",
];

/// Solved in other tests, or too slow for every run.
const LEFT_OUT: &[&str] =
    &["models/racecar", "right/gripper", "right/sled_on_ice", "switched/billiard", "switched/fan"];

/// A row of the table of references.
struct Reference {
    name: String,
    objective: f64,
    /// When surfaces change their modes.
    switches: Vec<f64>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn references() -> Vec<Reference> {
    let table = std::fs::read_to_string(root().join("tests/peers/true_optimum.csv"));
    let table = table.expect("the table is there");
    let row = |line: &str| {
        let mut cells = line.split(',');
        let name = cells.next()?.to_owned();
        let objective = cells.next()?.parse().ok()?;
        let switches = cells.next()?.split(';').filter_map(|it| it.parse().ok()).collect();
        Some(Reference { name, objective, switches })
    };
    table.lines().skip(1).filter_map(row).collect()
}

fn place(name: &str) -> Option<PathBuf> {
    let (kind, model) = name.split_once('/')?;
    let folder = match kind {
        "models" => "models",
        "right" => "tests/right",
        "switched" => "tests/classics/switched",
        _ => return None,
    };
    Some(root().join(folder).join(format!("{model}.fdc")))
}

fn solved(name: &str) -> Solution {
    let path = place(name).expect("a kind of models");
    let model = Model::from_file(path.to_str().expect("a path")).expect("it has no mistakes");
    model.solve(&Options::default()).expect("it can be solved")
}

fn relative(found: f64, reference: f64) -> f64 {
    (found - reference).abs() / reference.abs().max(1.0)
}

#[test]
fn what_is_certified_is_the_true_optimum() {
    let mut rows = references();
    rows.retain(|it| place(&it.name).is_some() && !LEFT_OUT.contains(&it.name.as_str()));
    Executor::default().in_order(rows.len(), |row| assert_is_true(&rows[row]), |_| false);
}

fn assert_is_true(it: &Reference) {
    let solution = solved(&it.name);
    let is_certified = solution.is_certified();
    if CERTIFIED.contains(&it.name.as_str()) {
        assert!(is_certified, "{}: {:?}", it.name, solution.certificate);
    }
    if is_certified {
        let off = relative(solution.objective(), it.objective);
        assert!(off < RIGHT, "{} {} {}", it.name, solution.objective(), it.objective);
    }
}

/// One number for tolerances, replays and certificates; what is named beside it wins, in any order.
#[test]
fn accuracy_is_one_number() {
    let text = "time t in [0, 2]\nstate x start 0\nstate v start 0\ncontrol u in [-9, 9]\n\
                surface slip = v\ndynamics { x' = v  v' in u - Sgn(slip) }\n\
                end x == 1\nend v == 0\nminimize integral(u^2)\n";
    let method = |keys: &str| {
        let text = format!("{text}method {{ {keys} }}");
        Model::from_text("slide", &text).expect("a model")
    };
    for (keys, tol, tolerance) in [
        ("accuracy = 1e-4", 1e-6, 1e-4),
        ("accuracy = 1e-4 tol = 1e-9", 1e-9, 1e-4),
        ("tol = 1e-9 tolerance = 1e-2 accuracy = 1e-4", 1e-9, 1e-2),
    ] {
        let model = method(keys);
        let own = &model.meaning().method;
        assert!((own.tol / tol - 1.0).abs() < 1e-12 && own.tolerance == tolerance, "{keys}");
    }
    let solution = method("accuracy = 1e-9").solve(&Options::default()).expect("an answer");
    let certificate = solution.certificate.as_ref().expect("it was looked for");
    let replayed = certificate.checks.iter().find(|it| it.name == "replayed");
    assert!(solution.is_certified() && replayed.expect("a check").limit == 1e-9);
}

/// Starts that lead to one optimum are told as one, and those that are not certified as such.
#[test]
fn several_starts_lead_to_families() {
    let path = place("switched/lens").expect("it is there");
    let options = Options { starts: 6, ..Options::default() };
    let model = Model::from_file(&path.to_string_lossy()).expect("a model");
    let solution = model.solve(&options).expect("an answer");
    let certified = |it: &&fdcc::Family| it.is_certified;
    let best = solution.families.iter().find(certified).expect("one is certified");
    assert_eq!(best.objective, solution.objective());
    assert_eq!(solution.families.iter().map(|it| it.starts).sum::<usize>(), 6);
    assert!(solution.families.len() > 1 && solution.is_certified());
}

/// What follows from surfaces that are held in the end is not asked for again, or the Jacobian
/// would lose rank; what does not follow is.
#[test]
fn a_hold_says_what_is_zero_in_the_end() {
    let text = "param r = 2\ntime t in [0, 1]\nstate v start 0\nstate w start 0\nstate y start 0\n\
                control F in [-9, 9]\nsurface apart = v - r*w\nsurface slip = w\n\
                dynamics { v' in F - Sgn(apart)  w' in Sgn(apart) - Sgn(slip)  y' = v }\n\
                end v == 0\nend v + w == 0\nend y == 0\nminimize integral(F^2)\n";
    let model = Model::from_text("chain", text).expect("it has no mistakes");
    let open = |modes: [Mode; 2]| -> Vec<bool> {
        let phase = |modes: [Mode; 2]| PhaseOfModes {
            modes: modes.to_vec(),
            arcs: vec![Arc::Free],
            contacts: Vec::new(),
            touches: Vec::new(),
            jump: None,
            shape: ControlShape::Polynomial,
            halvings: 0,
            is_graded: false,
            steep: Vec::new(),
            is_cut: false,
            is_joined: false,
        };
        let phases = [phase([Mode::Above; 2]), phase(modes)];
        let chain = with_modes(model.meaning(), &phases).expect("it can be divided");
        let rows = &chain.links[chain.links.len() - 1].rows;
        rows.iter()
            .map(|row| chain.graph.as_number(row.range.lower) == Some(-f64::INFINITY))
            .collect()
    };
    assert_eq!(open([Mode::Held, Mode::Held]), [true, true, false]);
    assert_eq!(open([Mode::Above, Mode::Held]), [false, true, false]);
    assert_eq!(open([Mode::Above, Mode::Above]), [false; 3]);
}

/// Where a pull leaves its bound without a jump, that it does says when: the objective does so only
/// with the third power of the time, and an earlier answer was refused after 300 iterations.
#[test]
fn a_junction_of_a_regular_control_is_located() {
    let path = place("models/block").expect("a kind of models");
    let model = Model::from_file(path.to_str().expect("a path")).expect("it has no mistakes");
    let with = |it: &Model, key: &str, value: &str| it.with_method(key, value).expect("a setting");
    let model = with(&with(&model, "N", "100"), "scheme", "radau3");
    let before = model.solve(&Options::default()).expect("it can be solved");
    let record = before.record();
    let harder = model.with("mu", 0.31).expect("a parameter");
    let own = Options { start: Start::Record(&record), ..Options::default() };
    let solution = harder.solve(&own).expect("it can be solved");
    assert!(solution.is_certified(), "{:?}", solution.certificate);
    let arcs = &solution.certificate.as_ref().expect("it was looked for").arcs[0].1;
    let free = arcs.iter().find(|it| it.arc == "max").expect("the pull is at its bound");
    assert!((free.to - free.from - 0.0192469126).abs() < 1e-8, "{arcs:?}");
}

/// One switch, as the closed form or the other program has it.
#[test]
fn a_switch_is_located_where_it_is() {
    for it in references().iter().filter(|it| CERTIFIED.contains(&it.name.as_str())) {
        let unique = ["switched/belt", "switched/toll", "switched/turn_round"];
        if !unique.contains(&it.name.as_str()) {
            continue;
        }
        let certificate = solved(&it.name).certificate.expect("it was looked for");
        let found: Vec<f64> = certificate.switches.iter().map(|switch| switch.time).collect();
        let same = found.iter().zip(&it.switches).all(|(a, b)| (a - b).abs() < 1e-8);
        assert!(same && found.len() == it.switches.len(), "{} {found:?}", it.name);
    }
}

/// `T = 2 sqrt(d U/(U^2 - mu^2))`, differentiated by hand: bounds on arcs count.
#[test]
fn a_located_optimum_has_exact_sensitivities() {
    let (d, u, mu) = (1.0, 2.0, 0.5_f64);
    let gap: f64 = u * u - mu * mu;
    let time = 2.0 * (d * u / gap).sqrt();
    let by = [
        ("d", time / (2.0 * d)),
        ("U", -time * (u * u + mu * mu) / (2.0 * u * gap)),
        ("mu", time * mu / gap),
    ];
    let solution = solved("models/coulomb_rest");
    let found = solution.sensitivities();
    for (name, expected) in by {
        let own = found.iter().find(|it| it.0 == name).expect("a parameter").1;
        assert!((own - expected).abs() < 1e-7, "{name}: {own} {expected}");
    }
}

/// `J = (1 - |a|)^2` has a kink at `a = 0`, and `(1 - a |a|)^2` has none.
#[test]
fn a_parameter_on_a_kink_has_no_sensitivity() {
    for (drift, a, expected) in [
        ("abs(a)", 0.0, f64::NAN),
        ("max(a, 0) + max(-a, 0)", 0.0, f64::NAN),
        ("abs(a)", 0.1, -1.8),
        ("min(abs(a), 1)", 0.0, f64::NAN),
        ("a*abs(a)", 0.0, 0.0),
        ("piecewise { a >= 0 => a  otherwise => 2*a }", 0.0, f64::NAN),
        ("piecewise { a >= 0 => a  otherwise => 2*a }", 0.1, -1.8),
        ("max(a*(1 + x^2), 0)", 0.0, f64::NAN),
    ] {
        let text = format!(
            "param a = {a} time t in [0, 1] state x start 0 control u end x == 1
             dynamics {{ x' = u + {drift} }} minimize integral(u^2)"
        );
        let model = Model::from_text("drift", &text).expect("it has no mistakes");
        let solution = model.solve(&Options::default()).expect("it can be solved");
        let (_, found) = solution.sensitivities()[0];
        let is_right = (found - expected).abs() < 1e-7 || found.is_nan() && expected.is_nan();
        assert!(is_right, "{drift} at {a}: {found} instead of {expected}");
    }
}

/// Where the objective is maximised, all signs are others.
#[test]
fn a_maximum_is_certified_alike() {
    for name in ["models/turbo", "models/coulomb_rest", "switched/window", "switched/speed_limit"] {
        let path = place(name).expect("a kind of models");
        let text = std::fs::read_to_string(path).expect("a model");
        let text = text.split("\nexpect {").next().expect("a model");
        let line = text.lines().find(|it| it.starts_with("minimize ")).expect("an objective");
        let value = line.trim_start_matches("minimize ").split('#').next().expect("a value");
        let text = text.replace(line, &format!("maximize -({value})"));
        let model = Model::from_text("maximum", &text).expect("it has no mistakes");
        let solution = model.solve(&Options::default()).expect("it can be solved");
        assert!(solution.is_certified(), "{name}: {:?}", solution.certificate);
        let all = references();
        let reference = all.iter().find(|it| it.name == name).expect("a reference");
        assert!(relative(-solution.objective(), reference.objective) < RIGHT, "{name}");
    }
}

/// The closed form: half of the road at full thrust to the limit of the speed, and back again.
#[test]
fn an_arc_of_a_state_is_located() {
    let certificate = solved("models/turbo").certificate.expect("it was looked for");
    let own = certificate.arcs.iter().find(|it| it.0 == "v").expect("a state at its bound");
    let found: Vec<(&str, f64)> = own.1.iter().map(|it| (it.arc, it.from)).collect();
    let expected = [("free", 0.0), ("max", 8.0 / 3.0), ("free", 32.0 / 3.0)];
    let is_same = |(a, b): (&(&str, f64), &(&str, f64))| a.0 == b.0 && (a.1 - b.1).abs() < 1e-8;
    assert!(found.len() == 3 && found.iter().zip(&expected).all(is_same), "{found:?}");
}

/// An infimum at a surface that repels is not called an optimum.
#[test]
fn what_is_no_optimum_is_not_certified() {
    let solution = solved("switched/ridge");
    assert_eq!((solution.status_name(), solution.is_solved()), ("uncertified", false));
    let certificate = solution.certificate.as_ref().expect("it was looked for");
    assert!(!certificate.is_certified() && certificate.checks.iter().any(|it| !it.passes()));
    assert!(solution.outcome.sigma.iter().all(|sigma| *sigma > 0.0), "the smoothed answer");
}

/// A bowling ball, which only its start drives, ends to roll: nothing that is not there comes late.
#[test]
fn without_controls_nothing_is_said_of_their_timing() {
    let text = "free v0 in [1, 12] guess 6\nfree w0 in [-20, 20] guess 0\ntime t in [0, 3]\n\
                state x start 0\nstate v start v0\nstate w start w0\nsurface slip = v - w\n\
                dynamics { x' = v  v' in -1*Sgn(slip)  w' in 2.5*Sgn(slip) }\nend x == 10\n\
                minimize v0^2 + 0.4*w0^2\n";
    let model = Model::from_text("bowling", text).expect("it has no mistakes");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    let certificate = solution.certificate.as_ref().expect("it was looked for");
    assert_eq!(certificate.figure("timing"), Some(0.0), "{certificate:?}");
}

/// What random models and an independent judge found (`tests/peers/random_optima`): a cost that is
/// high for a moment only falls between the nodes, and a hold at `|s| = 1` is better left a moment
/// before something else changes.
#[test]
fn what_falls_between_the_nodes_is_not_certified() {
    let start = "state x start 0\nstate v start 0\ncontrol u in [-6, 6]\nsurface slip = v\n";
    let peak = "time t in [0, 3]\nSTATES dynamics { x' = v  v' in u - 0.5*Sgn(slip) }\n\
                end x == 1\nend v == 0\n\
                minimize integral(u^2 + 3*exp(-((t - 0.5)/0.001)^2)*u)\n";
    let late = "time t in [0, 2.9]\nSTATES surface late = t - 1.5\n\
                dynamics { x' = v\n\
                v' in u + match late { below => 0.55, above => 0.19 } - 0.52*Sgn(slip) }\n\
                minimize integral(u^2) + 1.4*x(end)\n";
    for (text, check) in [(peak, "objective"), (late, "insertion")] {
        let text = text.replace("STATES ", start);
        let model = Model::from_text("between", &text).expect("it has no mistakes");
        let solution = model.solve(&Options::default()).expect("it can be solved");
        let certificate = solution.certificate.as_ref().expect("it was looked for");
        let own = certificate.checks.iter().find(|it| it.name == check).expect("a check");
        assert!(!own.passes(), "{certificate:?}");
    }
}

/// `u^2 (u - 2)^2` has a minimum at 0 and one at 2: to walk and to wait in turns costs nothing, and
/// to creep is better than what is near to it only.
#[test]
fn controls_that_are_best_only_near_themselves_are_not_certified() {
    let text = "time t in [0, 2]\nstate x start 0\ncontrol u in [-1, 3] guess 0.3\n\
                surface half = x - 0.3\n\
                dynamics { x' in u + match half { below => 0, above => 0.05 } }\n\
                end x == 0.6\nminimize integral(u^2*(u - 2)^2)\n";
    let model = Model::from_text("gait", text).expect("it has no mistakes");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    let certificate = solution.certificate.as_ref().expect("it was looked for");
    assert!(certificate.figure("minimum").is_some_and(|it| it > 0.1), "{certificate:?}");
    assert_eq!(solution.status_name(), "uncertified");
}

/// `u = w = 1` is better by 1 than 0, though neither is alone; and a dead zone is left for what is
/// worth it, in whatever unit the objective is.
#[test]
fn controls_that_are_better_together_or_in_small_units_are_seen() {
    let joint = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]\ncontrol w in [-1, 1]\n\
                 dynamics { x' = u + w }\n\
                 minimize integral(u^2 + w^2 - 3*u^2*w^2 + 0.001*x^2)\n";
    let zone = "time t in [0, 1]\nstate x start 0\ncontrol u in [-3, 3]\n\
                dynamics { x' = piecewise { u <= -1 => u + 1\n u <= 1 => 0\n otherwise => u - 1 } \
                }\nminimize 1e-9*(integral(0.01*u^2) + (x(end) - 1)^2)\n";
    let bent = "time t in [0, 1]\nstate x start 0\ncontrol u in [-3, 3]\n\
                dynamics { x' = max(u - 1, 0) + min(u + 1, 0) }\n\
                minimize integral(0.01*u^2) + (x(end) - 1)^2\n";
    for text in [joint, zone, bent] {
        let model = Model::from_text("together", text).expect("it has no mistakes");
        let solution = model.solve(&Options::default()).expect("it can be solved");
        assert!(!solution.is_certified(), "{text}: {}", solution.objective());
    }
}

/// A touch that is not worth it, and a hold that other controls at the end would leave: both are
/// stationary, and were found from this width and grid.
#[test]
fn what_is_stationary_but_no_optimum_is_left() {
    for name in ["switched/dip", "switched/load_lets_go"] {
        let path = place(name).expect("a kind of models");
        let model = Model::from_file(path.to_str().expect("a path")).expect("it has no mistakes");
        let keys = [("continue", "0.3"), ("sigma", "0"), ("N", "100")];
        let model =
            keys.iter().fold(model, |it, (key, value)| it.with_method(key, *value).expect("a key"));
        let solution = model.solve(&Options::default()).expect("it can be solved");
        let all = references();
        let reference = all.iter().find(|it| it.name == name).expect("a reference").objective;
        assert!(solution.is_certified(), "{name}");
        assert!(relative(solution.objective(), reference) < RIGHT, "{name}");
    }
}

/// `sigma = 0` in a model, or in its place, asks for the true system.
#[test]
fn a_width_of_zero_is_none() {
    let path = place("models/block").expect("a kind of models");
    let model = Model::from_file(path.to_str().expect("a path")).expect("it has no mistakes");
    let with = |sigma: &str| model.with_method("sigma", sigma).expect("a setting");
    let solve = |it: &Model| it.solve(&Options::default()).expect("it can be solved");
    assert!(solve(&with("0")).is_certified());
    assert!(solve(&with("0.1").with_method("sigma", "0").expect("a setting")).is_certified());
    assert!(solve(&with("0.1")).certificate.is_none());
}

/// A width that is named asks for the smoothed problem.
#[test]
fn a_named_width_is_taken() {
    let path = place("models/block").expect("a model");
    let model = Model::from_file(path.to_str().expect("a path")).expect("it has no mistakes");
    let model = model.with_method("sigma", 0.3).expect("a width");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!(solution.certificate.is_none());
    assert!((solution.objective() - 59.835987805166).abs() < 1e-3);
}

/// A block that is pulled with force `F = m f` for a while and rests before and after: with the
/// duration `tau = (36 / (mu g)^2)^(1/4)` the objective is `m^2 (12 / tau^3 + tau (mu g)^2)`. In
/// newtons the forces on a small one count as nothing, and its objective counts as 0.
#[test]
fn a_block_of_any_mass_ends_at_the_same_digits() {
    let friction: f64 = 0.3 * 9.81;
    let tau = (36.0 / friction.powi(2)).powf(0.25);
    let expected = 12.0 / tau.powi(3) + tau * friction.powi(2);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/block.fdc");
    let block = Model::from_file(path.to_str().expect("a path in UTF-8")).expect("it is a model");
    for mass in [2.0, 1e-5, 1e-9, 1e-12] {
        let block = block.with("m", mass).expect("`m` is a parameter");
        let solution = block.solve(&Options::default()).expect("it can be solved");
        let own = solution.objective() / mass.powi(2);
        assert!(solution.is_certified(), "m = {mass}: {}", solution.status_name());
        assert!((own / expected - 1.0).abs() < RIGHT, "m = {mass}: {own} instead of {expected}");
    }
}

/// The block rests, slides under a force that begins at twice the friction `f`, and rests again:
/// `H = F^2 + x' lambda_x + (F - f) lambda_v / m = 0` where it begins to slide, with
/// `lambda_v = -2 m F`. A small push before that, or where it rests in the end, is lost at once, so
/// that `lambda_v = 0` on both holds: it goes on at the entry and jumps at the exit by
/// `kappa = 4 m f`.
#[test]
fn costates_on_holds_are_gradients() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/block.fdc");
    let block = Model::from_file(path.to_str().expect("a path in UTF-8")).expect("it is a model");
    let solution = block.solve(&Options::default()).expect("it can be solved");
    let certificate = solution.certificate.as_ref().expect("the model has a surface");
    let [exit, entry] = &certificate.switches[..] else { panic!("{certificate:?}") };
    let kappa = 4.0 * 2.0 * (0.3 * 2.0 * 9.81);
    assert!((exit.kappa.expect("known") / kappa - 1.0).abs() < RIGHT, "{exit:?}");
    assert!(entry.kappa.expect("known").abs() < RIGHT * kappa, "{entry:?}");
    assert!([exit, entry].iter().all(|it| it.margin.is_some_and(|margin| margin > 0.9)));
    let lambda = solution.costate("v").expect("a state");
    for (time, lambda) in solution.time().iter().zip(lambda) {
        let is_held = *time < exit.time || *time >= entry.time;
        assert!(!is_held || lambda.abs() < RIGHT * kappa, "{lambda} at {time}");
    }
}

/// (Stewart & Anitescu 2005, section 3; the numbers by hand: `lambda_v` falls from -2/5 to -2/3.)
#[test]
fn kappa_is_the_jump_of_the_costate_at_a_crossing() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/coulomb_reverse.fdc");
    let model = Model::from_file(path.to_str().expect("a path in UTF-8")).expect("it is a model");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    let certificate = solution.certificate.as_ref().expect("the model has a surface");
    let kappa = certificate.switches[0].kappa.expect("known");
    assert!((kappa - (2.0 / 3.0 - 2.0 / 5.0)).abs() < 1e-6, "{kappa}");
}

/// Parameters that move what is held at the ends: a start beside the surface is led onto it at
/// once, and the objective does not change; an end beside it costs `4 m f` per speed on one side,
/// and nothing on the other, on which the block is pulled once only, at the end.
#[test]
fn sensitivities_by_what_is_held_at_the_ends_are_those_of_the_true_system() {
    let block = include_str!("../../models/block.fdc");
    let at_start = "param v0 = 0 [m/s]\nstate v [m/s] start v0";
    let at_start = block.replace("state v [m/s] start 0", at_start);
    assert!(sensitivity(&at_start, "v0").abs() < 1e-6);
    assert!((sensitivity(&at_start, "m") / sensitivity(block, "m") - 1.0).abs() < RIGHT);
    let at_end = block.replace("end v == 0", "param v1 = 0 [m/s]\nend v == v1");
    assert!(sensitivity(&at_end, "v1").is_nan(), "there is a kink");
    let below = at_end.replace("v1 = 0", "v1 = -1e-3");
    let kappa = 4.0 * 2.0 * (0.3 * 2.0 * 9.81);
    assert!((sensitivity(&below, "v1") / -kappa - 1.0).abs() < 1e-3);
    let above = at_end.replace("v1 = 0", "v1 = 1e-3");
    assert!(sensitivity(&above, "v1").abs() < 1e-3 * kappa);
}

fn sensitivity(text: &str, parameter: &str) -> f64 {
    let model = Model::from_text("block", text).expect("it is a model");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!(solution.is_certified());
    let found = solution.sensitivities().into_iter().find(|it| it.0 == parameter);
    found.expect("a parameter").1
}

/// A start that is chosen is bounded, too, and may begin on a bound, which is an arc from there on
/// if it stays, and on what holds it. A block of 2 kg comes to rest at 1 m against a friction of
/// 6 N from the speed `v0`, with `3 v0^2` for that: the force falls in a straight line to 0.
#[test]
fn chosen_starts_are_located() {
    let text = |speeds: &str| {
        format!(
            "time t in [0, 4]\nstate x start 0\nstate v in {speeds}
control F in [-12, 12]\nsurface slip = v
dynamics {{ x' = v\n 2*v' in -6*Sgn(slip) + F }}\nend x == 1\nend v == 0
minimize integral(F^2) + 3*v(start)^2"
        )
    };
    // With the duration `d` of the slide after the arc at `v = 1`: `F = 6 (1 - t/d)`, so that
    // `d = 2/3`, which takes 4/9 m; the arc takes 5/9 m with 6 N.
    let on_arc = 36.0 * 5.0 / 9.0 + 36.0 / 3.0 * 2.0 / 3.0 + 3.0;
    // At `v0 = 3/2` the same slide lasts 1 s.
    let at_bound = 36.0 / 3.0 + 3.0 * 1.5 * 1.5;
    for (speeds, expected) in [("[-1, 1]", on_arc), ("[-1, 1.5]", at_bound)] {
        let model = Model::from_text("thrown", &text(speeds)).expect("it is a model");
        let solution = model.solve(&Options::default()).expect("it can be solved");
        assert!(solution.is_certified(), "{speeds}: {}", solution.status_name());
        let found = solution.objective();
        assert!((found / expected - 1.0).abs() < RIGHT, "{speeds}: {found}, not {expected}");
    }
}

/// What is 0 in any magnitude is solved once, and stays 0.
#[test]
fn what_is_nothing_stays_so() {
    let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
dynamics { x' = u + 0.1*sin(x) }\nminimize integral(u^2) + x(end)^2";
    let model = Model::from_text("rest", text).expect("it is a model");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!(solution.is_certified() && solution.objective().abs() < 1e-12);
}
