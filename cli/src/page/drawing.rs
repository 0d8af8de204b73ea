//! What the scripts of a page draw: everything but the numbers of curves.

use super::arrays::{Array, arrays};
use super::colours::COLOURS;
use super::figures::{Figure, figures, parts};
use super::json::Json;
use super::located::all_jumps;
use super::plots::{Portrait, portraits};
use super::runs::events;
use super::strips::{Strip, strips};
use super::units::{Unit, of_time};
use serde::Serialize;

/// What the scripts of a page draw.
#[derive(Serialize)]
pub struct Drawing {
    /// Of the documents.
    pub names: Vec<String>,
    time: Time,
    /// The first and the last time, as shown.
    range: [f64; 2],
    pub figures: Vec<Figure>,
    /// What is drawn as colours.
    pub arrays: Vec<Array>,
    /// Those, as red, green and blue.
    colours: [[u8; 3]; 5],
    /// The pictures that the model asks for.
    pub portraits: Vec<Portrait>,
    /// For each document.
    pub strips: Vec<Vec<Strip>>,
    /// Of the only document.
    marks: Vec<Moment>,
}

#[derive(Serialize)]
pub struct Time {
    name: &'static str,
    label: String,
    unit: String,
    si: f64,
}

/// A time at which something happens, in SI.
#[derive(Serialize)]
pub struct Moment {
    time: f64,
    what: String,
}

impl Drawing {
    /// Of documents with their names.
    pub fn new(documents: &[Json], names: &[&str]) -> Self {
        let Unit { name: unit, si } = of_time(&documents[0]);
        let label = if unit.is_empty() { "t".to_owned() } else { format!("t [{unit}]") };
        let figures = figures(documents);
        Drawing {
            portraits: portraits(documents, &figures),
            arrays: arrays(documents, &figures),
            colours: COLOURS,
            names: names.iter().map(|it| (*it).to_owned()).collect(),
            time: Time { name: "t", label, unit, si },
            range: times(documents).map(|time| time / si),
            figures,
            strips: (0..documents.len()).map(|of| strips(documents, of)).collect(),
            marks: if let [only] = documents { marks(only) } else { Vec::new() },
        }
    }
}

/// The first and the last time of all documents; never empty.
pub fn times(documents: &[Json]) -> [f64; 2] {
    let times = parts(documents).into_iter().flat_map(|part| part.json.at("time").column());
    let finite = times.filter(|time| time.is_finite());
    let [first, last] =
        finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], t| [a.min(t), b.max(t)]);
    if first < last { [first, last] } else { [0.0, 1.0] }
}

/// The jumps, the events of a simulation, the times between phases, and the switches that were
/// located.
fn marks(document: &Json) -> Vec<Moment> {
    let certificate = document.at("certificate");
    let is_certified = certificate.at("certified").is_true();
    let switches = if is_certified { certificate.at("switches").list() } else { &[] };
    let switch = |it: &Json| {
        let [surface, from, to] = ["surface", "from", "to"].map(|key| it.at(key).text());
        let what = format!("{surface}: {from} to {to}");
        Some(Moment { time: it.at("time").number()?, what })
    };
    let jump = |(what, it): (String, &Json)| Some(Moment { time: it.at("time").number()?, what });
    let phase = |(name, it): &(String, Json)| {
        let time = *it.at("time").column().first()?;
        Some(Moment { time, what: name.clone() })
    };
    let phases = document.at("phases").pairs().iter().skip(1).filter_map(phase);
    let event = |(_, it): &(&str, &Json)| {
        let what = format!("{}: {}", it.at("surface").text(), it.at("kind").text());
        Some(Moment { time: it.at("time").number()?, what: what.replace('_', " ") })
    };
    let events = events(document);
    let events = events.iter().filter_map(event);
    let jumps = all_jumps(document).into_iter().filter_map(jump);
    jumps.chain(events).chain(phases).chain(switches.iter().filter_map(switch)).collect()
}
