//! From a list of links, as files give it, to a figure: what is refused, what is only warned of.

use super::{Attachment, Figure, Freedom, Link, LinkIndex};
use glam::DVec3;
use std::collections::BTreeMap;
use thiserror::Error;

/// One link as a file describes it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinkSpec {
    /// Its number, unique in the figure.
    pub number: u32,
    /// Its name; may be empty.
    pub name: String,
    /// Degrees of freedom: 2 or 3; 4 is read as 2 with a warning.
    pub dof: u32,
    /// Rest length, metres, above zero.
    pub length: f64,
    /// Numbers of its children, and where each starts in this link's frame.
    pub children: Vec<(u32, DVec3)>,
}

/// Why a list of links is no figure. Numbers are those of the list.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FigureError {
    /// Two links have one number.
    #[error("two links have the number {number}; give each its own")]
    DuplicateNumber {
        /// The number.
        number: u32,
    },
    /// Links have 2 or 3 degrees of freedom.
    #[error("link {link} has {dof} degrees of freedom; a link has 2 (direction) or 3 (direction and twist)")]
    BadFreedom {
        /// The link's number.
        link: u32,
        /// What it says.
        dof: u32,
    },
    /// A length is a finite number above zero.
    #[error("link {link} is {length} long; a length is above zero")]
    BadLength {
        /// The link's number.
        link: u32,
        /// What it says.
        length: f64,
    },
    /// An attachment is not finite.
    #[error("link {link} attaches link {child} at a place that is not finite")]
    NotFinite {
        /// The parent's number.
        link: u32,
        /// The child's number.
        child: u32,
    },
    /// A child is not in the list.
    #[error("link {link} attaches link {child}, which is not in the figure; add it or detach it")]
    MissingChild {
        /// The parent's number.
        link: u32,
        /// The number that is missing.
        child: u32,
    },
    /// A child is attached twice.
    #[error("link {child} is attached to link {first} and again to link {second}; a link has one parent")]
    TwoParents {
        /// The child's number.
        child: u32,
        /// The parent that was read first.
        first: u32,
        /// The second one.
        second: u32,
    },
    /// Not exactly one link without parent that all others hang from.
    #[error(
        "{roots} links have no parent and {unreached} links hang from none of them; exactly one root is needed, and no loops"
    )]
    RootCount {
        /// How many links have no parent.
        roots: usize,
        /// How many links a walk from the roots never meets.
        unreached: usize,
    },
    /// More links than an index can count.
    #[error("{links} links are too many; {} are the most", u16::MAX)]
    TooMany {
        /// How many there are.
        links: usize,
    },
}

/// What was accepted with a correction.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum FigureWarning {
    /// The thesis's own figure file has links with 4 degrees of freedom, which nothing explains.
    #[error("link {link} has 4 degrees of freedom; read as 2")]
    FourFreedoms {
        /// The link's number.
        link: u32,
    },
}

impl Figure {
    /// A figure of these links, visited depth first, children in the order given.
    pub fn new(specs: &[LinkSpec]) -> Result<(Self, Vec<FigureWarning>), FigureError> {
        if specs.len() > usize::from(u16::MAX) {
            return Err(FigureError::TooMany { links: specs.len() });
        }
        let place_of = numbers(specs)?;
        let mut warnings = Vec::new();
        let mut freedoms = Vec::with_capacity(specs.len());
        for spec in specs {
            freedoms.push(freedom(spec, &mut warnings)?);
            check_length(spec)?;
        }
        let parent_of = parents(specs, &place_of)?;
        let order = visiting_order(specs, &place_of, &parent_of)?;
        let mut index_of = vec![LinkIndex::default(); specs.len()];
        for (index, &place) in order.iter().enumerate() {
            index_of[place] = LinkIndex(index as u16);
        }
        let links = order
            .iter()
            .map(|&place| {
                let spec = &specs[place];
                let attachments = spec
                    .children
                    .iter()
                    .map(|&(child, offset)| Attachment {
                        child: index_of[place_of[&child]],
                        offset,
                    })
                    .collect();
                let (parent, offset) = match parent_of[place] {
                    Some((parent, offset)) => (Some(index_of[parent]), offset),
                    None => (None, DVec3::ZERO),
                };
                Link {
                    number: spec.number,
                    name: if spec.name.is_empty() {
                        format!("link {}", spec.number)
                    } else {
                        spec.name.clone()
                    },
                    freedom: freedoms[place],
                    length: spec.length,
                    attachments,
                    parent,
                    offset,
                }
            })
            .collect();
        Ok((Self { links }, warnings))
    }
}

fn numbers(specs: &[LinkSpec]) -> Result<BTreeMap<u32, usize>, FigureError> {
    let mut place_of = BTreeMap::new();
    for (place, spec) in specs.iter().enumerate() {
        if place_of.insert(spec.number, place).is_some() {
            return Err(FigureError::DuplicateNumber { number: spec.number });
        }
    }
    Ok(place_of)
}

fn freedom(spec: &LinkSpec, warnings: &mut Vec<FigureWarning>) -> Result<Freedom, FigureError> {
    match spec.dof {
        2 => Ok(Freedom::Two),
        3 => Ok(Freedom::Three),
        4 => {
            warnings.push(FigureWarning::FourFreedoms { link: spec.number });
            Ok(Freedom::Two)
        }
        dof => Err(FigureError::BadFreedom {
            link: spec.number,
            dof,
        }),
    }
}

fn check_length(spec: &LinkSpec) -> Result<(), FigureError> {
    if spec.length.is_finite() && spec.length > 0.0 {
        Ok(())
    } else {
        Err(FigureError::BadLength {
            link: spec.number,
            length: spec.length,
        })
    }
}

type Parents = Vec<Option<(usize, DVec3)>>;

fn parents(specs: &[LinkSpec], place_of: &BTreeMap<u32, usize>) -> Result<Parents, FigureError> {
    let mut parent_of: Parents = vec![None; specs.len()];
    for (place, spec) in specs.iter().enumerate() {
        for &(child, offset) in &spec.children {
            let Some(&at) = place_of.get(&child) else {
                return Err(FigureError::MissingChild {
                    link: spec.number,
                    child,
                });
            };
            if !offset.is_finite() {
                return Err(FigureError::NotFinite {
                    link: spec.number,
                    child,
                });
            }
            if let Some((first, _)) = parent_of[at] {
                let (first, second) = (specs[first].number, spec.number);
                return Err(FigureError::TwoParents { child, first, second });
            }
            parent_of[at] = Some((place, offset));
        }
    }
    Ok(parent_of)
}

/// Depth first from the only root; a loop is a set of links that no root leads to.
fn visiting_order(
    specs: &[LinkSpec],
    place_of: &BTreeMap<u32, usize>,
    parent_of: &Parents,
) -> Result<Vec<usize>, FigureError> {
    let roots: Vec<usize> = (0..specs.len()).filter(|&i| parent_of[i].is_none()).collect();
    let mut order = Vec::with_capacity(specs.len());
    let mut ahead = roots.clone();
    while let Some(place) = ahead.pop() {
        order.push(place);
        ahead.extend(
            specs[place]
                .children
                .iter()
                .rev()
                .map(|(child, _)| place_of[child]),
        );
    }
    let unreached = specs.len() - order.len();
    if roots.len() == 1 && unreached == 0 {
        Ok(order)
    } else {
        Err(FigureError::RootCount {
            roots: roots.len(),
            unreached,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link(number: u32, children: &[u32]) -> LinkSpec {
        let children = children.iter().map(|&child| (child, DVec3::Z)).collect();
        LinkSpec {
            number,
            dof: 2,
            length: 1.0,
            children,
            ..LinkSpec::default()
        }
    }

    #[test]
    fn what_is_no_figure() {
        let cases = [
            (
                vec![],
                FigureError::RootCount {
                    roots: 0,
                    unreached: 0,
                },
            ),
            (
                vec![link(1, &[]), link(1, &[])],
                FigureError::DuplicateNumber { number: 1 },
            ),
            (
                vec![link(1, &[2])],
                FigureError::MissingChild { link: 1, child: 2 },
            ),
            (
                vec![link(0, &[1, 2]), link(1, &[2]), link(2, &[])],
                FigureError::TwoParents {
                    child: 2,
                    first: 0,
                    second: 1,
                },
            ),
            (
                vec![link(1, &[1])],
                FigureError::RootCount {
                    roots: 0,
                    unreached: 1,
                },
            ),
            (
                vec![LinkSpec {
                    dof: 1,
                    ..link(3, &[])
                }],
                FigureError::BadFreedom { link: 3, dof: 1 },
            ),
            (
                vec![LinkSpec {
                    length: 0.0,
                    ..link(3, &[])
                }],
                FigureError::BadLength { link: 3, length: 0.0 },
            ),
        ];
        for (specs, want) in cases {
            assert_eq!(Figure::new(&specs).err(), Some(want), "{specs:?}");
        }
    }

    #[test]
    fn parents_come_first_whatever_the_list_says() {
        let specs = [link(3, &[]), link(2, &[3]), link(9, &[2, 5]), link(5, &[])];
        let (figure, warnings) = Figure::new(&specs).expect("valid");
        assert_eq!(
            figure.links().iter().map(|l| l.number).collect::<Vec<_>>(),
            [9, 2, 3, 5]
        );
        assert!(warnings.is_empty());
        assert_eq!(figure.links()[3].parent, Some(LinkIndex(0)));
    }

    #[test]
    fn four_freedoms_are_two_and_said_so() {
        let (figure, warnings) = Figure::new(&[LinkSpec {
            dof: 4,
            ..link(7, &[])
        }])
        .expect("valid");
        assert_eq!(figure.links()[0].freedom, Freedom::Two);
        assert_eq!(warnings, [FigureWarning::FourFreedoms { link: 7 }]);
    }
}
