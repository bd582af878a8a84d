//! The table of keys: what is done, what tooltips say, what the help page lists, in one place.

use egui::{Key, Modifiers};

/// One press turns the view by this much, radians: five degrees.
const VIEW_RAD: f64 = 0.087_266_462_599_716_47;
/// One press moves a coefficient by this much, keys.
const COEFFICIENT_KEYS: f64 = 0.05;
/// One press moves the posing cursor by this much, half-heights of the view.
const CURSOR_STEP: f64 = 0.02;

/// What a key does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Act {
    /// Order to the transport.
    Toggle,
    /// Moves time by frames.
    Frames(i32),
    /// To the first (−1) or last (1) key.
    Ends(i32),
    /// To the next or previous key.
    Key(i32),
    /// Moves the selected key by frames.
    MoveKey(i32),
    /// Loop on or off.
    Loop,
    /// Faster or slower.
    Speed(bool),
    /// Stores a key.
    Store,
    /// Copies a key.
    Copy,
    /// Deletes a key.
    Delete,
    /// Chooses the next kind of kinetic curve.
    Mode,
    /// Takes kinetic adjustments back.
    ResetKinetics,
    /// Chooses another coefficient.
    Coefficient(i32),
    /// Moves the chosen coefficient.
    Bend(f64),
    /// Undo.
    Undo,
    /// Redo.
    Redo,
    /// Save.
    Save,
    /// Chooses the next or previous link.
    Link(i32),
    /// Turns the selected link about its axis, sixteenths of a half turn.
    Twist(f64),
    /// Fixes the selected link.
    Place,
    /// The other of the two solutions.
    OtherSide,
    /// Takes the clip's pose.
    FromClip,
    /// Takes the pose in which the servos stand.
    FromMeasured,
    /// Moves the posing cursor.
    Cursor(f64, f64),
    /// Turns the chosen dial, in presses.
    Dial(f64),
    /// Turns the view.
    Turn(f64, f64),
    /// Zooms.
    Zoom(f64),
    /// The whole figure.
    Fit,
    /// Onion skin on or off.
    Onion,
    /// Ticks on or off.
    Ticks,
    /// Floor on or off.
    Floor,
    /// Puppet: turn torque on.
    Arm,
    /// Puppet: play.
    PuppetPlay,
    /// Puppet: follow.
    Follow,
    /// Puppet: hold.
    Hold,
    /// Puppet: release.
    Release,
    /// Puppet: leave the faulted state.
    Reset,
    /// Puppet: gives the clip the time it needs.
    SlowToFit,
    /// Puppet: goals ahead of time by each joint's lag, or not.
    Lead,
    /// Puppet: teach, or stop teaching.
    Teach,
    /// The help page.
    Help,
    /// The patch panel instead of the figure, or back.
    Patch,
    /// The controls of input devices instead of the figure, or back.
    Controls,
    /// Patch: looks for something to add.
    Add,
    /// Patch: shows what is selected, or everything.
    Frame,
    /// Patch: deletes what is selected.
    PatchDelete,
    /// Patch: copies what is selected.
    Duplicate,
    /// Patch: takes the last edit back.
    PatchUndo,
    /// Patch: makes it again.
    PatchRedo,
    /// Patch: lays everything out anew.
    LayOut,
    /// Patch: folds or unfolds the structure under the pointer.
    Fold,
    /// Patch: pins a read-out of the output under the pointer, or takes it away.
    Probe,
    /// Patch: holds the output under the pointer back, or lets it go.
    Freeze,
    /// Patch: the text beside the graph, or not.
    PatchText,
    /// Patch: selects all boxes.
    SelectAll,
}

/// Where a key means what its row says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// While the figure is shown.
    Stage,
    /// While the network is shown.
    Patch,
    /// Always.
    Everywhere,
}

/// One row of the table.
#[derive(Clone, Copy)]
pub struct Shortcut {
    /// Where it holds.
    pub place: Place,
    /// Modifiers that must be held, and no others.
    pub modifiers: Modifiers,
    /// The key.
    pub key: Key,
    /// What it does.
    pub act: Act,
    /// Group on the help page.
    pub group: &'static str,
    /// The keys in words; empty: the row above speaks for this one too.
    pub keys: &'static str,
    /// What it does in words.
    pub does: &'static str,
}

const NONE: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;
const CTRL: Modifiers = Modifiers::COMMAND;
const ALT: Modifiers = Modifiers::ALT;
const CTRL_SHIFT: Modifiers = Modifiers {
    shift: true,
    ..Modifiers::COMMAND
};
const ALT_SHIFT: Modifiers = Modifiers {
    shift: true,
    ..Modifiers::ALT
};

const fn row(
    (modifiers, key): (Modifiers, Key),
    act: Act,
    group: &'static str,
    keys: &'static str,
    does: &'static str,
) -> Shortcut {
    let place = match group.as_bytes() {
        b"patch" => Place::Patch,
        b"time" | b"desk" => Place::Everywhere,
        _ => Place::Stage,
    };
    Shortcut {
        place,
        modifiers,
        key,
        act,
        group,
        keys,
        does,
    }
}

/// A row that holds wherever one is.
const fn everywhere(row: Shortcut) -> Shortcut {
    Shortcut {
        place: Place::Everywhere,
        ..row
    }
}

/// A row that holds only while the figure is shown.
const fn on_stage(row: Shortcut) -> Shortcut {
    Shortcut {
        place: Place::Stage,
        ..row
    }
}

/// Every key but Esc, the digits and F1–F12. Rows with more modifiers come before rows with fewer.
#[rustfmt::skip] // A table: one row a line.
pub const SHORTCUTS: &[Shortcut] = &[
    // The patch panel pans with the space bar held, and plays when it is let go.
    on_stage(row((NONE, Key::Space), Act::Toggle, "time", "Space", "play, pause")),
    row((SHIFT, Key::ArrowLeft), Act::Frames(-10), "time", "Shift-Left, -Right", "ten frames"),
    row((SHIFT, Key::ArrowRight), Act::Frames(10), "time", "", ""),
    row((CTRL, Key::ArrowLeft), Act::MoveKey(-1), "keys", "Ctrl-Left, -Right", "move the key a frame"),
    row((CTRL, Key::ArrowRight), Act::MoveKey(1), "keys", "", ""),
    row((ALT_SHIFT, Key::ArrowLeft), Act::Cursor(-CURSOR_STEP, 0.0), "pose", "Alt-Shift-arrows", "move the cursor"),
    row((ALT_SHIFT, Key::ArrowRight), Act::Cursor(CURSOR_STEP, 0.0), "pose", "", ""),
    row((ALT_SHIFT, Key::ArrowUp), Act::Cursor(0.0, CURSOR_STEP), "pose", "", ""),
    row((ALT_SHIFT, Key::ArrowDown), Act::Cursor(0.0, -CURSOR_STEP), "pose", "", ""),
    row((ALT, Key::ArrowLeft), Act::Coefficient(-1), "kinetics", "Alt-Left, -Right", "choose a coefficient"),
    row((ALT, Key::ArrowRight), Act::Coefficient(1), "kinetics", "", ""),
    row((ALT, Key::ArrowUp), Act::Bend(COEFFICIENT_KEYS), "kinetics", "Alt-Up, -Down", "earlier, later there"),
    row((ALT, Key::ArrowDown), Act::Bend(-COEFFICIENT_KEYS), "kinetics", "", ""),
    row((NONE, Key::ArrowLeft), Act::Frames(-1), "time", "Left, Right", "one frame"),
    row((NONE, Key::ArrowRight), Act::Frames(1), "time", "", ""),
    row((NONE, Key::Home), Act::Ends(-1), "time", "Home, End", "first, last key"),
    row((NONE, Key::End), Act::Ends(1), "time", "", ""),
    row((NONE, Key::ArrowUp), Act::Key(-1), "time", "Up, Down", "previous, next key"),
    row((NONE, Key::ArrowDown), Act::Key(1), "time", "", ""),
    on_stage(row((SHIFT, Key::L), Act::Lead, "puppet", "Shift-L", "lead by the joints' lag")),
    row((NONE, Key::L), Act::Loop, "time", "L", "loop"),
    row((NONE, Key::Minus), Act::Speed(false), "time", "- =", "slower, faster"),
    row((NONE, Key::Equals), Act::Speed(true), "time", "", ""),
    row((NONE, Key::K), Act::Store, "keys", "K", "store the pose as a key"),
    row((NONE, Key::C), Act::Copy, "keys", "C", "copy the last key here"),
    row((NONE, Key::Delete), Act::Delete, "keys", "Delete", "delete the selected key"),
    row((SHIFT, Key::M), Act::ResetKinetics, "kinetics", "Shift-M", "take adjustments back"),
    row((NONE, Key::M), Act::Mode, "kinetics", "M", "natural, monotone, linear"),
    row((CTRL_SHIFT, Key::Z), Act::Redo, "show", "Ctrl-Shift-Z", "redo"),
    row((CTRL, Key::Z), Act::Undo, "show", "Ctrl-Z", "undo"),
    everywhere(row((CTRL, Key::S), Act::Save, "show", "Ctrl-S", "save")),
    everywhere(row((CTRL, Key::P), Act::Patch, "show", "Ctrl-P", "the patch panel, the figure")),
    everywhere(row((CTRL, Key::K), Act::Controls, "show", "Ctrl-K", "the controls, the figure")),
    row((SHIFT, Key::Comma), Act::Twist(-1.0), "pose", "Shift-, Shift-.", "twist the link"),
    row((SHIFT, Key::Period), Act::Twist(1.0), "pose", "", ""),
    row((NONE, Key::Comma), Act::Link(-1), "pose", ", .", "previous, next link"),
    row((NONE, Key::Period), Act::Link(1), "pose", "", ""),
    row((NONE, Key::Enter), Act::Place, "pose", "Enter", "fix the link, go to the next"),
    row((NONE, Key::N), Act::OtherSide, "pose", "N", "near or far"),
    row((SHIFT, Key::B), Act::FromMeasured, "pose", "Shift-B", "the pose of the servos"),
    row((NONE, Key::B), Act::FromClip, "pose", "B", "back to the clip's pose"),
    row((SHIFT, Key::OpenBracket), Act::Dial(-10.0), "desk", "[ ] with Shift", "turn the chosen dial"),
    row((SHIFT, Key::CloseBracket), Act::Dial(10.0), "desk", "", ""),
    row((NONE, Key::OpenBracket), Act::Dial(-1.0), "desk", "", ""),
    row((NONE, Key::CloseBracket), Act::Dial(1.0), "desk", "", ""),
    row((NONE, Key::Q), Act::Turn(-VIEW_RAD, 0.0), "view", "Q E", "turn the view"),
    row((NONE, Key::E), Act::Turn(VIEW_RAD, 0.0), "view", "", ""),
    row((NONE, Key::W), Act::Turn(0.0, VIEW_RAD), "view", "W S", "tilt the view"),
    row((NONE, Key::S), Act::Turn(0.0, -VIEW_RAD), "view", "", ""),
    row((NONE, Key::PageUp), Act::Zoom(1.25), "view", "PgUp, PgDn", "zoom"),
    row((NONE, Key::PageDown), Act::Zoom(0.8), "view", "", ""),
    row((NONE, Key::V), Act::Fit, "view", "V", "the whole figure"),
    row((NONE, Key::O), Act::Onion, "view", "O T G", "onion skin, ticks, floor"),
    on_stage(row((SHIFT, Key::T), Act::Teach, "puppet", "Shift-T", "teach by hand, torque off")),
    row((NONE, Key::T), Act::Ticks, "view", "", ""),
    row((NONE, Key::G), Act::Floor, "view", "", ""),
    row((CTRL, Key::R), Act::Reset, "puppet", "Ctrl-R", "reset after a fault"),
    row((NONE, Key::A), Act::Arm, "puppet", "A", "arm"),
    row((NONE, Key::P), Act::PuppetPlay, "puppet", "P", "play the clip"),
    on_stage(row((SHIFT, Key::F), Act::SlowToFit, "puppet", "Shift-F", "slow the clip to fit")),
    row((NONE, Key::F), Act::Follow, "puppet", "F", "follow the screen"),
    row((NONE, Key::H), Act::Hold, "puppet", "H", "hold"),
    row((NONE, Key::R), Act::Release, "puppet", "R", "release"),
    everywhere(row((SHIFT, Key::Questionmark), Act::Help, "show", "?", "this page")),
    everywhere(row((NONE, Key::Questionmark), Act::Help, "show", "", "")),
    everywhere(row((SHIFT, Key::Slash), Act::Help, "show", "", "")),
    row((NONE, Key::Tab), Act::Add, "patch", "Tab", "add a function, by name"),
    row((NONE, Key::F), Act::Frame, "patch", "F", "show the selection, or all"),
    row((NONE, Key::Delete), Act::PatchDelete, "patch", "Delete", "delete the selection"),
    row((NONE, Key::Backspace), Act::PatchDelete, "patch", "", ""),
    row((CTRL, Key::D), Act::Duplicate, "patch", "Ctrl-D", "copy the selection"),
    row((CTRL, Key::A), Act::SelectAll, "patch", "Ctrl-A", "select all"),
    row((CTRL_SHIFT, Key::Z), Act::PatchRedo, "patch", "", ""),
    row((CTRL, Key::Z), Act::PatchUndo, "patch", "", ""),
    row((CTRL, Key::L), Act::LayOut, "patch", "Ctrl-L", "lay everything out"),
    row((NONE, Key::G), Act::Fold, "patch", "G", "fold, unfold a structure"),
    row((NONE, Key::P), Act::Probe, "patch", "P", "pin a read-out of the port"),
    row((NONE, Key::X), Act::Freeze, "patch", "X", "hold the output back, let go"),
    row((NONE, Key::T), Act::PatchText, "patch", "T", "the text beside the graph"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_means_two_things() {
        for (index, a) in SHORTCUTS.iter().enumerate() {
            for b in &SHORTCUTS[index + 1..] {
                let apart = a.place != b.place && [a.place, b.place].iter().all(|p| *p != Place::Everywhere);
                if apart {
                    continue;
                }
                assert!((a.modifiers, a.key) != (b.modifiers, b.key), "{:?} twice", a.key);
                // `consume_key` lets Shift through where a row does not ask for it.
                let hidden = a.key == b.key && a.modifiers == NONE && b.modifiers.shift;
                assert!(!hidden, "{:?} with Shift is never reached", b.key);
            }
        }
    }
}
