//! A puppet profile as a body that can follow a figure: its chain of joints, and which link leads which group.
//!
//! The profile's groups are named after the links of the figure it was laid out for. A figure with other names
//! (motion capture) is followed through the profile's synonyms; its link axes are turned to the profile's, which
//! are known from the figure's own rest pose. A robot whose groups are its own links follows where synonyms name
//! links of the figure: such a group takes the joints before it along, up to three, and the others rest.

mod inverse;

use std::sync::Arc;

use device_profiles::{ProfileError, Profiles, PuppetGroup, PuppetProfile};
use glam::{DMat3, DQuat, DVec3};
use motion::retarget::{GROUP_JOINTS_MAX, Group};
use motion::{
    ChainError, Figure, FigureError, JointIndex, LinkIndex, LinkSpec, Placed, Retarget, RetargetError,
    RetargetReport,
};

use super::model::{Model, tool, upright};
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
    model: Arc<Model>,
    retarget: Retarget,
    /// For each link of the followed tree, the figure's link and the turn from the profile's axes to the figure's.
    leaders: Vec<(LinkIndex, DMat3)>,
    followers: Vec<Following>,
    /// How the root's link lies in the base's frame.
    base_from_root: DQuat,
}

/// Joints that follow one link.
#[derive(Clone, Debug)]
struct Following {
    /// In the followed tree.
    link: LinkIndex,
    joints: Vec<JointIndex>,
    /// How the link lies in the frame of the last of them.
    joint_from_link: DQuat,
}

/// How link axes lie at rest in a figure, one matrix a link (`world_from_link` when everybody stands upright);
/// `None` for a figure whose axes are the profile's own.
pub type RestFrames<'a> = Option<&'a [DMat3]>;

impl Body {
    /// Lets `profile` follow `figure`.
    pub fn new(profile: &PuppetProfile, figure: &Figure, rest: RestFrames<'_>) -> Result<Self, BodyError> {
        let puppet = || profile.name.clone();
        let model = Model::new(profile).map_err(|source| BodyError::Chain {
            puppet: puppet(),
            source,
        })?;
        let joints = joints_of(profile, figure, &model)?;
        let (tree, _) = Figure::new(&tree_of(profile, &joints)).map_err(|source| BodyError::Tree {
            puppet: puppet(),
            source,
        })?;
        let leaders = tree.links().iter().map(|link| {
            let at = link.number as usize;
            let (group, joints) = (profile.groups.get(at), joints.get(at).map_or(0, Vec::len));
            group
                .and_then(|group| leader(group, joints, figure, rest))
                .unwrap_or((LinkIndex(0), DMat3::IDENTITY))
        });
        let leaders = leaders.collect();
        let followers: Vec<Following> = (0..)
            .zip(joints)
            .filter(|(_, joints)| !joints.is_empty())
            .filter_map(|(number, joints)| {
                let link = tree.by_number(number)?;
                Some(Following {
                    link,
                    joints,
                    joint_from_link: turn_of(profile, &tree, link),
                })
            })
            .collect();
        let groups: Vec<Group> = followers
            .iter()
            .map(|following| Group {
                link: following.link,
                joints: following.joints.clone(),
                joint_from_link: following.joint_from_link,
            })
            .collect();
        // The first group is the root, and parents come first in a figure.
        let root = profile
            .groups
            .first()
            .map(|group| (LinkIndex(0), tool(group).rotation));
        let base_from_root = root.map_or(DQuat::IDENTITY, |(_, turn)| turn);
        let retarget = Retarget::new(Arc::new(tree), Arc::clone(&model.chain), root, &groups);
        let retarget = retarget.map_err(|source| BodyError::Retarget {
            puppet: puppet(),
            source,
        })?;
        Ok(Self {
            model: Arc::new(model),
            retarget,
            leaders,
            followers,
            base_from_root,
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
        &self.model.joints
    }

    /// The figure's link that a joint follows, if it follows one.
    pub(crate) fn leading_link(&self, joint: usize) -> Option<LinkIndex> {
        let follows = |f: &&Following| f.joints.iter().any(|own| own.index() == joint);
        let following = self.followers.iter().find(follows)?;
        self.leaders.get(following.link.index()).map(|(link, _)| *link)
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
}

/// Follows a figure pose by pose, each answer near the one before.
#[derive(Clone, Debug)]
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
        let mut angles_rad = std::mem::take(&mut self.angles_rad);
        if self.begun {
            self.follow_from(placed, &mut angles_rad);
        } else {
            self.begin_from(placed, &mut angles_rad);
        }
        self.angles_rad = angles_rad;
        &self.angles_rad
    }

    /// As [`Follower::follow`], near angles that somebody else kept; the best branch of all.
    pub(crate) fn begin_from(&mut self, placed: &[Placed], angles_rad: &mut [f64]) {
        self.body.led(placed, &mut self.led);
        self.body.retarget.begin(&self.led, angles_rad, &mut self.report);
        self.body.model.chain.lead(angles_rad);
        self.begun = true;
    }

    /// As [`Follower::follow`], near angles that somebody else kept.
    pub(crate) fn follow_from(&mut self, placed: &[Placed], angles_rad: &mut [f64]) {
        self.body.led(placed, &mut self.led);
        self.body.retarget.follow(&self.led, angles_rad, &mut self.report);
        self.body.model.chain.lead(angles_rad);
    }

    /// How the last pose went.
    pub(crate) fn report(&self) -> &RetargetReport {
        &self.report
    }

    /// For every followed link: how far its direction is from where it was wanted, radians, and the joint that
    /// stands in the way (one at its limit, else the outermost).
    pub(crate) fn errors(&self) -> impl Iterator<Item = (usize, f64)> {
        self.report.groups.iter().filter_map(|group| {
            let following = self.body.followers.iter().find(|f| f.link == group.link)?;
            let mut at_limit = following.joints.iter().zip(group.at_limit);
            let limited = at_limit.find(|(_, at)| *at).map(|(joint, _)| joint);
            let joint = limited.or(following.joints.last())?;
            Some((joint.index(), group.direction_error_rad))
        })
    }
}

/// The joints that follow the figure through each group: its own, and those of groups before it that follow nothing.
fn joints_of(
    profile: &PuppetProfile,
    figure: &Figure,
    model: &Model,
) -> Result<Vec<Vec<JointIndex>>, BodyError> {
    let led = |at: usize| {
        profile
            .groups
            .get(at)
            .is_some_and(|group| link_of(group, figure).is_some())
    };
    let no_such_link = |group: &PuppetGroup| BodyError::NoSuchLink {
        puppet: profile.name.clone(),
        link: names(group).cloned().collect::<Vec<_>>().join(" or "),
        known: figure
            .links()
            .iter()
            .map(|l| l.name.as_str())
            .collect::<Vec<_>>()
            .join(", "),
    };
    if let Some(root) = profile.groups.first().filter(|_| !led(0)) {
        return Err(no_such_link(root));
    }
    let free = |joint: &&JointIndex| model.chain.led(**joint).is_none();
    let mut joints: Vec<Vec<JointIndex>> = vec![Vec::new(); profile.groups.len()];
    let mut taken = vec![false; profile.groups.len()];
    for (at, link) in model.links.iter().enumerate().filter(|(at, _)| led(*at)) {
        let mut own: Vec<JointIndex> = link.own.iter().filter(free).copied().collect();
        let mut before = link.parent.filter(|&parent| parent > 0 && !led(parent));
        while let Some(parent) = before.filter(|&parent| !taken[parent] && !own.is_empty()) {
            let theirs = model.links[parent].own.iter().filter(free).copied();
            let both: Vec<JointIndex> = theirs.chain(own.iter().copied()).collect();
            if both.len() > GROUP_JOINTS_MAX {
                break;
            }
            (own, taken[parent]) = (both, true);
            before = model.links[parent]
                .parent
                .filter(|&parent| parent > 0 && !led(parent));
        }
        (joints[at], taken[at]) = (own, true);
    }
    let idle = |(at, group): &(usize, &PuppetGroup)| !taken[*at] && !group.joints.is_empty();
    match profile.groups.iter().enumerate().find(idle) {
        // Laid out for this kind of figure, it wants all of it.
        Some((_, group)) if profile.figure.is_some() => Err(no_such_link(group)),
        _ => Ok(joints),
    }
}

/// How the link lies in the frame of its group's last joint.
fn turn_of(profile: &PuppetProfile, tree: &Figure, link: LinkIndex) -> DQuat {
    let number = tree.link(link).map_or(0, |link| link.number as usize);
    profile
        .groups
        .get(number)
        .map_or(DQuat::IDENTITY, |group| tool(group).rotation)
}

/// What a group's link may be called.
fn names(group: &PuppetGroup) -> impl Iterator<Item = &String> {
    std::iter::once(&group.link).chain(&group.also)
}

fn link_of(group: &PuppetGroup, figure: &Figure) -> Option<LinkIndex> {
    names(group).find_map(|name| figure.by_name(name))
}

/// The figure's link that leads a group of so many joints.
fn leader(
    group: &PuppetGroup,
    joints: usize,
    figure: &Figure,
    rest: RestFrames<'_>,
) -> Option<(LinkIndex, DMat3)> {
    let link = link_of(group, figure)?;
    // A direction alone (two joints) needs the bone's own axis, whatever the rest pose was.
    let whole = group.parent.is_none() || joints == GROUP_JOINTS_MAX;
    let turn = match rest.and_then(|frames| frames.get(link.index())) {
        Some(world_from_link) if whole => world_from_link.transpose() * upright(),
        _ => DMat3::IDENTITY,
    };
    Some((link, turn))
}

/// The groups as a tree of links, so that they can be followed as a figure is.
fn tree_of(profile: &PuppetProfile, joints: &[Vec<JointIndex>]) -> Vec<LinkSpec> {
    let place = |link: &str| profile.groups.iter().position(|g| g.link == link);
    let mut specs: Vec<LinkSpec> = profile
        .groups
        .iter()
        .zip(joints)
        .enumerate()
        .map(|(number, (group, joints))| LinkSpec {
            number: number as u32,
            name: group.link.clone(),
            dof: if group.parent.is_none() || joints.len() == GROUP_JOINTS_MAX {
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
