//! How faces look, and in what light.

use glam::DVec3;

/// `ATTRIBUTES [COLOR h[,s[,i]]] [OPAQUE t] [DIFFUSE d] [SPECULAR n] [AND …]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Attributes {
    /// Of the front, and of the back where nothing is said of that.
    pub front: Surface,
    /// After `AND`: of the back.
    pub back: Option<Surface>,
}

/// One side of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surface {
    /// `COLOR`.
    pub color: Option<SurfaceColor>,
    /// `OPAQUE`: 0 lets all light through, 1 none.
    pub opaque: Option<f64>,
    /// `DIFFUSE`: how much light is scattered, 0 to 1.
    pub diffuse: Option<f64>,
    /// `SPECULAR`: how sharp highlights are, from 0; an exponent.
    pub specular: Option<f64>,
}

/// `COLOR h[,s[,i]]`; s and i are 1 unless written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceColor {
    /// 0 to 360; 0 blue, 120 red, 240 green.
    pub hue_deg: f64,
    /// 0 white to 1 full.
    pub saturation: f64,
    /// 0 to 1.
    pub intensity: f64,
}

/// `ILLUMINATION x,y,z [COLOR h[,s[,i]]] [AMBIENT a]`: light from one direction, turned by the operations above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    /// From the scene towards the light, of any length.
    pub direction: DVec3,
    /// White unless written.
    pub color: Option<SurfaceColor>,
    /// `AMBIENT`: how much of it is everywhere, 0 to 1.
    pub ambient: Option<f64>,
}
