//! The points of a curve, in the units in which it is shown. The scripts of a page do the same
//! (`assets/data.js`).

use super::figures::{Curve, Figure, Kind};
use super::json::Json;
use super::units::of_time;

/// Points between which a line is drawn.
pub type Piece = Vec<(f64, f64)>;

/// The pieces of a curve between jumps and gaps.
pub fn pieces(document: &Json, figure: &Figure, curve: &Curve) -> Vec<Piece> {
    let [time, values] = [&curve.time, &curve.values].map(|keys| under(document, keys).column());
    let before = values_before(document, curve, &time);
    let (second, unit) = (of_time(document).si, figure.unit.si);
    let mut all = vec![Piece::new()];
    for (k, &t) in time.iter().enumerate() {
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

fn is_stepped(curve: &Curve) -> bool {
    curve.kind == Kind::Steps
}

/// What stands under some keys.
pub fn under<'j>(document: &'j Json, keys: &[String]) -> &'j Json {
    keys.iter().fold(document, |json, key| json.at(key))
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
    let all = [document.at("jumps"), document.at("certificate").at("switches")];
    let times = all.iter().flat_map(|it| it.list()).filter_map(|it| it.at("time").number());
    let is_polynomial = curve.values.iter().any(|it| it == "control_nodes");
    is_polynomial && times.into_iter().any(|time| from < time && time < to)
}

/// Where a plot begins and ends: flat where values differ by nothing but rounding; a limit that is
/// near is in it.
pub fn range(values: impl Iterator<Item = f64>, limits: &[f64]) -> [f64; 2] {
    let [mut low, mut high] =
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], it| [a.min(it), b.max(it)]);
    if low > high {
        return [-1.0, 1.0];
    }
    let size = low.abs().max(high.abs());
    if high - low <= FLAT * size || size < NOTHING {
        let middle = if size < NOTHING { 0.0 } else { 0.5 * (low + high) };
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

const FLAT: f64 = 1e-9;
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
    fn a_polynomial_control_is_not_drawn_across_a_switch() {
        let all = of(r#"{"time":[0,1],"controls":{"u":[1]},"control_nodes":{"time":[0.1,0.4,0.6],
            "values":{"u":[1,2,8]}},"certificate":{"switches":[{"time":0.5}]}}"#);
        assert_eq!(all[0], [vec![(0.1, 1.0), (0.4, 2.0)], vec![(0.6, 8.0)]]);
    }

    #[test]
    fn a_constant_is_flat_and_a_near_limit_is_seen() {
        let of = |values: &[f64], limits: &[f64]| range(values.iter().copied(), limits);
        let near = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs() + (b - d).abs() < 1e-12;
        assert!(near(of(&[2.0, 2.0 + 1e-12], &[]), [0.88, 3.12]));
        assert!(near(of(&[1e-296], &[]), [-1.12, 1.12]));
        assert!(near(of(&[0.0, 1.0], &[1.5, 9.0]), [-0.09, 1.59]));
        assert!(near(of(&[], &[]), [-1.0, 1.0]));
    }
}
