//! Any text is read without panic, and what is understood of it prints as something that reads back the same.

#![no_main]

use libfuzzer_sys::fuzz_target;
use ps300::language::{Severity, parse, print};

fuzz_target!(|text: &str| {
    let (commands, diagnostics) = parse(text);
    for diagnostic in &diagnostics {
        assert!(diagnostic.line > 0 && diagnostic.column > 0, "{diagnostic}");
    }
    for located in &commands {
        let printed = print(&located.what);
        let (again, diagnostics) = parse(&printed);
        // Names longer than 240 characters are warned of and taken.
        assert!(
            diagnostics.iter().all(|said| said.severity == Severity::Warning),
            "{printed}\n{diagnostics:#?}"
        );
        assert_eq!(again.len(), 1, "{printed}");
        assert_eq!(again[0].what, located.what, "{printed}");
        assert_eq!(print(&again[0].what), printed);
    }
});
