//! Pages of solutions in a real browser: Chromium, where there is one.

use crate::common::*;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const NAMES: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// What is done on a page as a reader would, and what it then is like.
const PROBE: &str = "<script>
addEventListener('load', () => {
  document.querySelectorAll('details.each').forEach((it) => {
    it.open = true;
    unfold(it);
  });
  charts[0].chart.setScale('x', { min: page.range[0], max: (page.range[0] + page.range[1]) / 2 });
  document.getElementById('whole').click();
  document.querySelectorAll('select').forEach((list) => {
    list.selectedIndex = list.options.length - 1;
    list.dispatchEvent(new Event('change'));
  });
  charts.forEach(({ chart }) => chart.setCursor({ left: 40, top: 40 }));
  dispatchEvent(new Event('beforeprint'));
  dispatchEvent(new Event('afterprint'));
  const { body, documentElement } = document;
  body.dataset.overflow = documentElement.scrollWidth - documentElement.clientWidth;
  body.dataset.empty = document.querySelectorAll('.plot:not(:has(canvas))').length;
  body.dataset.unnamed = document.querySelectorAll('.plot:not([aria-label])').length;
  const told = [...document.querySelectorAll('output')];
  body.dataset.told = told.map((it) => it.textContent).join(';');
});
</script>";

fn browser() -> Option<&'static str> {
    let version = |name: &&str| {
        let mut command = Command::new(name);
        command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|it| it.success())
    };
    NAMES.into_iter().find(|name| version(name))
}

/// The page after its scripts have run, and what they complained about.
fn shown(browser: &str, page: &Path, width: u32) -> (String, Vec<String>) {
    let profile = page.with_extension(format!("profile{width}"));
    let output = Command::new(browser)
        .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=4000"])
        .args(["--enable-logging=stderr", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("--window-size={width},1000"))
        .arg(format!("file://{}", page.display()))
        .output()
        .expect("the browser starts");
    let complaints = stderr(&output);
    let complaints = complaints.lines().filter(|line| line.contains("CONSOLE"));
    (stdout(&output), complaints.map(str::to_owned).collect())
}

/// What the probe wrote down.
fn told(shown: &str, key: &str) -> String {
    let attribute = format!("data-{key}=\"");
    let rest = shown.split(&attribute).nth(1).unwrap_or_else(|| panic!("no {key}"));
    rest.split('"').next().expect("it ends").to_owned()
}

fn solved(folder: &Path, model: &str) -> PathBuf {
    let solve = ["solve", model, "--out", ".", "--log", "none"];
    expect_exit(&fdcc(folder, &solve, ""), 0, model);
    let name = Path::new(model).file_stem().expect("a name").to_string_lossy().into_owned();
    folder.join(format!("{name}.html"))
}

/// Every plot is drawn, has words for who cannot see it, and fits; nothing complains.
fn look(browser: &str, page: &Path) {
    let text = std::fs::read_to_string(page).expect("it was written");
    let probed = page.with_extension("probed.html");
    std::fs::write(&probed, text.replace("</body>", &format!("{PROBE}</body>"))).expect("written");
    for width in [500, 1200, 1920] {
        let (shown, complaints) = shown(browser, &probed, width);
        let place = format!("{} at {width}", page.display());
        assert!(complaints.is_empty(), "{place}: {complaints:?}");
        for key in ["overflow", "empty", "unnamed"] {
            assert_eq!(told(&shown, key), "0", "{place}: {key}");
        }
        assert!(told(&shown, "told").contains(char::is_numeric), "{place}: values at the cursor");
    }
}

#[test]
fn pages_are_drawn_without_complaints_and_fit_every_width() {
    let Some(browser) = browser() else {
        return eprintln!("skipped: there is no Chromium");
    };
    let folder = folder("browser", &[("ramp.fdc", RAMP.as_bytes())]);
    let hop = format!("{}/../tests/classics/phases", env!("CARGO_MANIFEST_DIR"));
    let phases = format!("{hop}/catch_and_carry.fdc");
    let models = ["block", "bounce", "racecar", "slider_fit"].map(model);
    for model in models.iter().map(String::as_str).chain(["ramp.fdc", &phases]) {
        look(browser, &solved(&folder, model));
    }
    let rod = crate::arrays::rod(9);
    for (name, text) in [("rod", &rod[..]), ("denham", crate::multipliers::DENHAM)] {
        std::fs::write(folder.join(format!("{name}.fdc")), text).expect("written");
    }
    look(browser, &solved(&folder, "denham.fdc"));
    expect_exit(&fdcc(&folder, &["simulate", "rod.fdc", "--out", "."], ""), 0, "simulate");
    look(browser, &folder.join("rod.sim.html"));
    let both = ["report", "block.sol.json", "ramp.sol.json", "--out", "both.html"];
    expect_exit(&fdcc(&folder, &both, ""), 0, "report");
    look(browser, &folder.join("both.html"));
    expect_exit(&fdcc(&folder, &["simulate", &models[1], "--out", "."], ""), 0, "simulate");
    look(browser, &folder.join("bounce.sim.html"));
    expect_exit(&fdcc(&folder, &["grad", &model("crossing"), "--out", "."], ""), 0, "grad");
    look(browser, &folder.join("crossing.grad.html"));
    let verify = ["verify", "block.sol.json", &models[0], "--out", "."];
    expect_exit(&fdcc(&folder, &verify, ""), 0, "verify");
    look(browser, &folder.join("block.verify.html"));
    expect_exit(&fdcc(&folder, &["mpc", "ramp.fdc", "--steps", "3", "--out", "."], ""), 0, "mpc");
    look(browser, &folder.join("ramp.mpc.html"));
}
