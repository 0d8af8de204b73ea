//! Solves a model, checks the answer on the true system, and prints both.

use fdcc::{Error, Model, Options};

fn main() -> Result<(), Error> {
    let model = Model::from_file(concat!(env!("CARGO_MANIFEST_DIR"), "/../models/block.fdc"))?;
    let solution = model.with("mu", 0.25)?.solve(&Options::default())?;
    println!("{}: {}, objective {:.4}", model.name(), solution.status_name(), solution.objective());
    for (time, v) in solution.time().iter().zip(solution.state("v").unwrap_or_default()).step_by(50)
    {
        println!("v({time:.1}) = {v:.4} m/s");
    }
    let replay = solution.verify()?;
    println!("confirmed on the true system to 2 %: {}", replay.confirms(0.02));
    Ok(())
}
