//! Filled surfaces: which of them is nearest at every point of a picture, and in what colour.
//!
//! Worked out on the processor for both renderers, so that what hides what, and how it shines, is the same in
//! films, pictures and the window. Surfaces are filled at four places a pixel, which smooths their borders.
//! Source: E. Catmull's depth buffer, 1974; scan lines of polygons as in any textbook.

use glam::DVec3;
use ps300::display::{Fill, Light, Material, shade};

use super::camera::Camera;
use super::flat::Viewport;
use super::scene::Surface;
use super::theme::{self, Rgb};

/// Places filled along each side of a pixel.
const GRAIN: usize = 2;
/// More places than this, as for a poster, are not worth four a pixel.
const FINE_MAX: usize = 24_000_000;
/// A line this much nearer than a surface, as a share of all depth there is, lies on it.
const ON_SURFACE: f32 = 2e-3;

/// A picture of all surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// Left edge in the whole picture, pixels.
    pub x: u32,
    /// Upper edge.
    pub y: u32,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Red, green, blue and how much of the pixel is covered, row by row.
    pub rgba: Vec<u8>,
}

/// The depths of all surfaces, for lines to be hidden by.
pub(super) struct Depths {
    left: f64,
    top: f64,
    width: usize,
    height: usize,
    /// Places along a side of a pixel.
    grain: usize,
    /// Depths between these are between 0 and 1 here.
    farthest: f64,
    span: f64,
    /// Nearer is more; below 0 nothing is.
    depth: Vec<f32>,
    colour: Vec<[f32; 3]>,
    covered: Vec<f32>,
}

/// A corner on the screen.
#[derive(Clone, Copy)]
struct Point {
    x: f64,
    y: f64,
    depth: f64,
    normal: DVec3,
    begins: bool,
}

/// A surface on the screen.
struct Cast<'a> {
    surface: &'a Surface,
    points: Vec<Point>,
    material: Material,
    /// 1, or −1 where normals are to be turned round.
    turned: f64,
    viewer: DVec3,
}

/// The depths of all surfaces, and which of them are seen from a side they have.
pub(super) fn cast(surfaces: &[Surface], camera: &Camera, port: &Viewport) -> (Depths, Vec<bool>) {
    let mut casts: Vec<_> = surfaces
        .iter()
        .map(|surface| on_screen(surface, camera, port))
        .collect();
    let shown: Vec<bool> = casts.iter().map(Option::is_some).collect();
    casts.retain(|cast| cast.as_ref().is_some_and(|cast| cast.surface.fill != Fill::Empty));
    let mut depths = Depths::around(&casts.iter().flatten().flat_map(|cast| &cast.points), port);
    let (clear, solid): (Vec<_>, Vec<_>) = casts
        .into_iter()
        .flatten()
        .partition(|cast| cast.surface.fill != Fill::Hides && cast.material.opaque < 1.0);
    for cast in &solid {
        depths.fill(cast);
    }
    let mut clear = clear;
    let middle =
        |cast: &Cast<'_>| cast.points.iter().map(|p| p.depth).sum::<f64>() / cast.points.len().max(1) as f64;
    clear.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
    for cast in &clear {
        depths.fill(cast);
    }
    (depths, shown)
}

fn on_screen<'a>(surface: &'a Surface, camera: &Camera, port: &Viewport) -> Option<Cast<'a>> {
    let points: Vec<Point> = surface
        .corners
        .iter()
        .map(|corner| {
            let ([x, y], depth) = port.pixel(camera, corner.at);
            Point {
                x: f64::from(x),
                y: f64::from(y),
                depth,
                normal: corner.normal,
                begins: corner.begins,
            }
        })
        .collect();
    let first = points
        .iter()
        .skip(1)
        .position(|p| p.begins)
        .map_or(points.len(), |at| at + 1);
    let border = &points[..first];
    let next = border.iter().cycle().skip(1);
    let twice_area: f64 = border.iter().zip(next).map(|(a, b)| a.x * b.y - b.x * a.y).sum();
    // Rows grow downwards, so that clockwise is positive.
    let front = twice_area >= 0.0;
    if surface.one_sided && !front {
        return None;
    }
    let viewer = surface.viewer.unwrap_or(camera.view_from_world.row(2));
    Some(Cast {
        surface,
        points,
        material: surface.materials[usize::from(!front)],
        turned: if surface.normal.dot(viewer) < 0.0 {
            -1.0
        } else {
            1.0
        },
        viewer,
    })
}

impl Depths {
    fn around<'a>(points: &(impl Iterator<Item = &'a Point> + Clone), port: &Viewport) -> Self {
        let bounds = |of: fn(&Point) -> f64| {
            let least = points.clone().map(of).fold(f64::INFINITY, f64::min);
            let most = points.clone().map(of).fold(f64::NEG_INFINITY, f64::max);
            [least, most]
        };
        let within = |[least, most]: [f64; 2], from: f32, size: f32| {
            let (from, to) = (f64::from(from), f64::from(from) + f64::from(size));
            let (least, most) = (least.clamp(from, to).floor(), most.clamp(from, to).ceil());
            (least, (most - least).max(0.0) as usize)
        };
        let (left, width) = within(bounds(|p| p.x), port.x, port.width);
        let (top, height) = within(bounds(|p| p.y), port.y, port.height);
        let [farthest, nearest] = bounds(|p| p.depth);
        let grain = if width * height * GRAIN * GRAIN > FINE_MAX {
            1
        } else {
            GRAIN
        };
        let places = width * height * grain * grain;
        Self {
            left,
            top,
            width: width * grain,
            height: height * grain,
            grain,
            farthest,
            span: (nearest - farthest).max(1e-9),
            depth: vec![-1.0; places],
            colour: vec![[0.0; 3]; places],
            covered: vec![0.0; places],
        }
    }

    fn fill(&mut self, cast: &Cast<'_>) {
        let grain = self.grain as f64;
        let even = evenly(cast);
        let mut crossings: Vec<(f64, f64, DVec3)> = Vec::new();
        let [top, bottom] = cast.points.iter().fold([f64::MAX, f64::MIN], |[top, bottom], p| {
            [top.min(p.y), bottom.max(p.y)]
        });
        let row = |y: f64| {
            ((y - self.top) * grain - 0.5)
                .ceil()
                .clamp(0.0, self.height as f64) as usize
        };
        for row in row(top)..row(bottom) {
            let y = self.top + (row as f64 + 0.5) / grain;
            cross(&cast.points, y, &mut crossings);
            for pair in crossings.chunks_exact(2) {
                self.span(cast, even, row, [pair[0], pair[1]]);
            }
        }
    }

    /// Fills the places of a row between two crossings.
    fn span(&mut self, cast: &Cast<'_>, even: Option<DVec3>, row: usize, ends: [(f64, f64, DVec3); 2]) {
        let [(from, from_depth, from_normal), (to, to_depth, to_normal)] = ends;
        let grain = self.grain as f64;
        let column = |x: f64| {
            ((x - self.left) * grain - 0.5)
                .ceil()
                .clamp(0.0, self.width as f64) as usize
        };
        let length = (to - from).max(1e-9);
        let opaque = match cast.surface.fill {
            Fill::Hides => 1.0,
            _ => cast.material.opaque as f32,
        };
        let mut shaded: Option<(usize, DVec3)> = None;
        for column in column(from)..column(to) {
            let share = (self.left + (column as f64 + 0.5) / grain - from) / length;
            let depth = from_depth + (to_depth - from_depth) * share;
            let scaled = ((depth - self.farthest) / self.span) as f32;
            let place = row * self.width + column;
            if scaled < self.depth[place] {
                continue;
            }
            // One light for the places of a pixel that lie side by side.
            let pixel = column / self.grain;
            let colour = match (even, shaded) {
                (Some(colour), _) => colour,
                (None, Some((known, colour))) if known == pixel => colour,
                _ => lit(cast, from_normal.lerp(to_normal, share)),
            };
            shaded = Some((pixel, colour));
            let [far, near] = cast.surface.cue.map(f64::from);
            let cue = far + (near - far) * f64::midpoint(depth.clamp(-1.0, 1.0), 1.0);
            let mixed = ground().lerp(colour, cue.clamp(0.0, 1.0)).as_vec3().to_array();
            if opaque >= 1.0 {
                self.depth[place] = scaled;
            }
            self.lay(place, mixed, opaque);
        }
    }

    fn lay(&mut self, place: usize, colour: [f32; 3], opaque: f32) {
        let under = self.covered[place] * (1.0 - opaque);
        let sum = under + opaque;
        for (below, above) in self.colour[place].iter_mut().zip(colour) {
            *below = if sum > 0.0 {
                (*below * under + above * opaque) / sum
            } else {
                0.0
            };
        }
        self.covered[place] = sum;
    }

    /// How much nearer than all surfaces around a place a depth must be to be seen; nothing is where they are not.
    pub(super) fn shows(&self, at: [f64; 2], depth: f64) -> bool {
        let grain = self.grain as f64;
        let column = ((at[0] - self.left) * grain).floor();
        let row = ((at[1] - self.top) * grain).floor();
        let scaled = ((depth - self.farthest) / self.span) as f32 + ON_SURFACE;
        // Where a surface is seen on edge its neighbours say whether a line along it is in front.
        for (down, right) in [(0, 0), (0, 1), (1, 0), (0, -1), (-1, 0)] {
            let (x, y) = (column + f64::from(right), row + f64::from(down));
            let inside = x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64;
            let nearest = if inside {
                self.depth[y as usize * self.width + x as usize]
            } else {
                -1.0
            };
            if scaled >= nearest {
                return true;
            }
        }
        false
    }

    /// The picture of what was filled.
    pub(super) fn plate(&self) -> Option<Plate> {
        let (width, height) = (self.width / self.grain, self.height / self.grain);
        if width == 0 || height == 0 {
            return None;
        }
        let mut rgba = Vec::with_capacity(width * height * 4);
        for y in 0..height {
            for x in 0..width {
                let (mut colour, mut covered) = ([0.0; 3], 0.0);
                for place in 0..self.grain * self.grain {
                    let (down, right) = (place / self.grain, place % self.grain);
                    let at = (y * self.grain + down) * self.width + x * self.grain + right;
                    covered += self.covered[at];
                    for (sum, part) in colour.iter_mut().zip(self.colour[at]) {
                        *sum += part * self.covered[at];
                    }
                }
                let byte = |share: f32| (share * 255.0).round() as u8;
                let least = f32::max(covered, 1e-6);
                rgba.extend(colour.map(|sum| byte(sum / least)));
                rgba.push(byte(covered / (self.grain * self.grain) as f32));
            }
        }
        Some(Plate {
            x: self.left as u32,
            y: self.top as u32,
            width: width as u32,
            height: height as u32,
            rgba,
        })
    }
}

/// The colour of a surface that is the same all over.
fn evenly(cast: &Cast<'_>) -> Option<DVec3> {
    match cast.surface.fill {
        Fill::Empty | Fill::Hides => Some(ground()),
        Fill::Wash => Some(cast.material.colour),
        Fill::Flat => Some(lit(cast, cast.surface.normal)),
        Fill::Smooth => None,
    }
}

fn lit(cast: &Cast<'_>, normal: DVec3) -> DVec3 {
    let normal = (normal * cast.turned).try_normalize().unwrap_or(cast.viewer);
    let lights: &[Light] = &cast.surface.lights;
    shade(&cast.material, lights, normal, cast.viewer)
}

fn ground() -> DVec3 {
    let Rgb(r, g, b) = theme::GROUND;
    DVec3::new(f64::from(r), f64::from(g), f64::from(b)) / 255.0
}

/// Where borders cross a row, from left to right.
fn cross(points: &[Point], y: f64, crossings: &mut Vec<(f64, f64, DVec3)>) {
    crossings.clear();
    let mut begin = 0;
    for (index, a) in points.iter().enumerate() {
        if a.begins {
            begin = index;
        }
        let last = points.get(index + 1).is_none_or(|next| next.begins);
        let b = if last { &points[begin] } else { &points[index + 1] };
        if (a.y <= y) != (b.y <= y) {
            let share = (y - a.y) / (b.y - a.y);
            crossings.push((
                a.x + (b.x - a.x) * share,
                a.depth + (b.depth - a.depth) * share,
                a.normal.lerp(b.normal, share),
            ));
        }
    }
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
}
