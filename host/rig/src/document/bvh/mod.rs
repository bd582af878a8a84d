//! BVH motion capture: reading it into a show and writing any show out as BVH.
//!
//! A BVH joint turns its children; a figure's link does not. The two describe the same motion all the
//! same, because a link's direction and twist are its orientation in the world: reading multiplies the
//! rotations down the tree once per frame, writing divides by the parent's.

mod euler;
mod export;
mod import;
mod positions;
mod read;
mod skeleton;

pub use export::{Exported, export, skeleton_text};
pub use import::{Imported, figure_of, import};
pub use read::{BvhFile, read};
pub use skeleton::{Channel, PositionStyle, Skeleton, SkeletonJoint, joint_from_link};

use super::fault::FileError;
