//! Pictures of the rows of a sweep: values over one number, or as colours over two.

use super::colours::{SCALE, colour, draw_scale};
use super::curves::range;
use super::svg::{Area, Drawn, FINE, HELD, LIMIT, PLAN, WIDTH, canvas, chart, draw_axes, line};
use super::sweep::Sort;
use plotters::prelude::*;

const HEIGHT: i32 = 340;
const RADIUS: i32 = 3 * FINE;

/// A value over a number for each row.
pub struct Dots {
    titles: [String; 2],
    ranges: [[f64; 2]; 2],
    points: Vec<(f64, f64, Sort)>,
    is_line: bool,
}

impl Dots {
    /// Of points with how they count; a point without a value is a cross at the foot of the plot.
    pub fn new(titles: [&String; 2], mut points: Vec<(f64, f64, Sort)>, is_line: bool) -> Self {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let known = |value: &f64| value.is_finite();
        let ranges = [
            range(points.iter().map(|it| it.0).filter(known), &[], 0.0),
            range(points.iter().map(|it| it.1).filter(known), &[], 0.0),
        ];
        Dots { titles: titles.map(Clone::clone), ranges, points, is_line }
    }

    /// Drawn.
    pub fn svg(&self) -> String {
        canvas([WIDTH, HEIGHT], |area| self.draw(area))
    }

    fn draw(&self, area: &Area) -> Drawn {
        let mut chart = chart(area, self.ranges)?;
        draw_axes(&mut chart, self.ranges, &self.titles)?;
        if self.is_line {
            // A row without a value is a gap.
            for piece in self.points.split(|it| !it.1.is_finite()) {
                let piece: Vec<(f64, f64)> = piece.iter().map(|it| (it.0, it.1)).collect();
                line(&mut chart, &piece, PLAN)?;
            }
        }
        let fine = self.points.iter().filter(|it| it.2 == Sort::Fine && it.1.is_finite());
        chart.draw_series(fine.map(|it| Circle::new((it.0, it.1), RADIUS, PLAN.filled())))?;
        let open = self.points.iter().filter(|it| it.2 == Sort::Open && it.1.is_finite());
        let ring = HELD.stroke_width(2 * FINE as u32);
        chart.draw_series(open.map(|it| Circle::new((it.0, it.1), RADIUS + FINE, ring)))?;
        let failed = self.points.iter().filter(|it| it.0.is_finite() && !it.1.is_finite());
        let foot = self.ranges[1][0];
        let cross = LIMIT.stroke_width(2 * FINE as u32);
        chart
            .draw_series(failed.map(|it| Cross::new((it.0, foot), RADIUS + FINE, cross)))
            .map(|_| ())
    }
}

/// A value over two numbers for each row.
pub struct Cells {
    titles: [String; 2],
    of: String,
    /// The values of each axis in their order.
    axes: [Vec<f64>; 2],
    cells: Vec<([f64; 2], f64, Sort)>,
}

impl Cells {
    /// Of places with their values.
    pub fn new(titles: [&String; 2], of: &str, cells: Vec<([f64; 2], f64, Sort)>) -> Self {
        let axis = |at: usize| {
            let mut all: Vec<f64> = cells.iter().map(|it| it.0[at]).collect();
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        };
        let axes = [axis(0), axis(1)];
        Cells { titles: titles.map(Clone::clone), of: of.to_owned(), axes, cells }
    }

    /// Drawn.
    pub fn svg(&self) -> String {
        canvas([WIDTH, HEIGHT], |area| self.draw(area))
    }

    /// The lowest and the highest value.
    fn values(&self) -> [f64; 2] {
        let known = self.cells.iter().map(|it| it.1).filter(|it| it.is_finite());
        known.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], it| [a.min(it), b.max(it)])
    }

    /// From where to where a cell goes: half way to its neighbours.
    fn reach(&self, axis: usize, value: f64) -> [f64; 2] {
        let all = &self.axes[axis];
        let at = all.iter().position(|it| *it == value).expect("it is one of them");
        let half = |a: usize, b: usize| 0.5 * (all[b] - all[a]);
        let one = all.len() == 1;
        let before = if one {
            0.5
        } else if at > 0 {
            half(at - 1, at)
        } else {
            half(0, 1)
        };
        let last = all.len() - 1;
        let after = if one {
            0.5
        } else if at < last {
            half(at, at + 1)
        } else {
            half(last - 1, last)
        };
        [value - before, value + after]
    }

    fn draw(&self, area: &Area) -> Drawn {
        let (map, scale) = area.split_horizontally((WIDTH - SCALE) * FINE);
        let ranges = [0, 1].map(|axis| {
            let (first, last) = (self.axes[axis][0], self.axes[axis][self.axes[axis].len() - 1]);
            [self.reach(axis, first)[0], self.reach(axis, last)[1]]
        });
        let mut chart = chart(&map, ranges)?;
        draw_axes(&mut chart, ranges, &self.titles)?;
        let known = self.values();
        for ([x, y], value, _) in self.cells.iter().filter(|it| it.1.is_finite()) {
            let ([left, right], [low, high]) = (self.reach(0, *x), self.reach(1, *y));
            let cell = Rectangle::new([(left, low), (right, high)], colour(*value, known).filled());
            chart.draw_series([cell])?;
        }
        let middle = |it: &&([f64; 2], f64, Sort)| (it.0[0], it.0[1]);
        let open = self.cells.iter().filter(|it| it.1.is_finite() && it.2 == Sort::Open);
        let ring = HELD.stroke_width(2 * FINE as u32);
        chart.draw_series(open.map(|it| Circle::new(middle(&it), RADIUS, ring)))?;
        let failed = self.cells.iter().filter(|it| !it.1.is_finite());
        let cross = LIMIT.stroke_width(2 * FINE as u32);
        chart.draw_series(failed.map(|it| Cross::new(middle(&it), RADIUS + FINE, cross)))?;
        draw_scale(&scale, &self.of, known, HEIGHT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_goes_half_way_to_its_neighbours() {
        let place = |x: f64| ([x, 7.0], 1.0, Sort::Fine);
        let cells = Cells::new([&"a".into(), &"b".into()], "J", [0.0, 1.0, 4.0].map(place).into());
        assert_eq!(cells.reach(0, 1.0), [0.5, 2.5]);
        assert_eq!(cells.reach(0, 0.0), [-0.5, 0.5]);
        assert_eq!(cells.reach(0, 4.0), [2.5, 5.5]);
        assert_eq!(cells.reach(1, 7.0), [6.5, 7.5]);
    }

    #[test]
    fn what_failed_is_a_cross_and_a_gap() {
        let points =
            vec![(0.0, 1.0, Sort::Fine), (1.0, f64::NAN, Sort::Failed), (2.0, 2.0, Sort::Open)];
        let svg = Dots::new([&"a".into(), &"J".into()], points, true).svg();
        let of = |it: RGBColor| format!("#{:02X}{:02X}{:02X}", it.0, it.1, it.2);
        assert_eq!(svg.lines().filter(|it| it.contains(&of(LIMIT))).count(), 2, "a cross: {svg}");
        assert_eq!(svg.matches("<circle").count(), 2);
    }
}
