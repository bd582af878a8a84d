//! How does the demo go? Tells its chapters and prints the report: `cargo run --release -p bench --example story`.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use bench::demo::{self, DemoOptions};
use device_profiles::Profiles;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let show = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shows/salute");
    let show = rig::document::load(&show)?.show;
    let profiles = Arc::new(Profiles::builtin());
    let mut chapter = None;
    let told = demo::run(
        DemoOptions {
            show,
            profiles,
            keys_max: None,
        },
        &mut |scene| {
            if chapter.replace(scene.chapter) != Some(scene.chapter) {
                eprintln!("{:7.2} s  {:?}", scene.snapshot.at_secs, scene.chapter);
            }
            ControlFlow::Continue(())
        },
    )?;
    println!("{}", serde_json::to_string_pretty(&told.report)?);
    Ok(())
}
