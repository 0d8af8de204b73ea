//! The multipliers of bounds that act at one time: as stems over time, and as a table.

use super::figures::{Curve, Figure, IMPULSES, Kind};
use super::json::Json;
use super::tags::{Cell, table};
use super::units::{Unit, of_condition, of_time, of_value, per};

/// Those of what is certified, by the names of their conditions.
fn known(document: &Json) -> &[(String, Json)] {
    let certificate = document.at("certificate");
    let is_certified = certificate.at("certified").is_true();
    if is_certified { certificate.at("impulses").pairs() } else { &[] }
}

fn unit(document: &Json, condition: &str) -> Unit {
    per(&of_value(document, "objective"), &of_condition(document, condition))
}

/// Adds a plot for each condition that has any.
pub fn add(documents: &[Json], figures: &mut Vec<Figure>) {
    for (of, document) in documents.iter().enumerate() {
        for (name, _) in known(document) {
            let unit = unit(document, name);
            let is_it =
                |it: &&mut Figure| it.group == IMPULSES && it.name == *name && it.unit == unit;
            let keys = |key: &str| ["certificate", "impulses", name, key].map(str::to_owned).into();
            let (time, values, label) = (keys("time"), keys("values"), "plan".to_owned());
            let curve = Curve { label, of, kind: Kind::Stems, time, values, ..Curve::default() };
            match figures.iter_mut().find(is_it) {
                Some(figure) => figure.curves.push(curve),
                None => {
                    let mut figure = Figure::new(IMPULSES, name, unit);
                    figure.curves.push(curve);
                    figures.push(figure);
                }
            }
        }
    }
}

/// Which there are, when and how large.
pub fn impulses(document: &Json) -> String {
    let of = |(name, it): &(String, Json)| -> Vec<Vec<Cell>> {
        let all = it.at("time").column().into_iter().zip(it.at("values").column());
        let row = |(time, value): (f64, f64)| {
            vec![
                Cell::text(name.as_str()),
                Cell::Number(of_time(document).value(time, 7)),
                Cell::Number(unit(document, name).value(value, 6)),
            ]
        };
        all.map(row).collect()
    };
    let rows: Vec<_> = known(document).iter().flat_map(of).collect();
    let head = ["condition", "time", "objective per unit"];
    table("Multipliers of bounds at one time", &head, &rows)
}

#[cfg(test)]
mod tests {
    use super::super::figures::figures;
    use super::*;

    fn document(certified: bool) -> [Json; 1] {
        let text = format!(
            r#"{{"time":[0,1],"display_units":{{"top":{{"unit":"mm","si":0.001}}}},
                "certificate":{{"certified":{certified},"impulses":{{"top":{{"time":[0.5],
                "values":[-9600]}}}}}}}}"#
        );
        [serde_json::from_str(&text).expect("it is JSON")]
    }

    #[test]
    fn a_touch_is_a_stem_in_units_of_the_objective_per_condition() {
        let all = figures(&document(true));
        assert_eq!((all.len(), all[0].signal().as_str()), (1, "impulse(top)"));
        assert_eq!((all[0].unit.name.as_str(), all[0].curves[0].kind), ("1 per mm", Kind::Stems));
        let page = impulses(&document(true)[0]);
        assert!(page.contains("<td class=\"number\">-9.6 1 per mm</td>"), "{page}");
    }

    /// The answer is the smoothed one then, and these are of another.
    #[test]
    fn what_is_not_certified_has_none() {
        assert!(figures(&document(false)).is_empty());
        assert_eq!(impulses(&document(false)[0]), "");
    }
}
