//! How an optimum moves with parameters, as a table: what `fdcc solve --wrt` found.

use super::json::Json;
use super::tags::{Cell, table};
use super::units::{Unit, of_time, of_value, per};

/// What moves: an unknown, or a time at which the solution switches or reaches or leaves a bound.
struct Moved {
    what: String,
    unit: Unit,
    value: f64,
    /// By each parameter, in SI; nothing where the optimum leaves it open.
    by: Vec<(String, Option<f64>)>,
}

/// One row for each thing that moves and each parameter, the largest effect of each thing first.
pub fn moves(document: &Json) -> String {
    let derivatives = document.at("derivatives").pairs();
    let none = derivatives.iter().filter(|(_, it)| *it == Json::Null);
    let none = none.map(|(name, _)| {
        let words = [name.as_str(), "", "", "none: a kink, or no strict minimum", ""];
        words.map(Cell::text).into()
    });
    let all = unknowns(document).chain(junctions(document));
    let rows: Vec<Vec<Cell>> = all.flat_map(|it| it.rows(document)).chain(none).collect();
    let head = ["", "is", "with", "moves per unit", "1 % more moves it by", ""];
    table("How the optimum moves", &head, &rows)
}

fn unknowns(document: &Json) -> impl Iterator<Item = Moved> + '_ {
    let by = |name: &str| {
        let all = found(document).map(|(parameter, it)| {
            let slope = it.at("free").at(name).number();
            (parameter.to_owned(), slope)
        });
        all.collect()
    };
    let of = move |(name, value): &(String, Json)| Moved {
        what: name.clone(),
        unit: of_value(document, name),
        value: value.number().unwrap_or(f64::NAN),
        by: by(name),
    };
    document.at("free").pairs().iter().map(of)
}

/// All parameters move the same ones: those of the solution.
fn junctions(document: &Json) -> impl Iterator<Item = Moved> + '_ {
    let count = found(document).map(|it| it.1.at("junctions").list().len()).max();
    (0..count.unwrap_or(0)).filter_map(move |at| {
        let of = |it: &'static str| {
            move |json: &Json| {
                json.at("junctions").list().get(at).and_then(|own| own.at(it).number())
            }
        };
        let (time, derivative) = (of("time"), of("derivative"));
        let by = found(document).map(|(parameter, it)| (parameter.to_owned(), derivative(it)));
        let value = found(document).find_map(|(_, it)| time(it))?;
        Some(Moved {
            what: format!("junction {}", at + 1),
            unit: of_time(document),
            value,
            by: by.collect(),
        })
    })
}

/// The parameters by which there is a derivative.
fn found(document: &Json) -> impl Iterator<Item = (&str, &Json)> {
    let all = document.at("derivatives").pairs().iter();
    all.filter(|(_, it)| *it != Json::Null).map(|(name, it)| (name.as_str(), it))
}

impl Moved {
    fn rows(self, document: &Json) -> Vec<Vec<Cell>> {
        let effect = |(name, slope): &(String, Option<f64>)| {
            let value = document.at("params").at(name).number()?;
            Some(0.01 * value * (*slope)?)
        };
        let size = |it: &(String, Option<f64>)| effect(it).map_or(0.0, f64::abs);
        let most = self.by.iter().map(size).fold(0.0, f64::max);
        let mut by = self.by.clone();
        by.sort_by(|a, b| size(b).total_cmp(&size(a)));
        let row = |(at, it): (usize, &(String, Option<f64>))| {
            let parameter = of_value(document, &it.0);
            let told = |value: Option<f64>, unit: &Unit| match value {
                Some(value) => unit.value(value, 5),
                None => "left open".into(),
            };
            let is_first = at == 0;
            vec![
                Cell::text(if is_first { self.what.as_str() } else { "" }),
                Cell::Number(if is_first { self.unit.value(self.value, 7) } else { "".into() }),
                Cell::text(it.0.as_str()),
                Cell::Number(told(it.1, &per(&self.unit, &parameter))),
                Cell::Number(told(effect(it), &self.unit)),
                Cell::Bar(if most > 0.0 { effect(it).unwrap_or(0.0) / most } else { 0.0 }),
            ]
        };
        by.iter().enumerate().map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_is_told_in_its_units_and_the_largest_effect_first() {
        let text = r#"{"params":{"m":2,"mu":0.5,"k":1},"free":{"T":3},
            "display_units":{"m":{"unit":"g","si":0.001},"T":{"unit":"ms","si":0.001},
            "time":{"unit":"ms","si":0.001}},
            "derivatives":{"m":{"free":{"T":0.5},"junctions":[{"time":1,"derivative":null}]},
            "mu":{"free":{"T":-8},"junctions":[{"time":1,"derivative":0.25}]},"k":null}}"#;
        let page = moves(&serde_json::from_str(text).expect("it is JSON"));
        let row = |name: &str| page.find(&format!("<td>{name}</td>")).expect("a row");
        assert!(row("mu") < row("m"), "-40 ms before 10 ms: {page}");
        assert!(page.contains("<td class=\"number\">-8000 ms</td>"), "{page}");
        assert!(page.contains("<td class=\"number\">0.5 ms per g</td>"), "{page}");
        assert!(page.contains("<td class=\"number\">-40 ms</td>"), "{page}");
        assert!(page.contains("junction 1") && page.contains("left open"));
        assert!(page.contains("<td>k</td>") && page.contains("none: a kink"));
        assert_eq!(moves(&Json::Null), "");
    }
}
