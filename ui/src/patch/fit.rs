//! Whether a wire may join two ports, and if not, why not, in words for the pointer.

use ps300::language::Input;

use super::scene::{Port, Scene, Shown, ShownWire};

/// What a wire between two ports would be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fit {
    /// Everything sent is taken.
    Whole,
    /// Some kinds that may be sent are refused at the input.
    Partly(String),
    /// Nothing could ever pass, or the wire is there.
    Refused(String),
}

/// Judges a wire from an output to an input, both by box and port.
pub fn judge(scene: &Scene, from: (usize, usize), to: (usize, usize)) -> Fit {
    let (Some(sender), Some(taker)) = (scene.boxes.get(from.0), scene.boxes.get(to.0)) else {
        return Fit::Refused(String::from("one end is gone"));
    };
    let (Some(output), Some(input)) = (sender.outputs.get(from.1), taker.inputs.get(to.1)) else {
        return Fit::Refused(String::from("one end is gone"));
    };
    if scene.wires.contains(&ShownWire { from, to }) {
        return Fit::Refused(format!(
            "{} is connected to {} already",
            output_text(output),
            input_text(input)
        ));
    }
    kinds(sender, output, input)
}

fn kinds(_sender: &Shown, output: &Port, input: &Port) -> Fit {
    let (sends, takes) = (output.kinds, input.kinds);
    if !sends.meets(takes) {
        let (from, to) = (output_text(output), input_text(input));
        return Fit::Refused(format!("{from} sends {sends}; {to} takes {takes}"));
    }
    let lost: Vec<&str> = sends
        .iter()
        .filter(|&kind| !takes.has(kind))
        .map(ps300::Kind::name)
        .collect();
    if lost.is_empty() || sends == ps300::Kinds::ANY {
        return Fit::Whole;
    }
    Fit::Partly(format!("{} refuses {}", input_text(input), lost.join(" and ")))
}

/// `name<1>`.
pub fn output_text(port: &Port) -> String {
    format!("{}<{}>", port.of, port_word(port.input))
}

/// `<1>name`.
pub fn input_text(port: &Port) -> String {
    format!("<{}>{}", port_word(port.input), port.of)
}

fn port_word(input: Input) -> std::sync::Arc<str> {
    super::scene::input_word(input)
}
