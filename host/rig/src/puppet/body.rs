//! A puppet profile as a body that can follow a figure: its chain of joints, and which link leads which group.
//!
//! The profile's groups are named after the links of the figure it was laid out for. A figure with other names
//! (motion capture) is followed through the profile's synonyms; its link axes are turned to the profile's, which
//! are known from the figure's own rest pose.

use std::sync::Arc;

use device_profiles::{ProfileError, Profiles, PuppetGroup, PuppetProfile};
use glam::{DMat3, DQuat, DVec3};
use motion::retarget::Group;
use motion::{
    Chain, ChainError, Clip, Figure, FigureError, Interval, Joint, JointClip, JointClipError, JointIndex,
    JointKind, LinkIndex, LinkSpec, Placed, Retarget, RetargetError, RetargetReport, Rigid,
};

use crate::document::Show;

/// Why a puppet cannot follow a figure.
#[derive(Debug, thiserror::Error)]
pub enum BodyError {
    /// Nobody to follow.
    #[error("this show has no figure that a puppet could follow")]
    NoFigure,
    /// Nobody to follow it.
    #[error("this show names no puppet; name one in show.toml")]
    NoPuppet,
    /// No such puppet; the message lists what there is.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The figure lacks a link the puppet needs.
    #[error("puppet {puppet} follows link {link}, which the figure does not have; its links are {known}")]
    NoSuchLink {
        /// The puppet.
        puppet: String,
        /// The link, with the synonyms tried.
        link: String,
        /// The figure's links.
        known: String,
    },
    /// The profile's joints make no chain.
    #[error("puppet {puppet}: {source}")]
    Chain {
        /// The puppet.
        puppet: String,
        /// Why.
        source: ChainError,
    },
    /// The profile's groups make no tree.
    #[error("puppet {puppet}: {source}")]
    Tree {
        /// The puppet.
        puppet: String,
        /// Why.
        source: FigureError,
    },
    /// The profile's groups cannot follow.
    #[error("puppet {puppet}: {source}")]
    Retarget {
        /// The puppet.
        puppet: String,
        /// Why.
        source: RetargetError,
    },
}

/// A puppet that follows a figure.
#[derive(Clone, Debug)]
pub struct Body {
    joints: Vec<String>,
    retarget: Retarget,
    /// For each group, the figure's link and the turn from the profile's link axes to the figure's.
    leaders: Vec<(LinkIndex, DMat3)>,
}

/// How link axes lie at rest in a figure, one matrix a link (`world_from_link` when everybody stands upright);
/// `None` for a figure whose axes are the profile's own.
pub type RestFrames<'a> = Option<&'a [DMat3]>;

impl Body {
    /// Lets `profile` follow `figure`.
    pub fn new(profile: &PuppetProfile, figure: &Figure, rest: RestFrames<'_>) -> Result<Self, BodyError> {
        let puppet = || profile.name.clone();
        let (tree, _) = Figure::new(&tree_of(profile)).map_err(|source| BodyError::Tree {
            puppet: puppet(),
            source,
        })?;
        let leaders = tree
            .links()
            .iter()
            .filter_map(|link| profile.groups.get(link.number as usize))
            .map(|group| match leader(profile, group, figure, rest) {
                // A rigid part carries no joint that could follow.
                Err(_) if group.joints.is_empty() && group.parent.is_some() => {
                    Ok((LinkIndex(0), DMat3::IDENTITY))
                }
                led => led,
            })
            .collect::<Result<_, _>>()?;
        let (chain, groups) = chain_of(profile, &tree).map_err(|source| BodyError::Chain {
            puppet: puppet(),
            source,
        })?;
        // The first group is the root, and parents come first in a figure.
        let root = profile
            .groups
            .first()
            .map(|group| (LinkIndex(0), rotation(group.tool_rpy_rad)));
        let retarget = Retarget::new(Arc::new(tree), Arc::new(chain), root, &groups).map_err(|source| {
            BodyError::Retarget {
                puppet: puppet(),
                source,
            }
        })?;
        Ok(Self {
            joints: profile.joints().map(|j| j.name.clone()).collect(),
            retarget,
            leaders,
        })
    }

    /// Lets the puppet a show names, or another one, follow the show's figure.
    pub fn of_show(show: &Show, puppet: Option<&str>, profiles: &Profiles) -> Result<Self, BodyError> {
        let figure = show.figure.as_ref().ok_or(BodyError::NoFigure)?;
        let name = puppet.or(show.puppet.as_deref()).ok_or(BodyError::NoPuppet)?;
        Self::new(
            profiles.puppet(name)?,
            &figure.figure,
            figure.rest_frames().as_deref(),
        )
    }

    /// Joint names, in the order of all rows of angles.
    pub fn joints(&self) -> &[String] {
        &self.joints
    }

    /// The figure's placed links as the puppet's groups see them.
    fn led(&self, placed: &[Placed], led: &mut Vec<Placed>) {
        led.clear();
        led.extend(self.leaders.iter().filter_map(|(link, turn)| {
            let link = placed.get(link.index())?;
            Some(Placed {
                world_from_link: link.world_from_link * *turn,
                ..*link
            })
        }));
    }

    /// Bakes a clip: angles of all joints every `period_secs`. Returns also the largest angle between a link
    /// and what the joints could do about it, radians.
    pub fn bake(&self, clip: &Clip, period_secs: f64) -> Result<(JointClip, f64), JointClipError> {
        let rows = (clip.duration_secs() / period_secs - 1e-9).ceil().max(0.0) as usize + 1;
        let mut samples = Vec::with_capacity(rows * self.joints.len());
        let mut follower = Follower::new(self);
        let mut placed = Vec::new();
        let mut error_rad: f64 = 0.0;
        for row in 0..rows {
            clip.place(clip.start_secs() + row as f64 * period_secs, &mut placed);
            samples.extend_from_slice(follower.follow(&placed));
            error_rad = error_rad.max(follower.report.direction_error_rad());
        }
        Ok((
            JointClip::new(self.joints.clone(), period_secs, samples)?,
            error_rad,
        ))
    }
}

/// Follows a figure pose by pose, each answer near the one before.
#[derive(Debug)]
pub struct Follower {
    body: Body,
    angles_rad: Vec<f64>,
    begun: bool,
    led: Vec<Placed>,
    report: RetargetReport,
}

impl Follower {
    /// Begins at the rest angles.
    pub fn new(body: &Body) -> Self {
        Self {
            angles_rad: body.retarget.chain().rest_angles(),
            body: body.clone(),
            begun: false,
            led: Vec::new(),
            report: RetargetReport::default(),
        }
    }

    /// Joint angles for a placed figure, radians, in the body's order.
    pub fn follow(&mut self, placed: &[Placed]) -> &[f64] {
        self.body.led(placed, &mut self.led);
        if self.begun {
            self.body
                .retarget
                .follow(&self.led, &mut self.angles_rad, &mut self.report);
        } else {
            self.body
                .retarget
                .begin(&self.led, &mut self.angles_rad, &mut self.report);
            self.begun = true;
        }
        &self.angles_rad
    }
}

/// The figure's link that leads a group.
fn leader(
    profile: &PuppetProfile,
    group: &PuppetGroup,
    figure: &Figure,
    rest: RestFrames<'_>,
) -> Result<(LinkIndex, DMat3), BodyError> {
    let names = || std::iter::once(&group.link).chain(&group.also);
    let Some(link) = names().find_map(|name| figure.by_name(name)) else {
        let known: Vec<_> = figure.links().iter().map(|l| l.name.as_str()).collect();
        return Err(BodyError::NoSuchLink {
            puppet: profile.name.clone(),
            link: names().cloned().collect::<Vec<_>>().join(" or "),
            known: known.join(", "),
        });
    };
    // A direction alone (two joints) needs the bone's own axis, whatever the rest pose was.
    let whole = group.parent.is_none() || group.joints.len() == 3;
    let turn = match rest.and_then(|frames| frames.get(link.index())) {
        Some(world_from_link) if whole => world_from_link.transpose() * upright(),
        _ => DMat3::IDENTITY,
    };
    Ok((link, turn))
}

/// The profile's link axes when everybody stands upright and looks at the viewer: z down along the link, x to
/// the body's own right, y to its back; world axes are x right, y up, z towards the viewer.
pub(super) fn upright() -> DMat3 {
    DMat3::from_cols(DVec3::NEG_X, DVec3::NEG_Z, DVec3::NEG_Y)
}

/// The groups as a tree of links, so that they can be followed as a figure is.
pub(super) fn tree_of(profile: &PuppetProfile) -> Vec<LinkSpec> {
    let place = |link: &str| profile.groups.iter().position(|g| g.link == link);
    let mut specs: Vec<LinkSpec> = profile
        .groups
        .iter()
        .enumerate()
        .map(|(number, group)| LinkSpec {
            number: number as u32,
            name: group.link.clone(),
            dof: if group.parent.is_none() || group.joints.len() == 3 {
                3
            } else {
                2
            },
            length: group.length_m,
            children: Vec::new(),
        })
        .collect();
    for (number, group) in profile.groups.iter().enumerate() {
        if let Some(parent) = group.parent.as_deref().and_then(place) {
            let at = group
                .joints
                .first()
                .map_or(DVec3::ZERO, |j| DVec3::from_array(j.origin_xyz_m));
            specs[parent].children.push((number as u32, at));
        }
    }
    specs
}

/// The joints as a chain, and the groups that follow links.
pub(super) fn chain_of(profile: &PuppetProfile, tree: &Figure) -> Result<(Chain, Vec<Group>), ChainError> {
    let mut joints: Vec<Joint> = Vec::new();
    let mut groups = Vec::new();
    // The last joint of each group; a group without joints passes its parent's on.
    let mut last: Vec<Option<JointIndex>> = Vec::new();
    for (number, group) in profile.groups.iter().enumerate() {
        let parent = group
            .parent
            .as_deref()
            .and_then(|p| profile.groups.iter().position(|g| g.link == p));
        let mut hangs_from = parent.and_then(|p| last.get(p).copied().flatten());
        let mut own = Vec::new();
        for joint in &group.joints {
            own.push(JointIndex(joints.len() as u16));
            joints.push(Joint {
                name: joint.name.clone(),
                parent: hangs_from,
                parent_from_joint: Rigid::from_xyz_rpy(
                    DVec3::from_array(joint.origin_xyz_m),
                    DVec3::from_array(joint.origin_rpy_rad),
                ),
                kind: JointKind::Revolute {
                    axis: DVec3::from_array(joint.axis),
                },
                range_rad: Interval {
                    start: joint.min_rad,
                    end: joint.max_rad,
                },
                speed_max_rad_per_s: joint.speed_max_rad_per_s,
            });
            hangs_from = own.last().copied();
        }
        last.push(hangs_from);
        if let (false, Some(link)) = (own.is_empty(), tree.by_number(number as u32)) {
            groups.push(Group {
                link,
                joints: own,
                joint_from_link: rotation(group.tool_rpy_rad),
            });
        }
    }
    Chain::new(joints).map(|chain| (chain, groups))
}

fn rotation(rpy_rad: [f64; 3]) -> DQuat {
    Rigid::from_xyz_rpy(DVec3::ZERO, DVec3::from_array(rpy_rad)).rotation
}
