//! Shows on the kernel it runs on what `docs/kernel-tier.md` claims: `kernel_tier [WORD…]`. For the guest machine that
//! `tests/kernel/run` boots; needs root, `vhci_hcd`, and the host program in the path.

use std::process::ExitCode;

use dialrig_tests::kernel::cable::Watch;
use dialrig_tests::kernel::tier::{Claim, LANES};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let watch = Watch::start();
    let shown: Vec<[usize; 2]> = std::thread::scope(|scope| {
        let lanes = LANES.map(|lane| scope.spawn(|| show(lane, &words, &watch)));
        // A claim that panics has failed, and those after it were not shown.
        lanes.map(|lane| lane.join().unwrap_or([0, 1])).to_vec()
    });
    let [passed, failed] = [0, 1].map(|place| shown.iter().map(|counts| counts[place]).sum::<usize>());
    println!("{passed} passed, {failed} failed");
    if failed == 0 && passed > 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Shows the claims of a lane whose names have every word: how many passed, how many failed.
fn show(lane: &[&[Claim]], words: &[String], watch: &Watch) -> [usize; 2] {
    let (mut passed, mut failed) = (0, 0);
    for claim in lane.iter().copied().flatten() {
        if !words.iter().all(|word| claim.name.contains(word.as_str())) {
            continue;
        }
        let began_us = watch.now_us();
        let shown = (claim.show)(watch);
        let secs = (watch.now_us() - began_us) as f64 / 1e6;
        match shown {
            Ok(()) => {
                passed += 1;
                println!("ok     {secs:5.1} s  {}", claim.name);
            }
            Err(error) => {
                failed += 1;
                println!("FAILED {secs:5.1} s  {}: {error:#}", claim.name);
            }
        }
    }
    [passed, failed]
}
