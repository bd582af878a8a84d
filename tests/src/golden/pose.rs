//! Directions, orientations, figures and posing by cursor.

use super::number::{index, list, number, numbers, point, rows, vector};
use super::{Answered, Refusal};
use glam::{DMat3, DVec2};
use motion::figure::posing::{self, PosingError, Side, Sight, View};
use motion::figure::{
    BadDirection, GreatCircle, Sweep, Zyz, frame_of, matrix_from_zyz, unit, zyz_from_matrix,
};
use motion::{
    Clip, ClipError, DirectionLaw, Figure, FigureError, FigureKey, FigurePose, Keyframes, KineticsMode,
    LinkPose, LinkSpec, TwistLaw,
};
use serde_json::{Map, Value, json};
use std::sync::Arc;

impl From<BadDirection> for Refusal {
    fn from(BadDirection: BadDirection) -> Self {
        Self::new("bad_direction")
    }
}

impl From<FigureError> for Refusal {
    fn from(error: FigureError) -> Self {
        use FigureError as E;
        let (code, link) = match error {
            E::DuplicateNumber { number } => ("duplicate_id", number),
            E::BadFreedom { link, .. } => ("bad_dof", link),
            E::BadLength { link, .. } => ("bad_length", link),
            E::NotFinite { link, .. } => ("non_finite", link),
            E::MissingChild { link, .. } => ("missing_child", link),
            E::TwoParents { child, .. } => ("two_parents", child),
            E::RootCount { .. } => return Self::new("root_count"),
            E::TooMany { .. } => return Self::new("too_many"),
        };
        Self::at(code, "link", link as usize)
    }
}

fn laws(input: &Value) -> (DirectionLaw, TwistLaw) {
    let direction = match input["mode"].as_str() {
        Some("chord") => DirectionLaw::Chord,
        _ => DirectionLaw::Constant,
    };
    let twist = match input["twist_mode"].as_str() {
        Some("zyz") => TwistLaw::Zyz,
        _ => TwistLaw::Transport,
    };
    (direction, twist)
}

fn angles(matrix: &DMat3) -> Value {
    let zyz = zyz_from_matrix(matrix);
    json!([zyz.azimuth_rad, zyz.polar_rad, zyz.twist_rad].map(f64::to_degrees))
}

pub(super) fn zyz_matrix(value: &Value) -> DMat3 {
    let given = point(value);
    matrix_from_zyz(Zyz {
        azimuth_rad: given.x.to_radians(),
        polar_rad: given.y.to_radians(),
        twist_rad: given.z.to_radians(),
    })
}

pub(super) fn zyz(input: &Value) -> Value {
    let matrix = zyz_matrix(&input["zyz"]);
    json!({ "matrix": rows(&matrix), "zyz": angles(&matrix) })
}

pub(super) fn direction(input: &Value) -> Answered {
    let from = point(&input["d0"]);
    let start = unit(from)?;
    let (sin, cos) = number(&input["twist0"]).to_radians().sin_cos();
    let frame = frame_of(start);
    let own_x = frame.x_axis * cos + frame.y_axis * sin;
    let circle = GreatCircle::between(from, point(&input["d1"]), own_x, laws(input).0)?;
    let sample = |&s: &f64| json!({ "s": s, "dir": vector(circle.direction(s), 3), "speed": circle.speed(s).to_degrees() });
    let samples: Vec<Value> = numbers(&input["fractions"]).iter().map(sample).collect();
    Ok(json!({
        "angle": circle.angle_rad().to_degrees(), "ambiguous": circle.ambiguous(), "samples": samples,
    }))
}

fn link_pose(key: &Value, rest_length: f64) -> LinkPose {
    LinkPose {
        direction: point(&key["dir"]),
        twist_rad: number(&key["twist"]).to_radians(),
        length: key.get("length").map_or(rest_length, number),
    }
}

pub(super) fn orientation(input: &Value) -> Answered {
    let (direction_law, twist_law) = laws(input);
    let (from, to) = (link_pose(&input["k0"], 1.0), link_pose(&input["k1"], 1.0));
    let sweep = Sweep::between(&from, &to, direction_law, twist_law)?;
    let sample = |&s: &f64| {
        let frame = sweep.frame(s);
        json!({ "s": s, "matrix": rows(&frame), "zyz": angles(&frame) })
    };
    let samples: Vec<Value> = numbers(&input["fractions"]).iter().map(sample).collect();
    Ok(json!({ "samples": samples }))
}

fn read_figure(input: &Value) -> Result<Figure, Refusal> {
    let specs: Vec<LinkSpec> = list(&input["links"])
        .iter()
        .map(|link| LinkSpec {
            number: index(&link["id"]) as u32,
            name: String::new(),
            dof: index(&link["dof"]) as u32,
            length: number(&link["length"]),
            children: list(&link["children"])
                .iter()
                .map(|child| (index(&child["id"]) as u32, point(&child["at"])))
                .collect(),
        })
        .collect();
    let (figure, _warnings) = Figure::new(&specs)?;
    Ok(figure)
}

pub(super) fn figure_check(input: &Value) -> Answered {
    let figure = read_figure(input)?;
    Ok(json!({ "order": figure.links().iter().map(|link| link.number).collect::<Vec<_>>() }))
}

/// The keys as keyframes one second apart, with straight kinetics, so that seconds are key coordinates.
fn keyframes(input: &Value) -> Result<Keyframes, Refusal> {
    let figure = Arc::new(read_figure(input)?);
    let (direction_law, twist_law) = laws(input);
    let mut keyframes = Keyframes {
        direction_law,
        twist_law,
        kinetics: KineticsMode::Linear,
        ..Keyframes::new(figure)
    };
    for (secs, key) in list(&input["keys"]).iter().enumerate() {
        let links = keyframes
            .figure
            .links()
            .iter()
            .map(|link| link_pose(&key["links"][link.number.to_string()], link.length))
            .collect();
        let pose = FigurePose {
            root: point(&key["root"]),
            links,
        };
        keyframes.keys.push(FigureKey {
            secs: secs as f64,
            pose,
        });
    }
    Ok(keyframes)
}

pub(super) fn figure(input: &Value) -> Answered {
    let keyframes = keyframes(input)?;
    let clip = Clip::build(&keyframes).map_err(|error| match error {
        ClipError::Kinetics(kinetics) => kinetics.into(),
        ClipError::BadDirection { link, .. } => Refusal::at(
            "bad_direction",
            "link",
            keyframes.figure.links()[link.index()].number as usize,
        ),
        ClipError::BadPose { key } => Refusal::at("bad_length", "index", key),
        ClipError::PoseOfAnotherFigure { .. } => Refusal::new("length_mismatch"),
    })?;
    let mut placed = Vec::new();
    let mut frames = Vec::new();
    for kappa in numbers(&input["kappas"]) {
        clip.place(kappa, &mut placed);
        let mut links = Map::new();
        for (link, at) in keyframes.figure.links().iter().zip(&placed) {
            let entry = json!({
                "start": vector(at.start, 3), "end": vector(at.end, 3),
                "length": at.start.distance(at.end), "zyz": angles(&at.world_from_link),
            });
            links.insert(link.number.to_string(), entry);
        }
        frames.push(json!({ "kappa": kappa, "links": links }));
    }
    Ok(json!({ "frames": frames }))
}

pub(super) fn tablet(input: &Value) -> Answered {
    let turns = point(&input["view"]);
    let view = View {
        view_from_world: DMat3::from_rotation_x(turns.x.to_radians())
            * DMat3::from_rotation_y(turns.y.to_radians())
            * DMat3::from_rotation_z(turns.z.to_radians()),
        centre: point(&input["centre"]),
        scale: number(&input["scale"]),
    };
    let cursor = DVec2::new(number(&input["cursor"][0]), number(&input["cursor"][1]));
    let (start, length) = (point(&input["start"]), number(&input["length"]));
    let answer = posing::aim(&view, start, length, cursor).map_err(|error| {
        Refusal::new(match error {
            PosingError::BadLength(_) => "bad_length",
            PosingError::BadScale(_) => "bad_scale",
            PosingError::NotFinite => "non_finite",
        })
    })?;
    let side = if input["side"].as_str() == Some("far") {
        Side::Far
    } else {
        Side::Near
    };
    let direction = answer.direction(side);
    let (azimuth, polar) = posing::sphere_angles(direction);
    let (kind, solutions) = match answer.sight {
        Sight::Outside => ("outside", vec![answer.near]),
        Sight::Tangent => ("tangent", vec![answer.near]),
        Sight::Inside => ("inside", vec![answer.near, answer.far]),
    };
    Ok(json!({
        "kind": kind, "solutions": solutions.into_iter().map(|d| vector(d, 3)).collect::<Vec<_>>(),
        "dir": vector(direction, 3), "end": vector(start + direction * length, 3),
        "azimuth": azimuth.to_degrees(), "polar": polar.to_degrees(),
    }))
}
