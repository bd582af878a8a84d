//! The show: what is kept on disk, how it is read and written, and how it changes.
//!
//! *Knows* the file formats (`docs/formats.md`): show folders, the thesis's structure files, BVH, CSV, URDF.
//! *Must not know* devices, windows, or what time it is.
//! *Start reading* at [`Show`], then [`folder`] (a folder becomes a show) and [`save`](mod@save) (and back).

pub mod bvh;
pub mod check;
mod clip;
mod clip_file;
pub mod convert;
pub mod csv;
mod demands;
pub mod disk;
pub mod edit;
pub mod fault;
mod fields;
mod figure;
pub mod folder;
mod frames;
pub mod limits;
mod program;
pub mod save;
mod show;
mod show_file;
pub mod source;
pub mod structure;
pub mod urdf;
mod zyz;

pub use clip::{ClipDoc, JointClipDoc, JointClipDocError, Keyed};
pub use demands::{DemandError, Demands, JointDemand};
pub use edit::{EditError, Edited, apply};
pub use fault::{FileError, FileErrors, Findings};
pub use figure::{FigureDoc, FigureTexts};
pub use folder::{Loaded, load};
pub use frames::ExportError;
pub use save::{autosave, can_be_saved, from_texts, save, texts};
pub use show::{NetworkFile, Show, is_file_name};
