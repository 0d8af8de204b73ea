//! The pictures that a model asks for: signals over time in one plot, or one over another.

use super::figures::{CONTROLS, Curve, Figure, Kind, REPORTED, STATES, parts};
use super::json::Json;
use serde::Serialize;

/// What the group of those over time is called.
pub const PLOTS: &str = "Pictures of the model";

/// Signals over another one.
#[derive(Debug, Serialize)]
pub struct Portrait {
    pub name: String,
    /// Their places among the figures.
    pub over: usize,
    pub of: Vec<usize>,
    /// Whether both axes have the same scale: they are parts of one vector.
    pub is_to_scale: bool,
    /// The keys that lead to pieces of borders, with their document.
    pub borders: Vec<(usize, Vec<String>)>,
}

/// A picture as a document has it.
struct Asked<'j> {
    of: usize,
    keys: Vec<String>,
    name: &'j str,
    json: &'j Json,
}

impl<'j> Asked<'j> {
    fn over(&self) -> &'j str {
        self.json.at("over").text()
    }

    fn curves(&self) -> Vec<&'j str> {
        self.json.at("curves").list().iter().map(Json::text).collect()
    }
}

/// The first picture of each name in all documents and phases.
fn asked(documents: &[Json]) -> Vec<Asked<'_>> {
    let mut all: Vec<Asked> = Vec::new();
    for part in parts(documents) {
        for (name, json) in part.json.at("plots").pairs() {
            let keys = [&part.keys[..], &["plots".to_owned(), name.clone()]].concat();
            if all.iter().all(|it| it.name != name) {
                all.push(Asked { of: part.of, keys, name, json });
            }
        }
    }
    all
}

/// Signals over time in one plot.
pub fn over_time(documents: &[Json], figures: &[Figure]) -> Vec<Figure> {
    let figure = |it: &Asked| {
        let own: Vec<&Figure> = it
            .curves()
            .into_iter()
            .filter_map(|name| Some(&figures[find(figures, name)?]))
            .collect();
        let curves = own.iter().enumerate().flat_map(|(hue, figure)| {
            let plan = figure.curves.iter().filter(|curve| curve.kind != Kind::Replay);
            plan.map(move |it| Curve { label: figure.name.clone(), hue: Some(hue), ..it.clone() })
        });
        let unit = own.first()?.unit.clone();
        let is_alike = own.iter().all(|other| other.unit == unit);
        let curves: Vec<Curve> = curves.collect();
        let mut figure = Figure::new(PLOTS, it.name, unit);
        figure.curves = curves;
        figure.rounding = own.iter().map(|it| it.rounding).fold(0.0, f64::max);
        is_alike.then_some(figure)
    };
    let all = asked(documents);
    all.iter().filter(|it| it.over() == "t").filter_map(figure).collect()
}

/// Signals over another one.
pub fn portraits(documents: &[Json], figures: &[Figure]) -> Vec<Portrait> {
    let portrait = |it: &Asked| {
        let over = find(figures, it.over())?;
        let curves = it.curves();
        let of: Vec<usize> = curves.iter().filter_map(|name| find(figures, name)).collect();
        let border = |name: &String| {
            let keys = ["borders".to_owned(), name.clone()];
            (it.of, [&it.keys[..], &keys].concat())
        };
        let borders = it.json.at("borders").pairs().iter().map(|(name, _)| border(name)).collect();
        let vector = |name: &str| name.rsplit_once('.').map(|it| it.0.to_owned());
        let own = vector(it.over());
        let is_to_scale = own.is_some() && curves.iter().all(|name| vector(name) == own);
        let name = it.name.to_owned();
        (!of.is_empty()).then_some(Portrait { name, over, of, is_to_scale, borders })
    };
    let all = asked(documents);
    all.iter().filter(|it| it.over() != "t").filter_map(portrait).collect()
}

/// The figure of a state, a control or a report.
fn find(figures: &[Figure], name: &str) -> Option<usize> {
    let is_signal = |it: &Figure| [STATES, CONTROLS, REPORTED].contains(&it.group);
    figures.iter().position(|it| is_signal(it) && it.name == name)
}

#[cfg(test)]
mod tests {
    use super::super::figures::figures;
    use super::*;

    fn document() -> Vec<Json> {
        let text = r#"{"time":[0,1],"states":{"p.x":[0,1],"p.y":[0,2],"v":[1,2]},
            "display_units":{"v":{"unit":"m","si":1}},
            "plots":{"course":{"over":"p.x","curves":["p.y"],"borders":{"wall":[[[0,1],[1,1]]]}},
            "both":{"over":"t","curves":["p.x","p.y"]},"mixed":{"over":"t","curves":["p.x","v"]},
            "speed":{"over":"p.x","curves":["v"]}}}"#;
        vec![serde_json::from_str(text).expect("it is JSON")]
    }

    #[test]
    fn parts_of_a_vector_are_to_scale_and_have_their_borders() {
        let documents = document();
        let all = portraits(&documents, &figures(&documents));
        let found: Vec<_> = all.iter().map(|it| (&it.name[..], it.is_to_scale)).collect();
        assert_eq!(found, [("course", true), ("speed", false)]);
        assert_eq!((all[0].over, &all[0].of[..]), (0, &[1][..]));
        assert_eq!(
            all[0].borders,
            [(0, ["plots", "course", "borders", "wall"].map(str::to_owned).to_vec())]
        );
    }

    #[test]
    fn signals_of_one_unit_share_a_plot_over_time() {
        let documents = document();
        let all = figures(&documents);
        let own: Vec<_> = all.iter().filter(|it| it.group == PLOTS).collect();
        assert_eq!(own.len(), 1, "what measures something else has no place on the same axis");
        let hues: Vec<_> = own[0].curves.iter().map(|it| (&it.label[..], it.hue)).collect();
        assert_eq!(hues, [("p.x", Some(0)), ("p.y", Some(1))]);
    }
}
