//! Reading item by item finds what the grammar makes of the whole file: the same tree, and a
//! mistake where there is one.

use super::grammar::{Rule, pairs};
use super::lexical::tokens::tokens;
use super::{parse, rules, tree};

/// How many texts are made of the right ones.
const SHUFFLED: usize = 3_000;

/// Right texts whose lines begin with what looks like another item.
const AWKWARD: &[&str] = &[
    "state x start 0 end x >= 1",
    "state x start free end x >= 1 param b",
    "state x start piecewise { a <= 1 => 0 otherwise => 1 } path x >= 0",
    "data obs = csv(\"a.csv\") columns\nt [s]",
    "minimize sum(\ndat in obs, dat)",
    "minimize f(x(\nend\n), g(\nstart, 1))",
    "phase a { guess {\n x = f(\nstart)\n y = 1 }\n state x }",
    "phase a { state x\nstart free\nstate y }",
    "param m = 2 [kg\nmin s]",
    "param m = 2 [\nstate]",
    "surface s =\non minimize v",
    "let a =\nparam\u{663}\nlet b = 1",
    "data d = csv(\"a.csv\") columns t, x\nfit\nd: x sd 0.1",
    "state x at\nt1: x <= 1",
    "guess\n{ x = match b\n{ below => 1, above => 2 } }",
    "data d = csv(\"a.csv\") columns time [s],\nstate,\nend\nend x == 1",
    "data d = csv(\"a.csv\") columns\ntime\nfree a",
    "data d = csv(\"a.csv\") columns t, time path x <= 1",
    "phase a { data d = csv(\"a.csv\") columns t,\nphase, link }",
    "phase a for each csv(\"a*.csv\") columns t, time { fit a: x sd 0.1 }",
    "phase for for each csv(\"a.csv\")\ncolumns\nt [s],\npath\n{ state each param for }",
    "phase a like b\nfor each\ncsv(\"a.csv\") columns t, end { end x == 1 }",
    "path x <= d.time path y >= d.end\nminimize d.start free T",
    "fit d: x = end sd d.path end x == 1",
    "state x\nstart d.time >= x at d.end: x == 1",
];

/// What a search by coverage has found, right and wrong.
const FOUND: &str = include_str!("../../../tests/fuzz/corpus.txt");

/// Whether the grammar accepts the whole; reading item by item must say the same.
fn is_accepted(text: &str) -> bool {
    let read = parse(text);
    let Ok(pairs) = pairs(Rule::file, text) else {
        assert!(!read.diagnostics.is_empty(), "the grammar does not accept\n{text}");
        return false;
    };
    let whole = tree::parse_of(pairs);
    if !whole.tree.items.is_empty() {
        assert_eq!(read.diagnostics, whole.diagnostics, "the grammar accepts\n{text}");
    }
    assert_eq!(
        (read.tree.name, read.tree.items),
        (whole.tree.name, whole.tree.items),
        "the tree of\n{text}"
    );
    true
}

/// Numbers that look random, the same on every run.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % limit
    }
}

/// The words of a text on other lines, some of them left out, doubled or replaced by others.
fn shuffled(text: &str, random: &mut Random) -> String {
    let mut words: Vec<&str> = tokens(text).iter().map(|token| token.text).collect();
    for _ in 0..random.below(words.len().min(4)) {
        let (from, to) = (random.below(words.len()), random.below(words.len()));
        match random.below(4) {
            0 => drop(words.remove(from)),
            1 => words.insert(to, words[from]),
            2 => words[to] = words[from],
            _ => {}
        }
    }
    let breaks = random.below(4);
    let gap = |random: &mut Random| if random.below(4) < breaks { "\n" } else { " " };
    words.iter().map(|word| [*word, gap(random)].concat()).collect()
}

#[test]
fn items_together_are_the_file() {
    for text in AWKWARD {
        assert!(is_accepted(text), "{text}");
    }
    let texts = rules::examples().chain(FOUND.split("\n----\n"));
    let right: Vec<&str> =
        texts.filter(|text| is_accepted(text) && !tokens(text).is_empty()).collect();
    assert!(right.len() > 200, "{} texts", right.len());
    let mut random = Random(1);
    for _ in 0..SHUFFLED {
        is_accepted(&shuffled(right[random.below(right.len())], &mut random));
    }
}
