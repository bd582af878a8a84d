//! Finding what was drawn near a place on the screen.
//!
//! Source: `docs/protocols/ps300.md`, "Picking and system". That the nearest comes first is ours.

use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::Structure;
use super::walk::{Trace, Traced};
use crate::display::{DisplayList, Stroke, View};
use crate::names::Names;
use crate::pick::{Pick, Spot};

/// Elements reported by one pick. Our choice.
const PICKS_MAX: usize = 16;

/// Where a pick looks, and how much it tells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    /// Middle and half size of the pick window, on the screen of -1 to 1.
    pub(crate) window: [DVec2; 2],
    /// How the host's own camera shows the world on that screen.
    pub(crate) camera: DMat4,
    /// Whether the place on the element is wanted.
    pub(crate) detailed: bool,
}

/// Where a line passes the window.
struct Hit {
    distance: f64,
    /// The nearest point, as a share of the line.
    share: f64,
    trace: usize,
}

/// What was drawn inside the window, nearest to its middle first, each element once.
pub(crate) fn picks(
    structure: &Structure,
    names: &Names,
    list: &DisplayList,
    traced: &Traced,
    aim: &Aim,
) -> Arc<[Pick]> {
    let mut hits: Vec<Hit> = Vec::new();
    for (index, (stroke, trace)) in list.strokes.iter().zip(&traced.traces).enumerate() {
        let source = traced.sources.get(trace.source as usize);
        let Some(source) = source.filter(|source| source.picking) else {
            continue;
        };
        let [center, half] = source.window.unwrap_or(aim.window);
        let view = list.views.get(usize::from(stroke.view));
        if let Some((distance, share)) = passes(stroke, view, &aim.camera, center, half) {
            hits.push(Hit {
                distance,
                share,
                trace: index,
            });
        }
    }
    hits.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.trace.cmp(&b.trace)));
    let mut seen: Vec<(u32, i32)> = Vec::new();
    let mut picks = Vec::new();
    for hit in hits {
        let Some(trace) = traced.traces.get(hit.trace) else {
            continue;
        };
        if picks.len() < PICKS_MAX && !seen.contains(&(trace.source, trace.index)) {
            seen.push((trace.source, trace.index));
            picks.extend(pick(
                structure,
                names,
                traced,
                trace,
                aim.detailed.then_some(hit.share),
            ));
        }
    }
    picks.into()
}

fn pick(
    structure: &Structure,
    names: &Names,
    traced: &Traced,
    trace: &Trace,
    share: Option<f64>,
) -> Option<Pick> {
    let source = traced.sources.get(trace.source as usize)?;
    let [from, to] = trace.ends;
    let [begin, end] = trace.along;
    Some(Pick {
        index: trace.index,
        identifiers: traced.identifiers(source).map(|id| names.spelling(id)).collect(),
        node: structure.slot(source.node)?.name.clone(),
        kind: source.kind,
        dimension: source.dimension.count(),
        spot: share.map(|share| Spot {
            at: from.lerp(to, share),
            along: begin + (end - begin) * share,
        }),
    })
}

/// How near a line comes to the middle of the window, and where; nothing if it stays outside.
fn passes(
    stroke: &Stroke,
    view: Option<&View>,
    camera: &DMat4,
    center: DVec2,
    half: DVec2,
) -> Option<(f64, f64)> {
    let own = view.and_then(|view| view.screen_from_world.as_ref());
    let matrix = own.unwrap_or(camera);
    let [from, to] = [stroke.from, stroke.to].map(|at| *matrix * at.extend(1.0));
    if from.w <= 0.0 || to.w <= 0.0 {
        return None;
    }
    let onto = |at: DVec4| {
        let at = at.truncate() / at.w;
        let at = match view {
            Some(view) if own.is_some() => view.onto_screen(at),
            _ => at,
        };
        DVec3::truncate(at) - center
    };
    let (a, b) = (onto(from), onto(to));
    let [begin, end] = inside(a, b, half)?;
    let along = b - a;
    let nearest = if along == DVec2::ZERO {
        begin
    } else {
        (-a.dot(along) / along.length_squared()).clamp(begin, end)
    };
    // On the screen shares of a line are not those in space: what is far is short.
    let share = nearest * from.w / (nearest * from.w + (1.0 - nearest) * to.w);
    Some((a.lerp(b, nearest).length(), share))
}

/// The part of a line in a window around the origin.
fn inside(a: DVec2, b: DVec2, half: DVec2) -> Option<[f64; 2]> {
    let (mut begin, mut end) = (0.0_f64, 1.0_f64);
    for (from, to, reach) in [(a.x, b.x, half.x), (a.y, b.y, half.y)] {
        for (from, to) in [(reach - from, reach - to), (reach + from, reach + to)] {
            if from < 0.0 && to < 0.0 {
                return None;
            }
            if from < 0.0 {
                begin = begin.max(from / (from - to));
            } else if to < 0.0 {
                end = end.min(from / (from - to));
            }
        }
    }
    (begin <= end).then_some([begin, end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_passes_a_window_or_not() {
        let half = DVec2::splat(0.1);
        let p = |x: f64, y: f64| DVec2::new(x, y);
        assert_eq!(inside(p(-1.0, 0.0), p(1.0, 0.0), half), Some([0.45, 0.55]));
        assert_eq!(inside(p(-1.0, 0.2), p(1.0, 0.2), half), None);
        assert!(inside(p(-1.0, 0.9), p(0.9, -1.0), half).is_some());
        assert_eq!(inside(p(-1.0, 0.5), p(0.5, -1.0), half), None);
        assert_eq!(inside(p(0.05, 0.05), p(0.05, 0.05), half), Some([0.0, 1.0]));
    }
}
