//! Names of links in a file become places in a figure.

use std::collections::BTreeMap;
use std::sync::Arc;

use motion::{Figure, FigureKey, FigurePose, LinkPose};

use super::KeyText;
use crate::document::fault::Findings;
use crate::document::source::Source;

/// Looks link names up and puts poses in the figure's order.
pub(super) fn bind(
    source: &Source,
    keys: &[KeyText<'_>],
    figure: &Figure,
    found: &mut Findings,
) -> Vec<Arc<FigureKey>> {
    let places: BTreeMap<&str, usize> = figure
        .links()
        .iter()
        .enumerate()
        .map(|(place, link)| (link.name.as_str(), place))
        .collect();
    let key = |key: &KeyText<'_>| {
        let mut links: Vec<Option<LinkPose>> = vec![None; places.len()];
        for link in &key.links {
            let Some(&place) = places.get(link.name) else {
                let error = source.error(link.at, format!("the figure has no link `{}`", link.name));
                let known: Vec<&str> = figure
                    .links()
                    .iter()
                    .take(40)
                    .map(|link| link.name.as_str())
                    .collect();
                found.error(error.with_hint(format!("it has {}", known.join(", "))));
                continue;
            };
            let length = link.length.unwrap_or(figure.links()[place].length);
            links[place] = Some(LinkPose {
                direction: link.direction,
                twist_rad: link.twist_rad,
                length,
            });
        }
        for (link, pose) in figure.links().iter().zip(&links) {
            if pose.is_none() {
                found.error(source.error(key.at, format!("this key does not place link `{}`", link.name)));
            }
        }
        let links = links.into_iter().collect::<Option<Vec<LinkPose>>>()?;
        Some(Arc::new(FigureKey {
            secs: key.secs,
            pose: FigurePose {
                root: key.root,
                links,
            },
        }))
    };
    keys.iter().filter_map(key).collect()
}
