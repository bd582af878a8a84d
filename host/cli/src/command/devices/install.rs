//! `dialrig devices --install-rules`: what the system must be told so that devices can be opened.

use std::fs::File;
use std::io::Write as _;
use std::path::Path;

use rig::profile_look::{MODPROBE_FILE, RULES_FILE, module_options, rules};

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::setup;

/// Writes both files, or only those that are asked for.
pub(super) fn run(
    rules_file: Option<&Path>,
    modprobe_file: Option<&Path>,
    console: &Console,
) -> Result<Exit, Failure> {
    let all = rules_file.is_none() && modprobe_file.is_none();
    if let Some(file) = rules_file.or(all.then_some(Path::new(RULES_FILE))) {
        let text = rules(&*setup::profiles()?);
        let then =
            "to have it at once: `udevadm control --reload && udevadm trigger`, then plug devices out and in";
        install(file, &text, then, "rules", console)?;
    }
    if let Some(file) = modprobe_file.or(all.then_some(Path::new(MODPROBE_FILE))) {
        let then = "it is in force when the machine has started anew";
        install(file, &module_options(), then, "modprobe", console)?;
    }
    Ok(Exit::Done)
}

/// Writes one file, or says where it would go and prints it. `option` is the one that names the file.
fn install(file: &Path, text: &str, then: &str, option: &str, console: &Console) -> Result<(), Failure> {
    let written = File::create(file).and_then(|mut out| {
        out.write_all(text.as_bytes())?;
        out.sync_all()
    });
    let place = file.display();
    match written {
        Ok(()) => {
            console.remark(format_args!("{place} is written; {then}"));
            Ok(())
        }
        Err(error) => {
            console.line(text.trim_end())?;
            let message = format!("{place}: {error}; what belongs there was printed instead");
            Err(Failure::refused(message).with_hint(format!(
                "only root may write there: `sudo dialrig devices --install-rules`, or put it there by hand: \
                 `dialrig devices --install-rules --{option}-file {place} 2>/dev/null | sudo tee {place}`"
            )))
        }
    }
}
