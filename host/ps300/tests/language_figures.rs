//! The shape and primitive files of the printed human must read as they stand, without a remark.

use glam::DVec3;
use ps300::language::{
    Axis, Command, Definition, Name, Node, Operation, Vector, VectorClass, VectorList, parse, print,
};

const PRIMITIVES: &str = "\
linel:= vector connected n=2 0,0,0 0,0,0.1;
line:= set color 60,1 then linel;
trl:= vector connected n=4 -0.05,0,0 0.05,0,0 0,0,0.1 -0.05,0,0;
tr:= set color 90,1 then trl;
";

const SHAPES: &str = "\
rxtr:= rot x 180 then tr;
itr:=trans by 0,0,0.1 then rxtr;

head := scale by 1,1,2 then tr;
trunk:= scale by 2,1,3 then tr;
rua := scale by 2.0 then line;
rfa:= scale by 1.5 then line;
rh:= scale by 1.0 then line;
lua:= inst of rua;
lfa:= inst of rfa;
lh:= inst of rh;
pelv:= scale by 0.9,1,1 then itr;
rt := scale by 2.5 then line;
rc:= scale by 2.5 then line;
rf:= scale by 1.0 then line;
lt:= inst of rt;
lc:= inst of rc;
lf:= inst of rf;
";

fn read(source: &str) -> Vec<Command> {
    let (commands, diagnostics) = parse(source);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    commands.into_iter().map(|located| located.what).collect()
}

fn node(name: &str, node: Node) -> Command {
    Command::Define {
        name: name.into(),
        definition: Definition::Node(node),
    }
}

fn applied(operation: Operation, to: &str) -> Node {
    Node::Operation {
        operation,
        applied_to: Some(to.into()),
    }
}

#[test]
fn primitives_are_two_polylines_in_colour() {
    let commands = read(PRIMITIVES);
    let vector = |x, z, draw| Vector {
        at: DVec3::new(x, 0.0, z),
        draw,
        intensity: None,
    };
    let connected = |vectors| Node::VectorList(VectorList::new(VectorClass::Connected, vectors));
    assert_eq!(
        commands,
        [
            node(
                "linel",
                connected(vec![vector(0.0, 0.0, false), vector(0.0, 0.1, true)])
            ),
            node(
                "line",
                applied(
                    Operation::SetColor {
                        hue_deg: 60.0,
                        saturation: 1.0
                    },
                    "linel"
                )
            ),
            node(
                "trl",
                connected(vec![
                    vector(-0.05, 0.0, false),
                    vector(0.05, 0.0, true),
                    vector(0.0, 0.1, true),
                    vector(-0.05, 0.0, true),
                ])
            ),
            node(
                "tr",
                applied(
                    Operation::SetColor {
                        hue_deg: 90.0,
                        saturation: 1.0
                    },
                    "trl"
                )
            ),
        ]
    );
}

#[test]
fn shapes_are_operations_and_instances() {
    let commands = read(SHAPES);
    assert_eq!(commands.len(), 17);
    let rotate = Operation::Rotate {
        axis: Axis::X,
        degrees: 180.0,
    };
    assert_eq!(commands[0], node("rxtr", applied(rotate, "tr")));
    assert_eq!(
        commands[1],
        node(
            "itr",
            applied(Operation::Translate(DVec3::new(0.0, 0.0, 0.1)), "rxtr")
        )
    );
    assert_eq!(
        commands[4],
        node("rua", applied(Operation::Scale(DVec3::splat(2.0)), "line"))
    );
    assert_eq!(commands[7], node("lua", Node::Instance(vec![Name::new("rua")])));
    assert_eq!(
        commands[10],
        node(
            "pelv",
            applied(Operation::Scale(DVec3::new(0.9, 1.0, 1.0)), "itr")
        )
    );
}

#[test]
fn canonical_text_of_the_figures_reads_back() {
    for source in [PRIMITIVES, SHAPES] {
        let commands = read(source);
        let canonical: String = commands.iter().map(|command| print(command) + "\n").collect();
        assert_eq!(read(&canonical), commands);
    }
}
