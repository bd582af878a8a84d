//! A show as a handful of texts, as a journal carries it.

use super::salute;
use rig::document;

#[test]
fn a_show_comes_back_from_its_texts() {
    let show = salute();
    let texts = document::texts(&show).expect("it can be written");
    assert!(
        texts.contains_key("show.toml") && texts.contains_key("networks/figure.ps300"),
        "{:?}",
        texts.keys()
    );
    assert_eq!(document::from_texts(&texts).expect("it can be read"), show);
}

#[test]
fn texts_stay_inside_their_folder() {
    let texts = [("../outside.toml".to_owned(), "version = 1".to_owned())].into();
    let refused = document::from_texts(&texts).expect_err("a path that leaves the folder");
    assert!(refused.to_string().contains("must lie inside"), "{refused}");
}
