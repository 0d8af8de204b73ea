//! Jumps of several surfaces at one time. The one whose surface is declared first acts first; where
//! the other order leads elsewhere, that is told.

use super::Run;
use crate::simulate::result::Order;
use crate::simulate::tuning::modes::TIE;

impl Run<'_> {
    /// Notes which of some jumps change what the first of them, which acts now, leads to.
    pub fn note_orders(&mut self, due: &[usize]) {
        let [first, others @ ..] = due else { return };
        for other in others {
            let jumps = [*first, *other];
            if self.order_matters(jumps) {
                self.record.orders.push(Order { time: self.t, jumps });
            }
        }
    }

    /// Whether two resets, one after the other, are not those in the other order.
    fn order_matters(&mut self, [one, other]: [usize; 2]) -> bool {
        let [ahead, behind] = [[one, other], [other, one]].map(|jumps| {
            let start = self.x.clone();
            jumps.iter().fold(start, |x, jump| self.field.reset(*jump, self.t, &x))
        });
        let sizes = &self.field.tolerance.sizes;
        ahead
            .iter()
            .zip(&behind)
            .zip(sizes)
            .any(|((a, b), size)| (a - b).abs() > TIE * size.max(a.abs()).max(b.abs()))
    }
}
