//! A model as large as nobody writes by hand: many states, controls, definitions, functions,
//! conditions and surfaces.

/// A right model of about so many lines.
pub fn model(lines: usize) -> String {
    let groups = lines / 9;
    let mut text = String::from("model large\nparam k = 3\ntime t in [0, 4]\n");
    for i in 0..groups {
        text += &format!(
            "param p{i} = {}\nlet d{i} = p{i}*x{i} + k*v{i}^2\nfn f{i}(a) = sin(a) + p{i}*a\n",
            i + 1
        );
        text += &format!(
            "state x{i} in [-10, 10] start {}\nstate v{i} start 1\ncontrol u{i} in [-1, 1]\n",
            i % 7
        );
        text += &format!("path c{i}: x{i} - v{i} <= 5\n");
        if i % 10 == 0 {
            text += &format!("surface s{i} = v{i}\n");
        }
    }
    text += "dynamics {\n";
    for i in 0..groups {
        let (relation, friction) =
            if i % 10 == 0 { ("in", format!(" - 2*Sgn(s{i})")) } else { ("=", String::new()) };
        text += &format!("  x{i}' = v{i}\n  v{i}' {relation} u{i} - d{i} + f{i}(x{i}){friction}\n");
    }
    let costs: Vec<String> = (0..groups).map(|i| format!("integral(u{i}^2)")).collect();
    text + "}\nminimize " + &costs.join(" + ") + "\n"
}
