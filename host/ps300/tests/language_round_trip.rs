//! Printing is the exact inverse of reading, for every command there is.

use glam::{DAffine3, DMat2, DMat3, DMat4, DVec2, DVec3, DVec4};
use proptest::prelude::*;
use ps300::language::{
    Axis, Boundaries, Characters, Command, Definition, Disconnection, Initialization, Input, InputOf, Member,
    Name, Node, Operation, OutputOf, Payload, Range, Vector, VectorClass, VectorList, parse, print,
};
use ps300::value::Value;

/// Names that are also words of the language, long names, dotted names.
fn name() -> impl Strategy<Value = Name> {
    prop_oneof![
        3 => "[A-Za-z][A-Za-z0-9_$]{0,8}",
        2 => prop::sample::select(vec![
            "to", "of", "in", "then", "applied", "f", "n", "p", "l", "i", "x", "on", "off", "all", "value", "fix",
            "char", "true", "with", "from", "at", "up", "step", "by", "is", "send", "connect", "nil", "begin_s", "end_s",
            "rotate", "names", "display", "identifier", "front", "v3d", "Größe",
        ]).prop_map(str::to_owned),
        1 => "[a-z]{1,3}\\.[a-z][a-z0-9]{0,3}",
        1 => "[a-z]{200,240}",
    ]
    .prop_map(|text| Name::new(&text))
}

/// Labels have no dots.
fn label() -> impl Strategy<Value = Name> {
    name().prop_filter("a label has no dot", |name| !name.as_str().contains('.'))
}

fn real() -> impl Strategy<Value = f64> {
    prop_oneof![
        2 => prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 5.0, 1e-300, -1e300, 5e-324, f64::MAX, f64::MIN_POSITIVE,
            0.1, 1.0 / 3.0, 1e16, 123_456_789_012_345_680.0, 1e15]),
        3 => -1000.0..1000.0,
        1 => any::<f64>().prop_filter("literals are finite", |number| number.is_finite()),
    ]
}

fn reals<const COUNT: usize>() -> impl Strategy<Value = [f64; COUNT]> {
    prop::collection::vec(real(), COUNT).prop_map(|numbers| numbers.try_into().expect("as many as asked for"))
}

fn point() -> impl Strategy<Value = DVec3> {
    reals::<3>().prop_map(DVec3::from_array)
}

fn text() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(String::new()),
        "[ -~]{0,12}",
        "['\";{}\n\r\t\u{0}\u{7f}a]{0,8}",
        any::<String>(),
    ]
}

fn value() -> impl Strategy<Value = Value> {
    prop_oneof![
        any::<bool>().prop_map(Value::from),
        any::<i32>().prop_map(Value::from),
        real().prop_map(Value::from),
        text().prop_map(|text| Value::from(text.as_str())),
        reals::<2>().prop_map(|n| DVec2::from_array(n).into()),
        reals::<3>().prop_map(|n| DVec3::from_array(n).into()),
        reals::<4>().prop_map(|n| DVec4::from_array(n).into()),
        reals::<4>().prop_map(|n| DMat2::from_cols_array(&n).into()),
        reals::<9>().prop_map(|n| DMat3::from_cols_array(&n).into()),
        reals::<16>().prop_map(|n| DMat4::from_cols_array(&n).into()),
        reals::<12>().prop_map(|n| DAffine3::from_cols_array(&n).into()),
    ]
}

fn range() -> impl Strategy<Value = Range> {
    reals::<2>().prop_map(|[from, to]| Range { from, to })
}

fn boundaries() -> impl Strategy<Value = Option<Boundaries>> {
    prop::option::of(reals::<2>().prop_map(|[front, back]| Boundaries { front, back }))
}

fn operation() -> impl Strategy<Value = Operation> {
    let axis = prop::sample::select(vec![Axis::X, Axis::Y, Axis::Z]);
    let transform = prop_oneof![
        (axis, real()).prop_map(|(axis, degrees)| Operation::Rotate { axis, degrees }),
        point().prop_map(Operation::Translate),
        point().prop_map(Operation::Scale),
        real().prop_map(|factor| Operation::Scale(DVec3::splat(factor))),
        reals::<4>().prop_map(|n| Operation::Matrix2(DMat2::from_cols_array(&n))),
        reals::<9>().prop_map(|n| Operation::Matrix3(DMat3::from_cols_array(&n))),
        reals::<12>().prop_map(|n| Operation::Matrix4x3(DAffine3::from_cols_array(&n))),
        reals::<16>().prop_map(|n| Operation::Matrix4(DMat4::from_cols_array(&n))),
        (point(), point(), prop::option::of(point())).prop_map(|(at, from, up)| Operation::Look {
            at,
            from,
            up
        }),
        (real(), boundaries())
            .prop_map(|(degrees, boundaries)| Operation::FieldOfView { degrees, boundaries }),
        (range(), range(), boundaries()).prop_map(|(x, y, boundaries)| Operation::Window {
            x,
            y,
            boundaries
        }),
        (range(), range(), prop::option::of(range())).prop_map(|(horizontal, vertical, intensity)| {
            Operation::Viewport {
                horizontal,
                vertical,
                intensity,
            }
        }),
    ];
    let attribute = prop_oneof![
        reals::<2>().prop_map(|[hue_deg, saturation]| Operation::SetColor { hue_deg, saturation }),
        (any::<bool>(), range()).prop_map(|(on, range)| Operation::SetIntensity { on, range }),
        any::<bool>().prop_map(Operation::SetDepthClipping),
        any::<bool>().prop_map(Operation::SetPicking),
        name().prop_map(Operation::SetPickingIdentifier),
        (0..Operation::CONDITIONAL_BITS, any::<bool>())
            .prop_map(|(bit, on)| Operation::SetConditionalBit { bit, on }),
        (0..Operation::CONDITIONAL_BITS, any::<bool>())
            .prop_map(|(bit, on)| Operation::IfConditionalBit { bit, on }),
    ];
    prop_oneof![transform, attribute]
}

fn vector_list() -> impl Strategy<Value = VectorList> {
    let class = prop::sample::select(vec![
        VectorClass::Connected,
        VectorClass::Dots,
        VectorClass::Itemized,
        VectorClass::Separate,
    ]);
    let vector = (point(), any::<bool>(), prop::option::of(real()));
    (class, prop::collection::vec(vector, 0..8)).prop_map(|(class, vectors)| {
        let vectors = vectors
            .into_iter()
            .enumerate()
            .map(|(index, (at, draw, intensity))| Vector {
                at,
                draw: class.draws(index).unwrap_or(draw),
                intensity,
            });
        VectorList::new(class, vectors.collect())
    })
}

fn characters() -> impl Strategy<Value = Characters> {
    let at = prop_oneof![Just(DVec3::ZERO), point()];
    let step = prop_oneof![Just(DVec2::X), reals::<2>().prop_map(DVec2::from_array)];
    (at, step, text()).prop_map(|(at, step, text)| Characters {
        at,
        step,
        text: text.into(),
    })
}

fn node() -> impl Strategy<Value = Node> {
    let leaf = prop_oneof![
        1 => Just(Node::Nil),
        2 => prop::collection::vec(name(), 1..4).prop_map(Node::Instance),
        6 => (operation(), prop::option::of(name()))
            .prop_map(|(operation, applied_to)| Node::Operation { operation, applied_to }),
        2 => vector_list().prop_map(Node::VectorList),
        1 => characters().prop_map(Node::Characters),
    ];
    leaf.prop_recursive(3, 12, 4, |inner| {
        let member = (prop::option::of(label()), inner).prop_map(|(label, node)| Member { label, node });
        prop::collection::vec(member, 0..4).prop_map(Node::Structure)
    })
}

fn definition() -> impl Strategy<Value = Definition> {
    prop_oneof![
        1 => (name(), prop::option::of(1..=u16::MAX))
            .prop_map(|(function, size)| Definition::Function { function, size }),
        3 => node().prop_map(Definition::Node),
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
    prop_oneof![5 => value().prop_map(Payload::Value), 1 => name().prop_map(Payload::Variable)]
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

fn command() -> impl Strategy<Value = Command> {
    let network = prop_oneof![
        (output_of(), input_of()).prop_map(|(from, to)| Command::Connect { from, to }),
        disconnection().prop_map(Command::Disconnect),
        (payload(), input_of()).prop_map(|(payload, to)| Command::Send { payload, to }),
        (payload(), input_of()).prop_map(|(payload, to)| Command::Store { payload, to }),
        prop::collection::vec(name(), 1..4).prop_map(Command::Variable),
        (any::<bool>(), input_of()).prop_map(|(constant, input)| Command::SetupCness { constant, input }),
    ];
    let structure = prop_oneof![
        (name(), name()).prop_map(|(member, instance)| Command::Include { member, instance }),
        (name(), name()).prop_map(|(member, instance)| Command::RemoveFrom { member, instance }),
        name().prop_map(Command::Display),
        name().prop_map(Command::Remove),
        name().prop_map(Command::Delete),
        name().prop_map(|prefix| Command::DeleteAll { prefix }),
        name().prop_map(Command::Forget),
        (name(), operation()).prop_map(|(name, with)| Command::Follow { name, with }),
        (name(), operation()).prop_map(|(name, with)| Command::Prefix { name, with }),
        initialization().prop_map(Command::Initialize),
    ];
    let define = (name(), definition()).prop_map(|(name, definition)| Command::Define { name, definition });
    prop_oneof![3 => define, 2 => network, 2 => structure]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_printed_reads_back(command in command()) {
        let printed = print(&command);
        let (read, diagnostics) = parse(&printed);
        prop_assert!(diagnostics.is_empty(), "{printed}\n{diagnostics:#?}");
        prop_assert_eq!(read.len(), 1, "{}", printed);
        // By debug text as well: it tells -0 from 0 and the case of names, which equality does not.
        prop_assert_eq!(format!("{:?}", read[0].what), format!("{command:?}"), "{}", printed);
        prop_assert_eq!(&read[0].what, &command);
        prop_assert_eq!(print(&read[0].what), printed);
    }

    #[test]
    fn programs_read_back_whole(commands in prop::collection::vec(command(), 0..6)) {
        let program: String = commands.iter().map(|command| print(command) + "\n").collect();
        let (read, diagnostics) = parse(&program);
        prop_assert!(diagnostics.is_empty(), "{program}\n{diagnostics:#?}");
        prop_assert_eq!(read.into_iter().map(|command| command.what).collect::<Vec<_>>(), commands);
    }

    #[test]
    fn any_text_is_read_without_panic(source in any::<String>()) {
        parse(&source);
    }

    /// Commands with a piece cut out of the middle: most of the grammar's ways to fail.
    #[test]
    fn damaged_commands_spare_what_follows(command in command(), cut in 0.0..1.0_f64, length in 1..6_usize) {
        let printed = print(&command);
        let characters: Vec<char> = printed.chars().collect();
        let start = (cut * characters.len() as f64) as usize;
        let end = (start + length).min(characters.len());
        let damaged: String = characters[..start].iter().chain(&characters[end..]).collect();
        let (read, _) = parse(&format!("{damaged}\n;\nEND_STRUCTURE;\nlast := NIL;\n'}} ;\nlast := NIL;"));
        // Damage that opens a comment, quote or structure may hide the rest, nothing else may.
        let hides = command_hides(&printed);
        let last = Command::Define { name: "last".into(), definition: Definition::Node(Node::Nil) };
        prop_assert!(hides || read.iter().any(|command| command.what == last), "{damaged}");
    }
}

fn command_hides(printed: &str) -> bool {
    printed.contains(['{', '\''])
        || printed.contains("BEGIN_STRUCTURE")
        || printed.to_lowercase().contains("begin_s")
}
