//! Commands, and the nodes that hold others.

use proptest::prelude::*;
use ps300::language::{
    Command, Definition, Disconnection, Initialization, Input, InputOf, Member, Node, OutputOf, Payload,
};

use super::atoms::{label, name, value};
use super::data::data;
use super::operations::operation;

fn function() -> impl Strategy<Value = Node> {
    (name(), prop::option::of(1..=u16::MAX)).prop_map(|(function, size)| Node::Function { function, size })
}

/// One strategy for each node that can stand by itself and holds no others.
fn leaves() -> Vec<BoxedStrategy<Node>> {
    let mut leaves = data();
    leaves.push(Just(Node::Nil).boxed());
    leaves.push(
        prop::collection::vec(name(), 0..4)
            .prop_map(Node::Instance)
            .boxed(),
    );
    for _ in 0..6 {
        leaves.push(
            (operation(), prop::option::of(name()))
                .prop_map(|(operation, applied_to)| Node::Operation {
                    operation,
                    applied_to,
                })
                .boxed(),
        );
    }
    leaves
}

pub(crate) fn node() -> impl Strategy<Value = Node> {
    prop::strategy::Union::new(leaves()).prop_recursive(3, 12, 4, |inner| {
        let node = (prop::option::of(label()), inner).prop_map(|(label, node)| Member { label, node });
        let function = (label(), function()).prop_map(|(label, node)| Member {
            label: Some(label),
            node,
        });
        prop::collection::vec(prop_oneof![4 => node, 1 => function], 0..4).prop_map(Node::Structure)
    })
}

fn definition() -> impl Strategy<Value = Definition> {
    prop_oneof![
        1 => (name(), prop::option::of(1..=u16::MAX))
            .prop_map(|(function, size)| Definition::Function { function, size }),
        4 => node().prop_map(Definition::Node),
    ]
}

fn output_of() -> impl Strategy<Value = OutputOf> {
    (name(), 1..=u8::MAX).prop_map(|(name, output)| OutputOf { name, output })
}

fn input_of() -> impl Strategy<Value = InputOf> {
    let input = prop_oneof![
        (1..=u16::MAX).prop_map(Input::Number),
        prop::sample::select(Input::NAMED.map(|(_, input)| input).to_vec()),
    ];
    (name(), input).prop_map(|(name, input)| InputOf { name, input })
}

fn payload() -> impl Strategy<Value = Payload> {
    prop_oneof![
        6 => value().prop_map(Payload::Value),
        1 => name().prop_map(Payload::Variable),
        1 => name().prop_map(Payload::VectorsOf),
    ]
}

fn disconnection() -> impl Strategy<Value = Disconnection> {
    prop_oneof![
        (output_of(), input_of()).prop_map(|(from, to)| Disconnection::Pair { from, to }),
        output_of().prop_map(Disconnection::Output),
        name().prop_map(Disconnection::All),
    ]
}

fn initialization() -> impl Strategy<Value = Initialization> {
    use Initialization::{Connections, Display, Everything, Names};
    prop::sample::select(vec![Everything, Connections, Display, Names])
}

fn network() -> Vec<BoxedStrategy<Command>> {
    vec![
        (output_of(), input_of())
            .prop_map(|(from, to)| Command::Connect { from, to })
            .boxed(),
        disconnection().prop_map(Command::Disconnect).boxed(),
        (payload(), input_of())
            .prop_map(|(payload, to)| Command::Send { payload, to })
            .boxed(),
        (payload(), input_of())
            .prop_map(|(payload, to)| Command::Store { payload, to })
            .boxed(),
        prop::collection::vec(name(), 1..4)
            .prop_map(Command::Variable)
            .boxed(),
        (any::<bool>(), input_of())
            .prop_map(|(constant, input)| Command::SetupCness { constant, input })
            .boxed(),
        (name(), prop::collection::vec(value(), 0..4))
            .prop_map(|(name, values)| Command::SetupState { name, values })
            .boxed(),
    ]
}

fn structure() -> Vec<BoxedStrategy<Command>> {
    vec![
        (name(), name())
            .prop_map(|(member, instance)| Command::Include { member, instance })
            .boxed(),
        (name(), name())
            .prop_map(|(member, instance)| Command::RemoveFrom { member, instance })
            .boxed(),
        name().prop_map(Command::Display).boxed(),
        name().prop_map(Command::Remove).boxed(),
        name().prop_map(Command::Delete).boxed(),
        name().prop_map(|prefix| Command::DeleteAll { prefix }).boxed(),
        name().prop_map(Command::Forget).boxed(),
        (name(), operation())
            .prop_map(|(name, with)| Command::Follow { name, with })
            .boxed(),
        (name(), operation())
            .prop_map(|(name, with)| Command::Prefix { name, with })
            .boxed(),
        (name(), name())
            .prop_map(|(list, pattern)| Command::PatternWith { list, pattern })
            .boxed(),
    ]
}

fn housekeeping() -> Vec<BoxedStrategy<Command>> {
    vec![
        initialization().prop_map(Command::Initialize).boxed(),
        Just(Command::BeginGroup).boxed(),
        Just(Command::EndGroup).boxed(),
        Just(Command::Optimize).boxed(),
        Just(Command::EndOptimize).boxed(),
        any::<u32>()
            .prop_map(|bytes| Command::ReserveWorkingStorage { bytes })
            .boxed(),
        Just(Command::CommandStatus).boxed(),
        Just(Command::Reset).boxed(),
    ]
}

/// One strategy for each command, definitions several times: they are most of the language.
pub(crate) fn commands() -> Vec<BoxedStrategy<Command>> {
    let define = (name(), definition())
        .prop_map(|(name, definition)| Command::Define { name, definition })
        .boxed();
    [network(), structure(), housekeeping(), vec![define; 12]].concat()
}

pub(crate) fn command() -> impl Strategy<Value = Command> {
    prop::strategy::Union::new(commands())
}
