//! The points of a curve, in the units in which it is shown. The scripts of a page do the same
//! (`assets/data.js`).

use super::figures::{Curve, Figure, Kind};
use super::json::{Json, NULL};
use super::located::all_jumps;
use super::sizes::OF_OWN;
use super::units::of_time;

/// Points between which a line is drawn.
pub type Piece = Vec<(f64, f64)>;

/// The pieces of a curve between jumps and gaps.
pub fn pieces(document: &Json, figure: &Figure, curve: &Curve) -> Vec<Piece> {
    let [time, values] = [&curve.time, &curve.values].map(|keys| under(document, keys).column());
    let before = values_before(document, curve, &time);
    let (second, unit) = (of_time(document).si, figure.unit.si);
    let between = between(document, curve);
    let mut all = vec![Piece::new()];
    for (k, &t) in time.iter().enumerate() {
        if let Some(before) = k.checked_sub(1).and_then(|k| time.get(k)) {
            let inner = inner(&between, [*before, t]).map(|(t, value)| (t / second, value / unit));
            all.last_mut().expect("there is one").extend(inner);
        }
        let value = if is_stepped(curve) { values.get(k).or(values.last()) } else { values.get(k) };
        let value = value.copied().unwrap_or(f64::NAN);
        let point = |value: f64| (t / second, value / unit);
        if is_stepped(curve)
            && let Some(&(_, last)) = all[all.len() - 1].last()
        {
            all.last_mut().expect("there is one").push((t / second, last));
        }
        if let Some((_, value)) = before.iter().find(|(at, _)| *at == k) {
            all.last_mut().expect("there is one").push(point(*value));
            all.push(Piece::new());
        }
        if curve.ends_in_jump && k + 1 == time.len() && k > 1 {
            // It goes on as before up to the jump.
            let slope = (values[k - 1] - values[k - 2]) / (time[k - 1] - time[k - 2]);
            let ahead = values[k - 1] + slope * (t - time[k - 1]);
            all.last_mut().expect("there is one").push(point(ahead));
            all.push(Piece::new());
        }
        let begins = k > 0 && (time[k - 1] == t || jumps(document, curve, [time[k - 1], t]));
        if begins || value.is_nan() {
            all.push(Piece::new());
        }
        if !value.is_nan() {
            all.last_mut().expect("there is one").push(point(value));
        }
    }
    all.retain(|piece| !piece.is_empty());
    all
}

/// Points between those of a grid.
fn between(document: &Json, curve: &Curve) -> Piece {
    let Some(keys) = &curve.between else { return Piece::new() };
    let [time, values] = [0, 1].map(|at| under(document, &keys[at]).column());
    time.into_iter().zip(values).filter(|it| it.0.is_finite() && it.1.is_finite()).collect()
}

/// Those between two times, but for those that may be at one of them: on which side of a jump they
/// are is not known.
fn inner(all: &Piece, [from, to]: [f64; 2]) -> impl Iterator<Item = (f64, f64)> {
    let span = all.first().zip(all.last()).map_or(0.0, |(first, last)| last.0 - first.0);
    let room = ROOM * span;
    let first = all.partition_point(|it| it.0 <= from + room);
    all[first..].iter().take_while(move |it| it.0 < to - room).copied()
}

/// Of the whole time.
const ROOM: f64 = 1e-6;

fn is_stepped(curve: &Curve) -> bool {
    curve.kind == Kind::Steps
}

/// What stands under some keys; that of a list is a place in it.
pub fn under<'j>(document: &'j Json, keys: &[String]) -> &'j Json {
    let inner = |json: &'j Json, key: &String| match json {
        Json::List(list) => key.parse().ok().and_then(|at: usize| list.get(at)).unwrap_or(&NULL),
        _ => json.at(key),
    };
    keys.iter().fold(document, inner)
}

/// A measurement in the units of a plot, and its error bar.
pub struct Point {
    pub time: f64,
    pub value: f64,
    /// From where to where it reaches.
    pub bar: Option<[f64; 2]>,
}

/// The measurements of a curve; rows in which nothing was measured have none.
pub fn points(document: &Json, figure: &Figure, curve: &Curve) -> Vec<Point> {
    let [time, values] = [&curve.time, &curve.values].map(|keys| under(document, keys).column());
    let bars = curve.bars.as_ref().map(|(keys, size)| (under(document, keys).column(), size));
    let (second, unit) = (of_time(document).si, figure.unit.si);
    let point = |(at, (time, value)): (usize, (&f64, &f64))| {
        let bar = bars.as_ref().and_then(|(all, size)| Some(all.get(at)? * **size / unit));
        let value = value / unit;
        let bar = bar.map(|half| [value - half, value + half]);
        Point { time: time / second, value, bar }
    };
    let all = time.iter().zip(&values).enumerate().filter(|it| it.1.1.is_finite());
    all.map(point).collect()
}

/// The values of a state or a costate just before jumps and switches, with the grid points that
/// have those after them.
fn values_before(document: &Json, curve: &Curve, time: &[f64]) -> Vec<(usize, f64)> {
    // That of a phase stands under its name.
    let Some((of, [group, name])) = curve.values.split_last_chunk::<2>() else {
        return Vec::new();
    };
    let document = under(document, of);
    let (list, key) = match group.as_str() {
        "states" => ("jumps", "before"),
        "costates" => ("costates_before", "values"),
        _ => return Vec::new(),
    };
    let nearest = |jump: f64| {
        let distance = |k: &usize| (time[*k] - jump).abs();
        (0..time.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let jump = |it: &Json| Some((nearest(it.at("time").number()?)?, it.at(key).at(name).number()?));
    document.at(list).list().iter().filter_map(jump).collect()
}

/// Whether a polynomial control may jump between two of its times.
fn jumps(document: &Json, curve: &Curve, [from, to]: [f64; 2]) -> bool {
    let switches = document.at("certificate").at("switches").list().iter();
    let all = all_jumps(document).into_iter().map(|it| it.1).chain(switches);
    let mut times = all.filter_map(|it| it.at("time").number());
    let is_polynomial = curve.values.iter().any(|it| it == "control_nodes");
    is_polynomial && times.any(|time| from < time && time < to)
}

/// Where a plot begins and ends: flat where values differ by nothing but rounding (`sizes.rs`); a
/// limit that is near is in it.
pub fn range(values: impl Iterator<Item = f64>, limits: &[f64], rounding: f64) -> [f64; 2] {
    let [mut low, mut high] =
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], it| [a.min(it), b.max(it)]);
    if low > high {
        return [-1.0, 1.0];
    }
    let size = low.abs().max(high.abs());
    let is_nothing = size <= rounding.max(NOTHING);
    if high - low <= rounding.max(OF_OWN * size) || is_nothing {
        let middle = if is_nothing { 0.0 } else { 0.5 * (low + high) };
        let room = if middle == 0.0 { 1.0 } else { 0.5 * middle.abs() };
        [low, high] = [middle - room, middle + room];
    }
    for limit in limits {
        let reach = NEAR * (high - low);
        if (low - reach..=high + reach).contains(limit) {
            [low, high] = [low.min(*limit), high.max(*limit)];
        }
    }
    let margin = MARGIN * (high - low);
    [low - margin, high + margin]
}

const NOTHING: f64 = 1e-50;
const NEAR: f64 = 0.7;
const MARGIN: f64 = 0.06;

#[cfg(test)]
mod tests {
    use super::super::figures::figures;
    use super::*;

    fn of(text: &str) -> Vec<Vec<Piece>> {
        let document = [serde_json::from_str(text).expect("it is JSON")];
        let figures = figures(&document);
        figures.iter().map(|it| pieces(&document[0], it, &it.curves[0])).collect()
    }

    #[test]
    fn a_state_has_both_sides_of_a_jump_and_a_control_has_steps() {
        let all = of(r#"{"time":[0,1,2],"states":{"v":[0,-2,3]},"controls":{"u":[1,4]},
            "jumps":[{"time":2,"before":{"v":-4}}],
            "display_units":{"time":{"unit":"ms","si":0.5},"v":{"unit":"x","si":2}}}"#);
        assert_eq!(all[0], [vec![(0.0, 0.0), (2.0, -1.0), (4.0, -2.0)], vec![(4.0, 1.5)]]);
        let steps = vec![(0.0, 1.0), (2.0, 1.0), (2.0, 4.0), (4.0, 4.0), (4.0, 4.0)];
        assert_eq!(all[1], [steps]);
    }

    #[test]
    fn a_phase_goes_on_up_to_the_jump_behind_it() {
        let all = of(r#"{"phases":{"a":{"time":[0,1,2,3],"costates":{"x":[1,2,3,-50]}}}}"#);
        let before = vec![(0.0, 1.0), (1.0, 2.0), (2.0, 3.0), (3.0, 4.0)];
        assert_eq!(all[0], [before, vec![(3.0, -50.0)]]);
    }

    /// Three nodes of a certified solution, and what its replay does between them.
    #[test]
    fn a_certified_state_goes_through_its_replay_between_nodes() {
        let text = |certified: bool| {
            format!(
                r#"{{"time":[0,1,2],"states":{{"x":[0,1,5]}},"jumps":[{{"time":1,"before":
                    {{"x":2}}}}],"certificate":{{"certified":{certified}}},"verification":{{
                    "state_gap":1e-9,"replay":{{"time":[0,0.5,1,1.5,2],
                    "states":{{"x":[0,0.7,2,3,5]}}}}}}}}"#
            )
        };
        let through =
            [vec![(0.0, 0.0), (0.5, 0.7), (1.0, 2.0)], vec![(1.0, 1.0), (1.5, 3.0), (2.0, 5.0)]];
        assert_eq!(of(&text(true))[0], through);
        assert_eq!(of(&text(false))[0][1], [(1.0, 1.0), (2.0, 5.0)]);
    }

    #[test]
    fn measurements_have_bars_in_the_unit_of_their_plot_and_gaps() {
        let text = r#"{"time":[0,1],"states":{"x":[0,1]},"estimates":{"noise":"given"},
            "display_units":{"x":{"unit":"mm","si":0.001}},
            "residuals":[{"signal":"x","time":[0.5,0.7],"values":[1,null],"measured":[2,null],
            "deviation":[0.25,null]}]}"#;
        let document = [serde_json::from_str(text).expect("it is JSON")];
        let figures = figures(&document);
        let all = points(&document[0], &figures[0], &figures[0].curves[1]);
        let all: Vec<_> = all.iter().map(|it| (it.time, it.value, it.bar)).collect();
        assert_eq!(all, [(0.5, 2000.0, Some([1750.0, 2250.0]))]);
    }

    #[test]
    fn a_polynomial_control_is_not_drawn_across_a_switch() {
        let all = of(r#"{"time":[0,1],"controls":{"u":[1]},"control_nodes":{"time":[0.1,0.4,0.6],
            "values":{"u":[1,2,8]}},"certificate":{"switches":[{"time":0.5}]}}"#);
        assert_eq!(all[0], [vec![(0.1, 1.0), (0.4, 2.0)], vec![(0.6, 8.0)]]);
    }

    #[test]
    fn a_constant_is_flat_and_a_near_limit_is_seen() {
        let of = |values: &[f64], limits: &[f64]| range(values.iter().copied(), limits, 1e-9);
        let near = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs() + (b - d).abs() < 1e-12;
        assert!(near(of(&[2.0, 2.0 + 1e-12], &[]), [0.88, 3.12]));
        assert!(near(of(&[1e-296], &[]), [-1.12, 1.12]));
        assert!(near(of(&[0.0, 1.0], &[1.5, 9.0]), [-0.09, 1.59]));
        assert!(near(of(&[], &[]), [-1.0, 1.0]));
        assert!(near(of(&[1e-33, -1e-35], &[]), [-1.12, 1.12]), "rounding beside what counts");
        let script = include_str!("assets/data.js");
        for rule in [format!("{OF_OWN:e} * size"), format!("{NEAR} * width"), format!("{MARGIN} *")]
        {
            assert!(script.contains(&rule), "the scripts have another rule than {rule}");
        }
        let costate = of(&[-32.978415, -32.978377], &[]);
        assert!(costate[1] - costate[0] > 30.0, "rounding of a page: {costate:?}");
    }
}
