//! Edits and undo: refusals say why, and going back and forth is exact.

use std::path::Path;
use std::sync::Arc;

use motion::FigurePose;
use proptest::prelude::*;
use rig::document::source::Source;
use rig::document::{ClipDoc, EditError, FigureDoc, FigureTexts, Findings, Show, apply};
use rig::history::History;
use rig::{EditCommand, KineticsMode};

fn show(times: &[f64]) -> (Show, FigurePose) {
    let source = Source::from_text(
        Path::new("two.str"),
        "two links\n0 a 3 1\n 1 0 0 1\n\n1 b 2 0.5\n",
    );
    let mut found = Findings::default();
    let figure = FigureDoc::read("two", &source, FigureTexts::default(), &mut found).expect("a figure");
    let pose = figure.figure.rest_pose();
    let empty = Show {
        figure: Some(Arc::new(figure)),
        ..Show::default()
    };
    let store = |show: Show, secs: &f64| {
        apply(&show, &EditCommand::StoreKey { secs: *secs }, Some(&pose))
            .expect("stores")
            .show
    };
    (times.iter().fold(empty, store), pose)
}

fn clip(show: &Show) -> &ClipDoc {
    show.current_clip().expect("a clip")
}

#[test]
fn edits_do_what_their_words_say() {
    let (show, pose) = show(&[2.0, 0.0, 1.0]);
    assert_eq!(
        (show.clip.as_str(), clip(&show).times_secs()),
        ("clip", vec![0.0, 1.0, 2.0])
    );
    let cases: [(EditCommand, Vec<f64>, &str, bool); 6] = [
        (
            EditCommand::StoreKey { secs: 1.5 },
            vec![0.0, 1.0, 1.5, 2.0],
            "Store key at 1.50 s",
            false,
        ),
        (
            EditCommand::StoreKey { secs: 1.0 },
            vec![0.0, 1.0, 2.0],
            "Change key at 1.00 s",
            false,
        ),
        (
            EditCommand::DeleteKey { key: 0 },
            vec![1.0, 2.0],
            "Delete key at 0.00 s",
            false,
        ),
        (
            EditCommand::MoveKey { key: 1, secs: 1.9 },
            vec![0.0, 1.9, 2.0],
            "Move key 1 to 1.90 s",
            true,
        ),
        (
            EditCommand::CopyKey { key: 0, secs: 3.0 },
            vec![0.0, 1.0, 2.0, 3.0],
            "Copy key 0 to 3.00 s",
            false,
        ),
        (
            EditCommand::KineticsMode(KineticsMode::Linear),
            vec![0.0, 1.0, 2.0],
            "Make timing linear",
            false,
        ),
    ];
    for (edit, times, words, gesture) in cases {
        let edited = apply(&show, &edit, Some(&pose)).expect(words);
        assert_eq!(clip(&edited.show).times_secs(), times);
        assert_eq!(
            (edited.words.as_str(), edited.gesture.is_some()),
            (words, gesture)
        );
    }
}

#[test]
fn kinetic_adjustments_add_up_and_belong_to_their_keys() {
    let (show, pose) = show(&[0.0, 1.0, 2.0]);
    let by =
        |show: &Show, by| apply(show, &EditCommand::Kinetics { coefficient: 2, by }, None).expect("adjusts");
    let once = by(&show, 0.25);
    let twice = by(&once.show, 0.25);
    assert_eq!(clip(&twice.show).coefficient_edits, [(2, 0.5)]);
    assert_eq!(once.gesture, twice.gesture);
    assert_eq!(by(&twice.show, -0.5).show, show, "taken back by hand");
    let reset = apply(&twice.show, &EditCommand::ResetKinetics, None).expect("resets");
    assert_eq!(reset.show, show);
    let more = apply(&twice.show, &EditCommand::StoreKey { secs: 5.0 }, Some(&pose)).expect("stores");
    assert_eq!(clip(&more.show).coefficient_edits, []);
}

#[test]
fn refusals_say_why() {
    let (show, pose) = show(&[0.0, 1.0, 2.0]);
    let stranger = FigurePose {
        links: pose.links[..1].to_vec(),
        ..pose.clone()
    };
    let mut broken = pose.clone();
    broken.links[0].direction.x = f64::NAN;
    let cases: [(EditCommand, Option<&FigurePose>, &str); 12] = [
        (EditCommand::StoreKey { secs: 0.5 }, None, "no pose on screen"),
        (
            EditCommand::StoreKey { secs: 0.5 },
            Some(&stranger),
            "1 links and the figure 2",
        ),
        (EditCommand::StoreKey { secs: 0.5 }, Some(&broken), "not finite"),
        (
            EditCommand::StoreKey { secs: f64::NAN },
            Some(&pose),
            "no time for a key",
        ),
        (EditCommand::DeleteKey { key: 3 }, None, "no key 3"),
        (
            EditCommand::MoveKey { key: 1, secs: 2.0 },
            None,
            "between its neighbours",
        ),
        (
            EditCommand::MoveKey { key: 1, secs: -1.0 },
            None,
            "between its neighbours",
        ),
        (EditCommand::MoveKey { key: 9, secs: 1.0 }, None, "no key 9"),
        (
            EditCommand::CopyKey { key: 0, secs: 1.0 },
            None,
            "already is a key",
        ),
        (
            EditCommand::Kinetics {
                coefficient: 0,
                by: 1.0,
            },
            None,
            "holds an end",
        ),
        (
            EditCommand::Kinetics {
                coefficient: 5,
                by: 1.0,
            },
            None,
            "no kinetic coefficient 5",
        ),
        (EditCommand::ChooseClip("walk".into()), None, "there are: clip"),
    ];
    for (edit, pose, words) in cases {
        let error = apply(&show, &edit, pose).expect_err(words).to_string();
        assert!(error.contains(words), "{edit:?}: {error}");
    }
    let nobody = apply(
        &Show::default(),
        &EditCommand::StoreKey { secs: 0.0 },
        Some(&pose),
    );
    assert_eq!(nobody, Err(EditError::NoFigure));
}

fn any_edit() -> impl Strategy<Value = EditCommand> {
    let secs = (0..40_u8).prop_map(|tenths| f64::from(tenths) / 10.0);
    let key = 0..8_usize;
    prop_oneof![
        secs.clone().prop_map(|secs| EditCommand::StoreKey { secs }),
        key.clone().prop_map(|key| EditCommand::DeleteKey { key }),
        (key.clone(), secs.clone()).prop_map(|(key, secs)| EditCommand::MoveKey { key, secs }),
        (key.clone(), secs).prop_map(|(key, secs)| EditCommand::CopyKey { key, secs }),
        (key, -1.0..1.0).prop_map(|(coefficient, by)| EditCommand::Kinetics { coefficient, by }),
        Just(EditCommand::KineticsMode(KineticsMode::Natural)),
        Just(EditCommand::KineticsMode(KineticsMode::Monotone)),
        Just(EditCommand::ResetKinetics),
        Just(EditCommand::ChooseClip("clip".into())),
    ]
}

proptest! {
    #[test]
    fn undo_all_is_the_original_and_redo_all_the_result(edits in prop::collection::vec(any_edit(), 0..40)) {
        let (original, pose) = show(&[0.0, 1.0, 2.0]);
        let mut history = History::new(original.clone());
        for edit in &edits {
            if let Ok(edited) = apply(history.present(), edit, Some(&pose)) {
                prop_assert!(clip(&edited.show).keys.windows(2).all(|pair| pair[0].secs < pair[1].secs));
                if let Some(figure) = &edited.show.figure {
                    prop_assert!(clip(&edited.show).clip(&figure.figure).is_ok(), "after {:?}", edit);
                }
                history.push(edited.show, edited.words, edited.gesture);
            }
        }
        let result = Show::clone(history.present());
        while history.undo().is_some() {}
        prop_assert_eq!(&**history.present(), &original);
        while history.redo().is_some() {}
        prop_assert_eq!(&**history.present(), &result);
    }
}
