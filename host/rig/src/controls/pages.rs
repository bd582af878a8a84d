//! Which page of a device is up: the one somebody went to, or the one of the link or joint in hand.
//!
//! Pure.

use super::inlets::PAGES;

/// The pages of one device.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pages {
    /// From 1.
    pub(crate) now: u8,
    /// Whether a selection may change it.
    pub(crate) follows: bool,
    pub(super) focus: [String; PAGES as usize],
}

impl Default for Pages {
    fn default() -> Self {
        Self {
            now: 1,
            follows: true,
            focus: Default::default(),
        }
    }
}

impl Pages {
    /// Goes to a page and stays there. False where there is no such page.
    pub(crate) fn go(&mut self, page: u8) -> bool {
        let is_there = (1..=PAGES).contains(&page);
        if is_there {
            self.now = page;
            self.follows = false;
        }
        is_there
    }

    /// Has a page come up for a link or joint; for none where that is empty.
    pub(crate) fn come_up(&mut self, page: u8, focus: &str) -> bool {
        let place = self.focus.get_mut(usize::from(page).wrapping_sub(1));
        place.map(|it| focus.clone_into(it)).is_some()
    }

    /// A link or joint was selected. Another page comes up where one is for it and pages follow.
    pub(crate) fn selected(&mut self, focus: &str) {
        let mut all = self.focus.iter();
        let found = all.position(|it| !it.is_empty() && it.eq_ignore_ascii_case(focus));
        if let Some(place) = found.filter(|_| self.follows) {
            self.now = place as u8 + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_follows_or_stays() {
        let mut pages = Pages::default();
        assert!(pages.come_up(2, "rua") && pages.come_up(3, "lua") && !pages.come_up(5, "x"));
        pages.selected("RUA");
        assert_eq!(pages.now, 2);
        pages.selected("head");
        assert_eq!(pages.now, 2, "nothing is for the head");
        assert!(pages.go(1) && !pages.go(9) && !pages.go(0));
        pages.selected("lua");
        assert_eq!(pages.now, 1, "it stays");
        pages.follows = true;
        pages.selected("lua");
        assert_eq!(pages.now, 3);
        pages.come_up(3, "");
        pages.selected("");
        assert_eq!(pages.now, 3);
    }
}
