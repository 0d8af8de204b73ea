use fdcc_tests::planar::*;
use fdcc_tests::rate;
const BENT: &str = "model bent
param T = 1.5
time t in [0, T]
state x start -0.3
state y start 0.2
surface rim = x^2 + y^2 - 1
dynamics {
  x' in match rim { below => y/4, above => 1 + y/5 }
  y' in match rim { below => 1 - x/3, above => -1 - x*y/2 }
}
";
const WIDTHS: [f64; 6] = [0.1, 0.05, 0.025, 0.0125, 0.00625, 0.003125];
#[test]
fn probe() {
    let arc = simulated("circle").replace("T = 4", "T = 1.5");
    let bent = BENT.to_string();
    let left = BENT.replace("T = 1.5", "T = 4");
    for (name, text, surface) in [
        ("c", simulated("curved"), "edge"),
        ("arc", arc, "rim"),
        ("bent", bent, "rim"),
        ("left", left, "rim"),
    ] {
        let system = exact(&text, "x(end)");
        let sim = fdcc_runtime::simulate::simulate(
            &system,
            &fdcc_runtime::simulate::Controls::Guess,
            &Default::default(),
        );
        eprintln!(
            "{name} {:?} {:?}",
            sim.events.iter().map(|e| (e.time, e.kind)).collect::<Vec<_>>(),
            sim.status
        );
        let truth = derivative(&system);
        eprintln!("{truth:?}");
        for kernel in ["tanh", "sqrt", "linear", "cubic", "quintic"] {
            let t0 = std::time::Instant::now();
            let mut smooth = Smoothed::new(&text, surface, kernel);
            let errors: Vec<f64> = WIDTHS.iter().map(|s| distance(&smooth.derivative(*s), &truth)).collect();
            eprintln!(
                "{name} {kernel} {} rate {:.3} {:?}",
                errors.iter().map(|e| format!("{e:.2e} ")).collect::<String>(),
                rate(&WIDTHS, &errors),
                t0.elapsed()
            );
        }
        let mut smooth = Smoothed::new(&text, surface, "tanh");
        for theta in [0.0, 1.0] {
            for ratio in [0.1, 0.5, 1.0, 2.0, 4.0] {
                let t0 = std::time::Instant::now();
                let errors: Vec<f64> = [0.05, 0.0125, 0.003125]
                    .iter()
                    .map(|s| {
                        let d = smooth.derivative(*s);
                        let n = (system.interval[1] / (ratio * s)).round() as usize;
                        distance(&smooth.stepped(*s, theta, n), &d)
                    })
                    .collect();
                eprintln!(
                    "{name} theta {theta} ratio {ratio} {} {:?}",
                    errors.iter().map(|e| format!("{e:.2e} ")).collect::<String>(),
                    t0.elapsed()
                );
            }
        }
    }
}
