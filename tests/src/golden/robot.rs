//! A robot following a figure, frame by frame.

use super::number::{index, list, number, numbers, point};
use super::pose::zyz_matrix;
use super::{Answered, Refusal};
use glam::{DQuat, DVec3};
use motion::{
    Chain, Figure, Group, Interval, Joint, JointIndex, JointKind, LinkSpec, Placed, Retarget, RetargetReport,
    Rigid,
};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;

fn rpy(value: &Value) -> DQuat {
    Rigid::from_xyz_rpy(DVec3::ZERO, point(value)).rotation
}

/// A figure of the same tree; its lengths and attachments play no part in angles.
fn figure(links: &[Value]) -> Result<Figure, Refusal> {
    let number_of = |link: &Value| index(&link["link"]) as u32;
    let specs: Vec<LinkSpec> = links
        .iter()
        .map(|link| LinkSpec {
            number: number_of(link),
            name: String::new(),
            dof: index(&link["dof"]) as u32,
            length: 1.0,
            children: links
                .iter()
                .filter(|child| child["parent"].is_u64() && child["parent"] == link["link"])
                .map(|child| (number_of(child), DVec3::Z))
                .collect(),
        })
        .collect();
    Ok(Figure::new(&specs)?.0)
}

/// The chain's joints and, for each link, the joint its children hang from.
fn joints(links: &[Value]) -> (Vec<Joint>, BTreeMap<u64, Vec<JointIndex>>) {
    let (mut joints, mut of_link, mut tip) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
    for link in links {
        let number_of = link["link"].as_u64().unwrap_or(0);
        let mut parent = link["parent"]
            .as_u64()
            .and_then(|p| tip.get(&p).copied().flatten());
        let mut own = Vec::new();
        for spec in list(&link["joints"]) {
            let here = JointIndex(joints.len() as u16);
            joints.push(Joint {
                name: format!("joint {}", here.0),
                parent,
                parent_from_joint: Rigid::from_xyz_rpy(DVec3::ZERO, point(&spec["origin_rpy"])),
                kind: JointKind::Revolute {
                    axis: point(&spec["axis"]),
                },
                range_rad: Interval::new(number(&spec["lower"]), number(&spec["upper"])),
                speed_max_rad_per_s: f64::INFINITY,
            });
            parent = Some(here);
            own.push(here);
        }
        tip.insert(number_of, parent);
        of_link.insert(number_of, own);
    }
    (joints, of_link)
}

pub(super) fn robot(input: &Value) -> Answered {
    let links = list(&input["chain"]);
    let figure = Arc::new(figure(links)?);
    let (joints, of_link) = joints(links);
    let chain = Arc::new(Chain::new(joints).map_err(|_| Refusal::new("bad_chain"))?);
    let (mut base, mut groups) = (None, Vec::new());
    for link in links {
        let number_of = index(&link["link"]);
        let Some(followed) = figure.by_number(number_of as u32) else {
            continue;
        };
        let joint_from_link = rpy(&link["tool_rpy"]);
        let own = of_link[&(number_of as u64)].clone();
        if own.is_empty() && link["parent"].is_null() {
            base = Some((followed, joint_from_link));
        } else if !own.is_empty() {
            groups.push(Group {
                link: followed,
                joints: own,
                joint_from_link,
            });
        }
    }
    let retarget =
        Retarget::new(Arc::clone(&figure), chain, base, &groups).map_err(|_| Refusal::new("bad_chain"))?;
    let mut angles = vec![0.0; retarget.chain().len()];
    for (link, own) in &of_link {
        for (joint, angle) in own.iter().zip(numbers(&input["q0"][link.to_string()])) {
            angles[joint.index()] = angle;
        }
    }
    let mut frames = Vec::new();
    let mut report = RetargetReport::default();
    for (at, frame) in list(&input["frames"]).iter().enumerate() {
        let placed: Vec<Placed> = figure
            .links()
            .iter()
            .map(|link| zyz_matrix(&frame[link.number.to_string()]))
            .map(|world_from_link| Placed {
                start: DVec3::ZERO,
                end: DVec3::ZERO,
                world_from_link,
            })
            .collect();
        if at == 0 {
            retarget.begin(&placed, &mut angles, &mut report);
        } else {
            retarget.follow(&placed, &mut angles, &mut report);
        }
        frames.push(solved(&figure, &report, &of_link, &angles));
    }
    Ok(json!({ "frames": frames }))
}

fn solved(
    figure: &Figure,
    report: &RetargetReport,
    of_link: &BTreeMap<u64, Vec<JointIndex>>,
    angles: &[f64],
) -> Value {
    let mut out = Map::new();
    for group in &report.groups {
        let number_of = figure.links()[group.link.index()].number;
        let own = &of_link[&u64::from(number_of)];
        let entry = json!({
            "q_rad": own.iter().map(|joint| angles[joint.index()]).collect::<Vec<_>>(),
            "cost": group.cost, "switched": group.switched,
            "at_limit": group.at_limit[..own.len()], "dir_err_rad": group.direction_error_rad,
        });
        out.insert(number_of.to_string(), entry);
    }
    Value::Object(out)
}
