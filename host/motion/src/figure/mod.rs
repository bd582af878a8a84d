//! The figure that people pose: a tree of links, each a direction on a sphere and a twist.
//!
//! Orientations are absolute: only start positions pass down the tree, so turning one link moves its
//! children and never turns them. Not to be confused with [`crate::chain`], where rotations are inherited.
//! Source: the thesis, chapters 4 and 5.

mod build;
mod frame;
mod great_circle;
mod place;
pub mod posing;
mod sweep;

pub use build::{FigureError, FigureWarning, LinkSpec};
pub use frame::{Zyz, frame_of, matrix_from_zyz, zyz_from_matrix};
pub use great_circle::{BadDirection, DirectionLaw, GreatCircle, unit};
pub use place::Placed;
pub use sweep::{Sweep, TwistLaw};

pub(crate) use sweep::twist_of;

use glam::DVec3;

/// Which link of a figure, in visiting order: a parent's index is always smaller than its children's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinkIndex(pub u16);

impl LinkIndex {
    /// For indexing slices.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// How a link may be turned by hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// A direction. The twist dial does not reach it.
    Two,
    /// A direction and a twist about it.
    Three,
}

/// Where a child starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attachment {
    /// Which link starts there.
    pub child: LinkIndex,
    /// Where in the frame of the parent at its rest length, whose z runs along the link; metres.
    pub offset: DVec3,
}

/// One link as the figure knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// The number it has in figure files.
    pub number: u32,
    /// Its name, or its number in words where the file has none.
    pub name: String,
    /// How it may be turned.
    pub freedom: Freedom,
    /// Its rest length in metres, above zero.
    pub length: f64,
    /// Its children, in the order given.
    pub attachments: Vec<Attachment>,
    /// The link it starts on; none for the root.
    pub parent: Option<LinkIndex>,
    /// Where on the parent it starts; zero for the root.
    pub offset: DVec3,
}

/// Constant description of a figure. Invariant: one root, first; parents before children.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    links: Vec<Link>,
}

/// How one link stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkPose {
    /// Unit vector along the link, in the world.
    pub direction: DVec3,
    /// Turn about the link's own z before it is tilted, radians, not wrapped: three turns are three turns.
    pub twist_rad: f64,
    /// Its length in metres, above zero.
    pub length: f64,
}

/// How a figure stands, one entry for each link in the figure's order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigurePose {
    /// Where the root link starts, in the world, metres.
    pub root: DVec3,
    /// One for each link.
    pub links: Vec<LinkPose>,
}

impl Figure {
    /// All links in visiting order.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// How many links there are; at least one.
    pub fn len(&self) -> usize {
        self.links.len()
    }

    /// Never: a figure has a root.
    pub fn is_empty(&self) -> bool {
        self.links.is_empty()
    }

    /// One link. `None` for an index of another, larger figure.
    pub fn link(&self, index: LinkIndex) -> Option<&Link> {
        self.links.get(index.index())
    }

    /// The link with that number in its file.
    pub fn by_number(&self, number: u32) -> Option<LinkIndex> {
        self.find(|link| link.number == number)
    }

    /// The first link with that name.
    pub fn by_name(&self, name: &str) -> Option<LinkIndex> {
        self.find(|link| link.name == name)
    }

    fn find(&self, is_it: impl Fn(&Link) -> bool) -> Option<LinkIndex> {
        self.links.iter().position(is_it).map(|i| LinkIndex(i as u16))
    }

    /// All links at rest length along +z, untwisted, the root at the origin.
    pub fn rest_pose(&self) -> FigurePose {
        let stand = |link: &Link| LinkPose {
            direction: DVec3::Z,
            twist_rad: 0.0,
            length: link.length,
        };
        FigurePose {
            root: DVec3::ZERO,
            links: self.links.iter().map(stand).collect(),
        }
    }
}
