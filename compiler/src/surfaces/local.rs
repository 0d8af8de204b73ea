//! One surface by itself: a small graph with its function, its gradient and the rates on both
//! sides.
//!
//! ```text
//! below = psi_t + psi_x f(s = -1),   above = psi_t + psi_x f(s = +1),   jump = above - below
//! ```
//!
//! Where `psi` is affine in a state with a constant factor, that state is replaced by what it is on
//! the surface, so that all of these hold there and nowhere else. The selectors of other surfaces
//! may be anything in [-1, 1].

use super::view::View;
use super::words::Words;
use crate::expressions::graph::derivative::gradient;
use crate::expressions::graph::{ById, Expr, ExprId, Graph};
use crate::expressions::interval::{Interval, Prover, Tape};
use crate::expressions::polynomial::{NormalForms, Polynomial};
use crate::model::Symbol;

/// Path constraints beyond these are not looked at.
const MOST_ROWS: usize = 40;
/// Names beyond these are not looked for in texts.
const MOST_NAMES: usize = 200;

/// A surface and what happens on it.
pub(crate) struct Local {
    /// Its own graph; inputs are positions in `symbols`.
    pub graph: Graph,
    /// What the inputs are.
    pub symbols: Vec<Symbol>,
    /// Where they may lie.
    pub domain: Vec<Interval>,
    /// Its function, as written.
    pub psi: ExprId,
    /// Its derivative by time.
    pub in_time: ExprId,
    /// Its derivatives by states, those that are not 0.
    pub gradient: Vec<(usize, ExprId)>,
    /// The rate of `psi` on both sides, on the surface, and their difference.
    pub below: ExprId,
    pub above: ExprId,
    pub jump: ExprId,
    /// The first two as they came out, not expanded.
    pub written: [ExprId; 2],
    /// The jump of every rate that the selector moves: its state, and below and above.
    pub sides: Vec<(usize, [ExprId; 2])>,
    /// What lies where on the surface.
    pub constraints: Vec<(ExprId, Interval)>,
    /// Replaced on the surface: a state's input and its value, over what is replaced after it.
    pub replaced: Vec<(u32, ExprId)>,
    /// The states whose rates the selectors of many other surfaces enter, with the inputs that
    /// stand for these.
    others: Vec<(usize, u32)>,
    known: ById<ExprId>,
    forms: NormalForms,
}

impl Local {
    /// Nothing but an empty graph, for expressions that are no surfaces.
    pub fn empty() -> Local {
        let mut graph = Graph::new();
        let zero = graph.number(0.0);
        Local {
            graph,
            symbols: Vec::new(),
            domain: Vec::new(),
            psi: zero,
            in_time: zero,
            gradient: Vec::new(),
            below: zero,
            above: zero,
            jump: zero,
            written: [zero; 2],
            sides: Vec::new(),
            constraints: Vec::new(),
            replaced: Vec::new(),
            others: Vec::new(),
            known: ById::default(),
            forms: NormalForms::default(),
        }
    }

    /// The surface `at` of a model; nothing if its function is unknown.
    pub fn new(view: &View<'_>, at: usize) -> Option<Local> {
        let psi = view.surfaces[at].1?;
        let mut local = Local::empty();
        local.psi = local.import(view, psi);
        local.differentiate();
        Some(local)
    }

    /// One more input, of no meaning to the model.
    pub fn add_input(&mut self) -> ExprId {
        self.symbols.push(Symbol::Argument(usize::MAX));
        self.domain.push(Interval::ALL);
        self.graph.input(self.symbols.len() as u32 - 1)
    }

    /// Whether the function has one value along every motion: it reads no control, no jump resets
    /// what it reads, and its rate is 0 wherever it is.
    pub fn is_constant(&mut self, view: &View<'_>, reset: &[usize]) -> bool {
        let is_fixed = |it: &u32| {
            matches!(
                self.symbols[*it as usize],
                Symbol::Param(_) | Symbol::Free(_) | Symbol::State(_) | Symbol::Time
            )
        };
        let stays = |(state, _): &(usize, ExprId)| !reset.contains(state);
        self.graph.inputs_of(&[self.psi]).iter().all(is_fixed)
            && self.gradient.iter().all(stays)
            && self.rate(view, None).is_some_and(|rate| self.form(rate).is_zero())
    }

    /// Whether the function has one sign wherever states, controls and unknowns are, also out of
    /// their bounds.
    pub fn has_one_sign(&self) -> bool {
        let everywhere =
            self.symbols.iter().zip(&self.domain).map(|(symbol, domain)| match symbol {
                Symbol::State(_) | Symbol::Control(_) | Symbol::Free(_) => Interval::ALL,
                _ => *domain,
            });
        let domain: Vec<Interval> = everywhere.collect();
        let range = Tape::new(&self.graph, &[self.psi]).evaluate(&domain)[0];
        let [is_above, is_below] = [range.lower > 0.0, range.upper < 0.0];
        is_above && range.lower.is_finite() || is_below && range.upper.is_finite()
    }

    /// Adds what happens on the surface; says whether all rates that matter are known.
    pub fn add_rates(&mut self, view: &View<'_>, at: usize) -> bool {
        let Some(rate) = self.rate(view, Some(at)) else { return false };
        self.replace_a_state(view);
        self.rates(rate, at);
        self.rows(view);
        true
    }

    /// Takes the surface `at` besides those before it: its rate, if that is known. Where all are 0
    /// it is 0 as well.
    pub fn add_surface(&mut self, view: &View<'_>, at: usize) -> Option<ExprId> {
        let psi = self.import(view, view.surfaces[at].1?);
        self.psi = psi;
        self.differentiate();
        let rate = self.rate(view, None)?;
        self.psi = self.substituted(psi);
        self.differentiate();
        self.replace_a_state(view);
        Some(rate)
    }

    /// A copy of an expression of the model.
    pub fn import(&mut self, view: &View<'_>, expr: ExprId) -> ExprId {
        let Local { graph, symbols, domain, known, .. } = self;
        let mut input = |graph: &mut Graph, position: u32| {
            let symbol = view.symbols[position as usize];
            symbols.push(symbol);
            domain.push(view.domain(symbol));
            graph.input(symbols.len() as u32 - 1)
        };
        graph.import(view.graph, &[expr], known, &mut input)[0]
    }

    /// The input of a symbol, if it occurs.
    pub fn input_of(&self, symbol: Symbol) -> Option<u32> {
        self.symbols.iter().position(|it| *it == symbol).map(|at| at as u32)
    }

    /// The normal form of an expression, as an expression.
    pub fn normal(&mut self, expr: ExprId) -> ExprId {
        self.forms.expr(&mut self.graph, expr)
    }

    /// The normal form of an expression.
    pub fn form(&mut self, expr: ExprId) -> Polynomial {
        self.forms.of(&mut self.graph, expr)
    }

    /// Proofs about what happens on the surface.
    pub fn prover(&self) -> Prover {
        Prover::new(self.domain.clone(), self.constraints.clone())
    }

    fn differentiate(&mut self) {
        let (mut inputs, mut states) = (Vec::new(), Vec::new());
        for (at, symbol) in self.symbols.iter().enumerate() {
            match symbol {
                Symbol::State(state) => {
                    inputs.push(at as u32);
                    states.push(*state);
                }
                Symbol::Time => inputs.insert(0, at as u32),
                _ => {}
            }
        }
        let mut slopes = gradient(&mut self.graph, self.psi, &inputs);
        self.in_time = match slopes.len() > states.len() {
            true => slopes.remove(0),
            false => self.graph.number(0.0),
        };
        let mut found: Vec<(usize, ExprId)> = Vec::new();
        for (state, slope) in states.into_iter().zip(slopes) {
            let slope = self.normal(slope);
            if self.graph.as_number(slope) != Some(0.0) {
                found.push((state, slope));
            }
        }
        found.sort_by_key(|it| it.0);
        self.gradient = found;
    }

    /// Finds a state that `psi = c x + rest` gives, with a number or parameters for `c`.
    fn replace_a_state(&mut self, view: &View<'_>) {
        let psi = self.form(self.psi);
        for &(state, slope) in &self.gradient.clone() {
            let input = self.input_of(Symbol::State(state)).expect("psi depends on it");
            let factor = self.form(slope);
            let is_known = |it: &u32| match self.symbols[*it as usize] {
                Symbol::Param(at) => view.values[at].is_finite(),
                _ => false,
            };
            let is_constant = self.graph.inputs_of(&[slope]).iter().all(is_known);
            let Some((monomial, _)) = factor.as_term().filter(|_| is_constant) else { continue };
            let nonzero = monomial.iter().all(|power| match self.graph.expr(power.0) {
                Expr::Input(at) => !self.domain[*at as usize].contains(0.0),
                _ => false,
            });
            if nonzero {
                let state = self.graph.input(input);
                let moved = Polynomial::atom(state).times(&factor).expect("a single product");
                let rest = psi.plus(-1.0, &moved).to_expr(&mut self.graph);
                let quotient = self.graph.div(rest, slope);
                let value = self.graph.neg(quotient);
                let value = self.normal(value);
                self.constraints.push((value, self.domain[input as usize]));
                self.replaced.push((input, value));
                return;
            }
        }
        self.constraints.push((self.psi, Interval::point(0.0)));
    }

    /// An expression with the replaced state as it is on the surface, in normal form.
    pub fn on_surface(&mut self, expr: ExprId) -> ExprId {
        let on_it = self.substituted(expr);
        let form = self.form(on_it);
        let zero = self.form(self.psi);
        let reduced = if self.replaced.is_empty() { form.reduced(&zero) } else { None };
        reduced.unwrap_or(form).to_expr(&mut self.graph)
    }

    fn substituted(&mut self, expr: ExprId) -> ExprId {
        let replaced = self.replaced.clone().into_iter();
        replaced.fold(expr, |expr, (input, value)| self.with(expr, Some(input), value))
    }

    /// An expression with an input, if there is one, at a value.
    pub fn with(&mut self, expr: ExprId, input: Option<u32>, value: ExprId) -> ExprId {
        self.graph.substitute(&[expr], &|position| (Some(position) == input).then_some(value))[0]
    }

    /// An expression with the surface's selector at one of its ends.
    fn on_side(&mut self, expr: ExprId, selector: Option<u32>, side: f64) -> ExprId {
        let end = self.graph.number(side);
        self.with(expr, selector, end)
    }

    /// `psi_t + psi_x f`, if the rates are known.
    fn rate(&mut self, view: &View<'_>, of: Option<usize>) -> Option<ExprId> {
        let mut terms = vec![self.in_time];
        for (state, slope) in self.gradient.clone() {
            let rate = view.has_rate[state].then(|| self.rate_of(view, state, of))?;
            terms.push(self.graph.mul(slope, rate));
        }
        Some(self.graph.sum(&terms))
    }

    /// The rate of a state. Where the selectors of many surfaces are added up, those of all others
    /// than `of` are one number.
    fn rate_of(&mut self, view: &View<'_>, state: usize, of: Option<usize>) -> ExprId {
        let Some(sum) = view.sums.get(&state) else {
            return self.import(view, view.states[state].rate);
        };
        let own = of.and_then(|at| sum.own.get(&at));
        let size = sum.size - own.map_or(0.0, |it| it.size);
        let mut all = vec![self.other_selectors(state, size)];
        for &(factor, term) in own.iter().map(|it| &it.term).chain(&sum.rest) {
            let term = self.import(view, term);
            all.push(self.graph.scale(factor, term));
        }
        self.graph.sum(&all)
    }

    /// What the others contribute to the rate of a state.
    fn other_selectors(&mut self, state: usize, size: f64) -> ExprId {
        let known = self.others.iter().find(|it| it.0 == state).map(|it| it.1);
        let input = known.unwrap_or_else(|| {
            let input = self.symbols.len() as u32;
            self.add_input();
            self.domain[input as usize] = Interval::new(-size, size);
            self.others.push((state, input));
            input
        });
        self.graph.input(input)
    }

    fn rates(&mut self, rate: ExprId, at: usize) {
        let selector = self.input_of(Symbol::Selector(at));
        let ends = [-1.0, 1.0].map(|side| {
            let end = self.on_side(rate, selector, side);
            self.substituted(end)
        });
        self.written = ends;
        [self.below, self.above] = ends.map(|end| self.on_surface(end));
        let jump = self.graph.sub(self.above, self.below);
        self.jump = self.on_surface(jump);
    }

    /// The rates of all states that the selector moves, for those who ask for more than `psi`.
    pub fn add_sides(&mut self, view: &View<'_>, at: usize) {
        for &state in view.moved[at].iter().filter(|&&state| view.has_rate[state]) {
            let rate = self.rate_of(view, state, Some(at));
            let selector = self.input_of(Symbol::Selector(at));
            let sides = [-1.0, 1.0].map(|side| {
                let end = self.on_side(rate, selector, side);
                self.on_surface(end)
            });
            self.sides.push((state, sides));
        }
    }

    /// Path constraints over what occurs here: outside them nothing is asked.
    pub fn rows(&mut self, view: &View<'_>) {
        for row in view.path.iter().take(MOST_ROWS) {
            let before = self.symbols.len();
            let value = self.import(view, row.value);
            if self.symbols.len() == before {
                let value = self.on_surface(value);
                self.constraints.push((value, view.bounds(row.range)));
            }
        }
    }

    /// Runs something that needs names for inputs and for expressions that occur in the text.
    pub fn in_words<R>(
        &mut self,
        view: &View<'_>,
        own: &[(String, ExprId)],
        run: impl FnOnce(&mut Local, &Words<'_>) -> R,
    ) -> R {
        let symbols = self.symbols.clone();
        let input = |position: u32| view.name(symbols[position as usize]);
        let mut named: Vec<(String, Polynomial)> = Vec::new();
        let mut forms = NormalForms::with_squares();
        for (name, expr) in own {
            named.push((name.clone(), forms.of(&mut self.graph, *expr)));
        }
        if own.is_empty() {
            named = self.named(view);
        }
        run(self, &Words { input: &input, named })
    }

    /// An expression as text; nothing if nobody would read it.
    pub fn text(&mut self, view: &View<'_>, expr: ExprId) -> Option<String> {
        let inputs = self.graph.inputs_of(&[expr]);
        if self.others.iter().any(|(_, input)| inputs.contains(input)) {
            return None;
        }
        self.in_words(view, &[], |local, words| words.of(&mut local.graph, expr))
    }

    /// The named expressions that are made of what occurs here.
    fn named(&mut self, view: &View<'_>) -> Vec<(String, Polynomial)> {
        let mut forms = NormalForms::with_squares();
        let mut named = Vec::new();
        for (name, id) in view.names.iter().take(MOST_NAMES) {
            let known = |input: u32| self.symbols.contains(&view.symbols[input as usize]);
            let inputs = view.graph.inputs_of(&[*id]);
            if !inputs.is_empty() && inputs.into_iter().all(known) {
                let copy = self.import(view, *id);
                let copy = self.substituted(copy);
                named.push((name.clone(), forms.of(&mut self.graph, copy)));
            }
        }
        named
    }
}
