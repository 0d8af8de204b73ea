//! The pictures that a model asks for, with the borders of its path conditions.

use crate::simulation::Simulation;
use crate::solve::Solution;
use fdcc_compiler::{Border, Model, Plane};

/// `plot name: curves over something with borders`.
///
/// ```
/// let model = fdcc::Model::from_text("shot", "time t in [0, 1]
/// state p(x, y) start (0, 0)
/// control u in [-2, 2]
/// dynamics { p' = (1, u) }
/// path tube: abs(p.y - p.x^2) <= 0.1
/// minimize integral(u^2)
/// plot course: p.y over p.x with tube")?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let [course] = &solution.plots()[..] else { panic!("there is one") };
/// assert_eq!((&course.over[..], &course.curves[0][..]), ("p.x", "p.y"));
/// let [x, y] = course.borders[0].1[0][0];
/// assert!(((y - x * x).abs() - 0.1).abs() < 1e-3);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Its name.
    pub name: String,
    /// The state, control or report on the horizontal axis, or `t`.
    pub over: String,
    /// Those on the vertical one.
    pub curves: Vec<String>,
    /// Where path conditions begin to be violated, by their names.
    pub borders: Vec<(String, Vec<Segment>)>,
}

/// A straight piece between two points of the plane, in SI.
pub type Segment = [[f64; 2]; 2];

/// How many cells a plane is divided into on each side: the error of a border of curvature `c` is
/// about `c h^2/8` with the size `h` of a cell.
const CELLS: usize = 160;

impl Solution {
    /// The pictures that the model asks for.
    pub fn plots(&self) -> Vec<Plot> {
        let unknowns: Vec<(&str, f64)> = self.unknowns().collect();
        let column = |name: &str| self.state(name).or_else(|| self.control(name));
        plots(self.model().meaning(), &unknowns, column)
    }
}

impl Simulation {
    /// The pictures that the model asks for of states over each other or over time.
    pub fn plots(&self, model: &crate::Model) -> Vec<Plot> {
        let Simulation { system, result } = self;
        let column = |name: &str| {
            let at = system.states.iter().position(|it| !it.hidden && it.name == name)?;
            Some(&result.states[at][..])
        };
        let is_known = |name: &String| name == "t" || column(name).is_some();
        let mut all = plots(model.meaning(), &[], column);
        all.retain(|it| is_known(&it.over) && it.curves.iter().all(is_known));
        all
    }
}

/// Those of a model, of which some columns are known.
pub(crate) fn plots<'c>(
    model: &Model,
    unknowns: &[(&str, f64)],
    column: impl Fn(&str) -> Option<&'c [f64]>,
) -> Vec<Plot> {
    let plot = |it: &fdcc_compiler::Plot| {
        let seen = || {
            let first = it.curves.first()?;
            let vector = |name: &str| name.rsplit_once('.').map(|it| it.0.to_owned());
            let is_to_scale = vector(&it.over).is_some() && vector(&it.over) == vector(first);
            Some(around([range(column(&it.over)?)?, range(column(first)?)?], is_to_scale))
        };
        let border = |border: &Border| {
            let plane = Plane::new(model, border, unknowns)?;
            Some((border.place.name.clone(), line(&plane, seen()?)))
        };
        Plot {
            name: it.place.name.clone(),
            over: it.over.clone(),
            curves: it.curves.clone(),
            borders: it.borders.iter().filter_map(border).collect(),
        }
    };
    model.plots.iter().map(plot).collect()
}

/// Where a column begins and ends; nothing where it is empty or not finite.
fn range(column: &[f64]) -> Option<[f64; 2]> {
    let [low, high] = column
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], it| [low.min(*it), high.max(*it)]);
    (low.is_finite() && high.is_finite()).then_some([low, high])
}

/// A plane with as much beyond what is seen as there is of it: a square where both axes have the
/// same scale.
fn around(seen: [[f64; 2]; 2], is_to_scale: bool) -> [[f64; 2]; 2] {
    let [x, y] = seen.map(|[low, high]| high - low);
    let halves = if is_to_scale { [x.max(y); 2] } else { [x, y] };
    [0, 1].map(|axis| {
        let middle = 0.5 * (seen[axis][0] + seen[axis][1]);
        let half = if halves[axis] > 0.0 { halves[axis] } else { 1.0 };
        [middle - half, middle + half]
    })
}

/// The border in a plane. Each cell is cut into two triangles, across which the room is taken for
/// linear.
fn line(plane: &Plane, ends: [[f64; 2]; 2]) -> Vec<Segment> {
    let coordinate = |axis: usize, k: usize| {
        let [low, high] = ends[axis];
        low + (high - low) * k as f64 / CELLS as f64
    };
    let point = |i: usize, j: usize| [coordinate(0, i), coordinate(1, j)];
    let rows = (0..=CELLS).map(|j| (0..=CELLS).map(move |i| [i, j]));
    let room: Vec<f64> = rows.flatten().map(|[i, j]| plane.room(point(i, j))).collect();
    let corner = |i: usize, j: usize| (point(i, j), room[j * (CELLS + 1) + i]);
    let mut segments = Vec::new();
    for (i, j) in (0..CELLS).flat_map(|j| (0..CELLS).map(move |i| (i, j))) {
        let (a, b, c, d) = (corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
        segments.extend([[a, b, c], [a, c, d]].into_iter().filter_map(across));
    }
    segments
}

/// The piece of a border across a triangle, if it has one.
fn across(corners: [([f64; 2], f64); 3]) -> Option<Segment> {
    let edge = |(a, b): (usize, usize)| {
        let ((from, before), (to, behind)) = (corners[a], corners[b]);
        let part = before / (before - behind);
        // What has no value has no side.
        let is_crossed = (before >= 0.0) != (behind >= 0.0) && part.is_finite();
        is_crossed.then(|| [0, 1].map(|axis: usize| from[axis] + part * (to[axis] - from[axis])))
    };
    let mut crossed = [(0, 1), (1, 2), (2, 0)].into_iter().filter_map(edge);
    Some([crossed.next()?, crossed.next()?])
}
