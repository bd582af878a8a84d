//! What is odd about a device; a closed list, so that programs can act on it.

use serde::{Deserialize, Serialize};

macro_rules! quirks {
    ($($variant:ident = $word:literal: $meaning:literal,)*) => {
        /// Something odd about a device.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum Quirk {
            $(
                #[doc = $meaning]
                #[serde(rename = $word)]
                $variant,
            )*
        }

        impl Quirk {
            /// All there are.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// The word as the files have it.
            pub fn word(self) -> &'static str {
                match self { $(Self::$variant => $word,)* }
            }

            /// What it means, in a sentence.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }
        }
    };
}

quirks! {
    SharedIds = "shared-ids": "Other devices have the same vendor and product id: strings or lengths tell them apart.",
    GarbageReports = "garbage-reports": "Sends reports of no known id or length now and then; they are dropped.",
    StaleBytes = "stale-bytes": "Bytes that a report does not use keep what was in them.",
    UninitialisedStrings = "uninitialised-strings": "Answers an unknown string index with what happens to be in its memory.",
    StringsAreSlow = "strings-are-slow": "May need longer for a string than the system allows, and is asked again.",
    ReturnsAsSibling = "returns-as-sibling": "Leaves the bus during the handshake and returns with another product id.",
    KeyboardBeforeInit = "keyboard-before-init": "Its keys are a keyboard's until it is initialised.",
    CoarseBeforeInit = "coarse-before-init": "Reports another form with fewer steps until it is initialised.",
    TimeoutLeave = "timeout-leave": "Does not say when the tool leaves: silence is leaving.",
    DriverRewrites = "driver-rewrites": "A kernel driver changes its mode or its descriptor; both may want the device.",
    DriverShiftsBytes = "driver-shifts-bytes": "With the maker's driver installed every report has one byte more in front.",
    ZeroNotPassedOn = "zero-not-passed-on": "The system's input layer swallows its zero; raw reports have it.",
    JogWraps = "jog-wraps": "The jog is a counter that wraps.",
    RestartsOnOpen = "restarts-on-open": "Opening its port starts the board anew.",
    FirstLineCut = "first-line-cut": "The first line after opening may be half a line.",
    PositionsCannotBeAsked = "positions-cannot-be-asked": "Where its controls stand is known only once they are moved.",
    ValuesCannotBeSet = "values-cannot-be-set": "The host cannot set what its encoders count from.",
    ButtonsAddUp = "buttons-add-up": "Buttons are a code: two together look like a third.",
    LampsUntested = "lamps-untested": "What lights its lamps was found, but nobody said that it works on this model.",
    LineLimited = "line-limited": "Its line is slower than its loop.",
    SecondTimeUnderstood = "second-time-understood": "Does not always understand a command the first time.",
}
