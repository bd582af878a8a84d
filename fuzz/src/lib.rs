//! What several fuzz targets share: how bytes become things that are done, and the laws that must hold.

pub mod hid;
pub mod line;
