//! Shows on the kernel it runs on what `docs/kernel-tier.md` claims: `kernel_tier [WORD…]`. For the guest machine that
//! `tests/kernel/run` boots; needs root, `vhci_hcd`, and the host program in the path.

use std::process::ExitCode;

use dialrig_tests::kernel::cable::Watch;
use dialrig_tests::kernel::tier::CLAIMS;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let watch = Watch::start();
    let (mut passed, mut failed) = (0, 0);
    for claim in CLAIMS.iter().copied().flatten() {
        if !words.iter().all(|word| claim.name.contains(word.as_str())) {
            continue;
        }
        let began_us = watch.now_us();
        let shown = (claim.show)(&watch);
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
    println!("{passed} passed, {failed} failed");
    if failed == 0 && passed > 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
