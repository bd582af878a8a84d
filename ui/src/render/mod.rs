//! Pictures of the rig, with or without a window.
//!
//! [`stage`] makes a [`scene`] of a snapshot; [`flat`] projects it; [`raster`] paints it on the processor,
//! [`lines`] on a graphics card. [`frame`], [`story`] and [`sheet`] compose pictures, [`film`] writes them. Nothing
//! here knows egui.

pub mod camera;
pub mod depth;
pub mod figure;
pub mod film;
pub mod flat;
pub mod frame;
pub mod lines;
pub mod offscreen;
pub mod palette;
pub mod picture;
mod plates;
pub mod puppet;
pub mod raster;
pub mod scene;
pub mod sheet;
pub mod stage;
pub mod story;
pub mod structures;
pub mod text;
pub mod theme;
pub mod timeline;
pub mod trail;
