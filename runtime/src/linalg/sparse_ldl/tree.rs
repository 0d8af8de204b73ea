//! Which rows are eliminated together, and in which order: the elimination tree, some of whose
//! nodes are merged.

use super::pairs::Pairs;
use crate::linalg::structure::columns::Columns;

/// Nodes that eliminate fewer rows than this are merged with their parent although that makes zeros
/// into entries.
const SMALL: usize = 8;

/// Some rows that are eliminated together. Its front is the dense matrix over [`own`](Self::own),
/// [`rest`](Self::rest), and what its children could not eliminate.
#[derive(Clone, Debug, Default)]
pub(super) struct Node {
    /// Rows that are eliminated here.
    pub(super) own: Vec<u32>,
    /// Rows that change, and are eliminated nearer to the root. Empty at a root only.
    pub(super) rest: Vec<u32>,
    /// Entries of the matrix that are added here.
    pub(super) entries: Vec<Entry>,
    /// How many nodes have this one for their parent.
    pub(super) children: usize,
}

/// An entry of the matrix, and which of its values it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) row: u32,
    pub(super) column: u32,
    pub(super) value: u32,
}

impl Node {
    /// How many multiplications the elimination takes, about, if nothing is left over by children.
    pub(super) fn multiplications(&self) -> f64 {
        multiplications(self.own.len(), self.own.len() + self.rest.len())
    }
}

/// About how many multiplications it takes to eliminate so many rows of a front of this size.
pub(super) fn multiplications(rows: usize, size: usize) -> f64 {
    (0..rows).map(|k| ((size - k) as f64).powi(2)).sum()
}

/// The nodes, children before their parents and next to them as a stack wants it. `pattern` is an
/// upper triangle.
pub(super) fn nodes(pattern: &Columns, pairs: &Pairs) -> Vec<Node> {
    let order = order_of_pairs(pattern, pairs);
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(at, row)| place[*row] = at);
    let is_pair = |at: usize| order.get(at + 1) == Some(&pairs.partner(order[at]));
    let is_pair: Vec<bool> = (0..order.len()).map(is_pair).collect();
    let mut forest = Forest::new(pattern, &place, &is_pair);
    let mut nodes = forest.in_postorder();
    for row in nodes.iter_mut().flat_map(|node| node.own.iter_mut().chain(&mut node.rest)) {
        *row = order[*row as usize] as u32;
    }
    add_entries(&mut nodes, pattern, &place);
    nodes
}

/// A fill-reducing order in which partners follow each other.
fn order_of_pairs(pattern: &Columns, pairs: &Pairs) -> Vec<usize> {
    let members = pairs.members();
    let mut home = vec![0; pattern.rows];
    members.iter().enumerate().for_each(|(at, rows)| rows.iter().for_each(|it| home[*it] = at));
    let place = |(row, column, _): (usize, usize, usize)| {
        let (a, b) = (home[row], home[column]);
        Some((a.min(b), a.max(b)))
    };
    let places: Vec<_> = pattern.places().map(place).collect();
    let (compressed, _) = Columns::of_places(&places, members.len(), members.len());
    let order = fill_reducing_order(&compressed);
    order.into_iter().flat_map(|at| members[at].iter().copied()).collect()
}

/// Approximate minimum degree (Amestoy, Davis, Duff 1996): which row is eliminated first, second,
/// ...
fn fill_reducing_order(pattern: &Columns) -> Vec<usize> {
    let (size, starts) = (pattern.rows, &pattern.column_starts);
    let order = amd::order(size, starts, &pattern.row_indices, &amd::Control::default());
    order.map_or_else(|_| (0..size).collect(), |(order, ..)| order)
}

/// An entry is added where the first of its two rows is eliminated.
fn add_entries(nodes: &mut [Node], pattern: &Columns, place: &[usize]) {
    let mut home = vec![0; place.len()];
    for (at, node) in nodes.iter().enumerate() {
        node.own.iter().for_each(|row| home[*row as usize] = at);
    }
    for column in 0..pattern.rows {
        for value in pattern.column_starts[column]..pattern.column_starts[column + 1] {
            let row = pattern.row_indices[value];
            let first = if place[row] < place[column] { row } else { column };
            let entry = Entry { row: row as u32, column: column as u32, value: value as u32 };
            nodes[home[first]].entries.push(entry);
        }
    }
}

/// The elimination tree in the making. A node has the place of the last row that it eliminates;
/// nodes that were merged are empty.
struct Forest {
    nodes: Vec<Node>,
    children: Vec<Vec<usize>>,
    roots: Vec<usize>,
}

impl Forest {
    /// `is_pair[at]`: the row at this place is to be eliminated with the next one.
    fn new(pattern: &Columns, place: &[usize], is_pair: &[bool]) -> Self {
        let mut forest = Forest {
            nodes: lower_triangle(pattern, place),
            children: vec![Vec::new(); place.len()],
            roots: Vec::new(),
        };
        let mut seen = vec![usize::MAX; place.len()];
        for at in 0..place.len() {
            forest.collect_rest(at, &mut seen);
            forest.merge_children(at, at > 0 && is_pair[at - 1]);
            match forest.nodes[at].rest.iter().min() {
                Some(parent) => forest.children[*parent as usize].push(at),
                None => forest.roots.push(at),
            }
        }
        forest
    }

    /// What changes with the elimination of a row: its entries below the diagonal, and what its
    /// children leave.
    fn collect_rest(&mut self, at: usize, seen: &mut [usize]) {
        let mut rest = std::mem::take(&mut self.nodes[at].rest);
        for child in &self.children[at] {
            rest.extend(&self.nodes[*child].rest);
        }
        seen[at] = at;
        rest.retain(|row| std::mem::replace(&mut seen[*row as usize], at) != at);
        self.nodes[at].rest = rest;
    }

    /// Merges the node with those of its children that lose nothing by it, or are small, or end
    /// with its partner.
    fn merge_children(&mut self, at: usize, is_after_partner: bool) {
        let children = std::mem::take(&mut self.children[at]);
        for child in children {
            let (below, above) = (&self.nodes[child], &self.nodes[at]);
            let has_same_rows = below.rest.len() == above.own.len() + above.rest.len();
            let is_partner = is_after_partner && child + 1 == at;
            if has_same_rows || is_partner || (below.own.len() < SMALL && above.own.len() < SMALL) {
                let mut own = std::mem::take(&mut self.nodes[child]).own;
                own.append(&mut self.nodes[at].own);
                self.nodes[at].own = own;
                let mut grandchildren = std::mem::take(&mut self.children[child]);
                self.children[at].append(&mut grandchildren);
            } else {
                self.children[at].push(child);
            }
        }
    }

    fn in_postorder(&mut self) -> Vec<Node> {
        let mut nodes = Vec::new();
        let mut open: Vec<(usize, bool)> = self.roots.iter().map(|root| (*root, false)).collect();
        while let Some((at, is_done)) = open.pop() {
            if is_done {
                let children = self.children[at].len();
                nodes.push(Node { children, ..std::mem::take(&mut self.nodes[at]) });
            } else {
                open.push((at, true));
                open.extend(self.children[at].iter().map(|child| (*child, false)));
            }
        }
        nodes
    }
}

/// A node for each row, with its entries below the diagonal, all by places.
fn lower_triangle(pattern: &Columns, place: &[usize]) -> Vec<Node> {
    let own = |at: usize| Node { own: vec![at as u32], ..Node::default() };
    let mut nodes: Vec<Node> = (0..place.len()).map(own).collect();
    for column in 0..pattern.rows {
        let values = pattern.column_starts[column]..pattern.column_starts[column + 1];
        for row in &pattern.row_indices[values] {
            let (first, second) = (place[*row].min(place[column]), place[*row].max(place[column]));
            if first != second {
                nodes[first].rest.push(second as u32);
            }
        }
    }
    nodes
}
