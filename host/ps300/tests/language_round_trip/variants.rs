//! Every variant there is of commands, nodes and operations, by name. The matches have no other arm, so that a
//! new variant does not compile until it stands here, and then fails until a strategy makes it.

use std::collections::BTreeSet;

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use ps300::language::{Command, Definition, FORMS, Node, Operation, parse};

use super::commands::{commands, node};
use super::operations::operations;

macro_rules! variants {
    ($function:ident, $all:ident, $type:ident: $($variant:ident)*) => {
        const $all: &[&str] = &[$(stringify!($variant)),*];

        fn $function(of: &$type) -> &'static str {
            match of {
                $($type::$variant { .. } => stringify!($variant),)*
            }
        }
    };
}

variants!(command_variant, COMMANDS, Command:
    Define Connect Disconnect Send Store Variable SetupCness Include RemoveFrom Display Remove Delete DeleteAll Forget
    Follow Prefix Initialize SetupState PatternWith BeginGroup EndGroup Optimize EndOptimize ReserveWorkingStorage
    CommandStatus Reset);

variants!(node_variant, NODES, Node:
    Nil Instance Structure Function Operation VectorList Characters Labels BSpline Polynomial Polygons Attributes
    Illumination Pattern Font Copy);

variants!(operation_variant, OPERATIONS, Operation:
    Rotate Translate Scale Matrix2 Matrix3 Matrix4x3 Matrix4 Look FieldOfView Window Eye Viewport SetColor
    SetIntensity SetDepthClipping SetPicking SetPickingIdentifier SetConditionalBit IfConditionalBit SetColorBlending
    SetContrast SetPickingLocation SetLevelOfDetail IncrementLevelOfDetail DecrementLevelOfDetail IfLevelOfDetail
    SetRate SetRateExternal IfPhase SetDisplay SetPlotter SetLineTexture CharacterScale CharacterRotate CharacterFont
    StandardFont TextSize XformMatrix XformVectorList SurfaceRendering SolidRendering SectioningPlane);

fn made<T>(strategy: &impl Strategy<Value = T>, runner: &mut TestRunner) -> T {
    strategy
        .new_tree(runner)
        .expect("nothing is filtered out for long")
        .current()
}

fn missing(all: &[&'static str], found: &BTreeSet<&'static str>) -> Vec<&'static str> {
    all.iter().copied().filter(|name| !found.contains(name)).collect()
}

fn note_node(node: &Node, found: &mut BTreeSet<&'static str>) {
    found.insert(node_variant(node));
    match node {
        Node::Structure(members) => {
            for member in members {
                note_node(&member.node, found);
            }
        }
        Node::Operation { operation, .. } => {
            found.insert(operation_variant(operation));
        }
        _ => {}
    }
}

/// Whatever there is, the reference shows.
#[test]
fn every_variant_has_an_example() {
    let mut found = BTreeSet::new();
    for form in FORMS.iter().flat_map(|section| section.forms) {
        for located in parse(form.example).0 {
            found.insert(command_variant(&located.what));
            match &located.what {
                Command::Define {
                    definition: Definition::Node(node),
                    ..
                } => note_node(node, &mut found),
                Command::Follow { with, .. } | Command::Prefix { with, .. } => {
                    found.insert(operation_variant(with));
                }
                _ => {}
            }
        }
    }
    for all in [COMMANDS, NODES, OPERATIONS] {
        assert_eq!(missing(all, &found), [""; 0]);
    }
}

#[test]
fn every_command_is_made() {
    let mut runner = TestRunner::deterministic();
    let found = commands()
        .iter()
        .map(|strategy| command_variant(&made(strategy, &mut runner)))
        .collect();
    assert_eq!(missing(COMMANDS, &found), [""; 0]);
}

#[test]
fn every_operation_is_made() {
    let mut runner = TestRunner::deterministic();
    let found = operations()
        .iter()
        .map(|strategy| operation_variant(&made(strategy, &mut runner)))
        .collect();
    assert_eq!(missing(OPERATIONS, &found), [""; 0]);
}

#[test]
fn every_node_is_made() {
    let mut runner = TestRunner::deterministic();
    let mut found = BTreeSet::new();
    let strategy = node();
    for _ in 0..1000 {
        note_node(&made(&strategy, &mut runner), &mut found);
    }
    assert_eq!(missing(NODES, &found), [""; 0]);
}
