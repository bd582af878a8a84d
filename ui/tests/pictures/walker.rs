//! A snapshot made by hand: the printed human walking, everything else in the middle of a busy evening.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use motion::figure::{Figure, FigurePose, LinkPose, LinkSpec};
use motion::{Clip, FigureKey, Keyframes};
use ps300::display::Stroke;
use rig::{
    DeskKeyView, DeviceHealth, DeviceView, FeasibilityView, FigureView, JointView, KeyView, KineticsView,
    Note, NoteLevel, PuppetState, PuppetView, Snapshot, StretchKind, StretchView, TransportView, ViewState,
};

/// Number, name, freedoms, length, children with their places.
type Row = (u32, &'static str, u32, f64, &'static [(u32, [f64; 3])]);

/// `ar.str` of the thesis.
const LINKS: [Row; 15] = [
    (0, "head", 3, 0.2, &[(1, [0.0, 0.0, 0.2])]),
    (
        1,
        "trunk",
        3,
        0.3,
        &[
            (2, [0.125, 0.0, 0.0]),
            (5, [-0.125, 0.0, 0.0]),
            (8, [0.0, 0.0, 0.3]),
        ],
    ),
    (2, "rua", 2, 0.2, &[(3, [0.0, 0.0, 0.2])]),
    (3, "rfa", 2, 0.15, &[(4, [0.0, 0.0, 0.15])]),
    (4, "rh", 2, 0.1, &[]),
    (5, "lua", 2, 0.2, &[(6, [0.0, 0.0, 0.2])]),
    (6, "lfa", 2, 0.15, &[(7, [0.0, 0.0, 0.15])]),
    (7, "lh", 2, 0.1, &[]),
    (
        8,
        "pelv",
        3,
        0.1,
        &[(9, [0.05, 0.0, 0.1]), (12, [-0.05, 0.0, 0.1])],
    ),
    (9, "rt", 2, 0.25, &[(10, [0.0, 0.0, 0.25])]),
    (10, "rc", 2, 0.25, &[(11, [0.0, 0.0, 0.25])]),
    (11, "rf", 2, 0.1, &[]),
    (12, "lt", 2, 0.25, &[(13, [0.0, 0.0, 0.25])]),
    (13, "lc", 2, 0.25, &[(14, [0.0, 0.0, 0.25])]),
    (14, "lf", 2, 0.1, &[]),
];

/// The human of 15 links.
pub(crate) fn figure() -> Arc<Figure> {
    let specs: Vec<LinkSpec> = LINKS
        .iter()
        .map(|&(number, name, dof, length, children)| LinkSpec {
            number,
            name: name.to_owned(),
            dof,
            length,
            children: children
                .iter()
                .map(|&(child, at)| (child, DVec3::from_array(at)))
                .collect(),
        })
        .collect();
    Arc::new(Figure::new(&specs).expect("the table is a tree").0)
}

/// What each link looks like: trapezoids for head, trunk and pelvis, lines for limbs (`ar.pri`, `ar.shp`).
pub(crate) fn shapes() -> Vec<Vec<Stroke>> {
    let stroke = |from: [f64; 3], to: [f64; 3], hue_deg: f64| Stroke {
        from: DVec3::from_array(from),
        to: DVec3::from_array(to),
        hue_deg,
        saturation: 1.0,
        intensity: [1.0; 2],
        view: 0,
    };
    LINKS
        .iter()
        .map(|&(_, name, _, length, _)| {
            let (wide, narrow) = match name {
                "head" => (0.05, 0.0),
                "trunk" => (0.1, 0.0),
                "pelv" => (0.0, 0.045),
                _ => return vec![stroke([0.0; 3], [0.0, 0.0, length], 60.0)],
            };
            let corners = [
                [-wide, 0.0, 0.0],
                [wide, 0.0, 0.0],
                [narrow, 0.0, length],
                [-narrow, 0.0, length],
            ];
            (0..4)
                .map(|i| stroke(corners[i], corners[(i + 1) % 4], 90.0))
                .collect()
        })
        .collect()
}

/// One moment of a walk; a whole step is a phase of one turn.
pub(crate) fn pose(figure: &Figure, phase_rad: f64) -> FigurePose {
    let swing = |amount: f64, lag: f64| amount * (phase_rad + lag).sin();
    let down = |forward: f64, out: f64| DVec3::new(out, -1.0, forward).normalize_or_zero();
    let directions = [
        down(0.05, 0.0),
        down(-0.06, 0.0),
        down(swing(0.6, 0.0), -0.18),
        down(0.3 + swing(0.5, -0.3), -0.05),
        down(0.4 + swing(0.5, -0.5), 0.0),
        down(-swing(0.6, 0.0), 0.18),
        down(0.3 - swing(0.5, -0.3), 0.05),
        down(0.4 - swing(0.5, -0.5), 0.0),
        down(0.0, 0.0),
        down(-swing(0.55, 0.0), -0.04),
        down(-0.25 - swing(0.6, 0.9), 0.0),
        DVec3::new(-0.2, -0.35 - swing(0.3, 0.9), 1.0).normalize_or_zero(),
        down(swing(0.55, 0.0), 0.04),
        down(-0.25 + swing(0.6, 0.9), 0.0),
        DVec3::new(0.2, -0.35 + swing(0.3, 0.9), 1.0).normalize_or_zero(),
    ];
    let links = directions
        .into_iter()
        .zip(figure.links())
        .map(|(direction, link)| LinkPose {
            direction,
            // Puts a downward link's x axis, and with it the shoulders, across the front view.
            twist_rad: std::f64::consts::FRAC_PI_2,
            length: link.length,
        })
        .collect();
    FigurePose {
        root: DVec3::new(0.0, 1.3 + 0.02 * (2.0 * phase_rad).cos(), 0.0),
        links,
    }
}

/// Times of the keys: quick, quick, slow.
pub(crate) const KEY_SECS: [f64; 6] = [0.0, 0.3, 0.6, 1.1, 1.6, 2.4];

/// The walk's clip.
pub(crate) fn clip(figure: &Arc<Figure>) -> Arc<Clip> {
    let mut keyframes = Keyframes::new(figure.clone());
    for (index, secs) in KEY_SECS.into_iter().enumerate() {
        let phase = index as f64 * std::f64::consts::PI / 2.5 + 0.4;
        let key = FigureKey {
            secs,
            pose: pose(figure, phase),
        };
        keyframes = keyframes.with_key(key).expect("times ascend");
    }
    Arc::new(Clip::build(&keyframes).expect("six keys make a clip"))
}

/// The figure at a time of the clip.
pub(crate) fn figure_view(figure: &Arc<Figure>, clip: &Clip, secs: f64) -> FigureView {
    let mut pose = figure.rest_pose();
    clip.sample(secs, &mut pose);
    let mut placed = Vec::new();
    clip.place(secs, &mut placed);
    FigureView {
        figure: figure.clone(),
        shapes: Arc::new(shapes()),
        pose,
        placed,
        selected: None,
        cursor: None,
        candidates: Vec::new(),
        posing: false,
    }
}

fn kinetics(clip: &Clip) -> KineticsView {
    let curve = (0..=160).map(|i| {
        let secs = 2.4 * f64::from(i) / 160.0;
        [secs, clip.kinetics().u(secs)]
    });
    let coefficients = clip.kinetics().coefficients();
    let last = (coefficients.len() - 1) as f64;
    KineticsView {
        mode: "natural".into(),
        curve: curve.collect(),
        coefficients: coefficients
            .iter()
            .enumerate()
            .map(|(i, &u)| [2.4 * i as f64 / last, u])
            .collect(),
        selected: None,
        reversals: Vec::new(),
    }
}

/// Dial pages as the shipped network labels them.
const DIALS: [&str; 8] = [
    "X-Rot", "Y-Rot", "Zoom", "Time", "Twist", "Link", "Kinetic", "Speed",
];
const KEYS: [&str; 12] = [
    "PLACE", "NEAR/FAR", "STORE", "DELETE", "PREV KEY", "NEXT KEY", "PLAY", "LOOP", "FOLLOW", "ARM", "HOLD",
    "PAGE",
];

/// Joints of the marionette.
const JOINTS: [&str; 20] = [
    "neck_yaw",
    "neck_pitch",
    "r_shoulder_pitch",
    "r_shoulder_roll",
    "r_elbow",
    "r_wrist",
    "l_shoulder_pitch",
    "l_shoulder_roll",
    "l_elbow",
    "l_wrist",
    "waist_yaw",
    "waist_pitch",
    "r_hip_roll",
    "r_hip_pitch",
    "r_knee",
    "r_ankle",
    "l_hip_roll",
    "l_hip_pitch",
    "l_knee",
    "l_ankle",
];

/// The link that a joint moves, by its place in [`LINKS`].
fn link_of(joint: &str) -> usize {
    const ENDINGS: [(&str, usize); 12] = [
        ("neck_yaw", 0),
        ("neck_pitch", 0),
        ("r_shoulder_pitch", 2),
        ("r_shoulder_roll", 2),
        ("r_elbow", 3),
        ("r_wrist", 4),
        ("waist_yaw", 8),
        ("waist_pitch", 8),
        ("r_hip_roll", 9),
        ("r_hip_pitch", 9),
        ("r_knee", 10),
        ("r_ankle", 11),
    ];
    let right = joint.replacen("l_", "r_", 1);
    let found = ENDINGS.iter().find(|(name, _)| *name == joint || *name == right);
    let link = found.map_or(1, |(_, link)| *link);
    match (joint.starts_with("l_"), link) {
        (true, 2..=7 | 9..=11) => link + 3,
        _ => link,
    }
}

/// A figure's lines from its trunk, first the trunk, and what joins them: the puppet is where the figure was `secs`.
fn bones(figure: &Arc<Figure>, clip: &Clip, secs: f64) -> Vec<[DVec3; 2]> {
    let placed = figure_view(figure, clip, secs).placed;
    let base = placed[1].start;
    let line = |link: usize| [placed[link].start - base, placed[link].end - base];
    let order = bone_order();
    let mut lines: Vec<[DVec3; 2]> = order.iter().map(|link| line(*link)).collect();
    for (number, .., children) in LINKS {
        for (child, _) in children.iter().filter(|(child, _)| *child != 1) {
            let ([from, to], start) = (line(number as usize), line(*child as usize)[0]);
            let nearer = if start.distance(from) < start.distance(to) {
                from
            } else {
                to
            };
            lines.push([nearer, start]);
        }
    }
    lines
}

/// Links in the order of the puppet's groups: the trunk carries all others.
fn bone_order() -> Vec<usize> {
    std::iter::once(1)
        .chain(std::iter::once(0))
        .chain(2..LINKS.len())
        .collect()
}

fn joints() -> Vec<JointView> {
    let joint = |(index, name): (usize, &&str)| {
        let goal = (index as f64 * 0.7).sin() * 0.9;
        JointView {
            name: (*name).to_owned(),
            bone: bone_order()
                .iter()
                .position(|link| *link == link_of(name))
                .unwrap_or(0),
            lag_secs: Some(if *name == "r_wrist" {
                0.084
            } else {
                0.03 + index as f64 * 1e-3
            }),
            goal_rad: Some(goal),
            measured_rad: Some(goal + 0.06 * (index as f64 * 1.9).cos()),
            age_secs: 0.012,
            range_rad: [-1.6, 1.6],
            temperature_c: Some(38.0),
            voltage_v: Some(11.9),
            present: true,
            error: None,
            ..JointView::default()
        }
    };
    JOINTS.iter().enumerate().map(joint).collect()
}

fn puppet(figure: &Arc<Figure>, clip: &Clip) -> PuppetView {
    PuppetView {
        bones: bones(figure, clip, 0.80),
        goal_bones: bones(figure, clip, 0.86),
        pace: 1.0,
        name: "marionette".into(),
        state: PuppetState::Playing,
        fault: None,
        joints: joints(),
        clip_secs: Some(0.86),
        stale_discarded: 0,
        interventions: 3,
        late_cycles: 1,
        torque: true,
        ..PuppetView::default()
    }
}

fn devices() -> Vec<DeviceView> {
    let device = |name: &str, profile: &str, health, events| DeviceView {
        name: name.into(),
        profile: profile.into(),
        address: format!("sim:{name}"),
        health,
        events,
        ..DeviceView::default()
    };
    vec![
        device("dial-box", "sgi-dialbox-display", DeviceHealth::Present, 1284),
        device("tablet", "graphire-serial", DeviceHealth::Present, 20_671),
    ]
}

/// Playing, with a puppet and a desk.
pub(crate) fn playing() -> Snapshot {
    let figure = figure();
    let clip = clip(&figure);
    let secs = 0.86;
    let mut seen = Snapshot {
        at_secs: 93.0,
        step: 9300,
        show: "first steps".into(),
        unsaved: true,
        figure: Some(figure_view(&figure, &clip, secs)),
        clip_name: "walk".into(),
        keys: KEY_SECS
            .iter()
            .map(|&secs| KeyView {
                secs,
                selected: false,
            })
            .collect(),
        kinetics: kinetics(&clip),
        puppet: Some(puppet(&figure, &clip)),
        clip: Some(clip),
        transport: TransportView {
            secs,
            start_secs: 0.0,
            end_secs: 2.4,
            playing: true,
            looped: true,
            speed: 1.0,
        },
        view: ViewState {
            azimuth_rad: 0.6,
            elevation_rad: 0.12,
            scale: 0.88,
            centre: DVec3::new(0.0, 0.74, 0.0),
        },
        devices: devices(),
        undo: Some("store key 6".into()),
        notes: vec![Note {
            at_secs: 92.0,
            level: NoteLevel::Info,
            text: "the puppet has reached the clip's first pose".into(),
        }],
        ..Snapshot::default()
    };
    for (dial, label) in seen.desk.dials.iter_mut().zip(DIALS) {
        dial.label = label.into();
    }
    for (index, dial) in seen.desk.dials.iter_mut().enumerate() {
        dial.turns = index as f64 * 0.37 - 0.6;
    }
    seen.desk.dials[3].live = true;
    for (key, label) in seen.desk.keys.iter_mut().zip(KEYS) {
        *key = DeskKeyView {
            label: label.into(),
            lit: false,
            down: false,
        };
    }
    seen.desk.keys[6].lit = true;
    seen.desk.keys[7].lit = true;
    seen.desk.simulated_device = Some("dial-box".into());
    seen
}

/// The same clip for a puppet that is not as quick: a forearm is asked too much of twice, a knee cannot bend so far.
pub(crate) fn strained() -> Snapshot {
    let mut seen = playing();
    let stretch = |joint: &str, link, [from_secs, to_secs]: [f64; 2], kind, factor| StretchView {
        from_secs,
        to_secs,
        joint: joint.into(),
        link: Some(link),
        kind,
        factor,
        slowable: kind != StretchKind::Reach,
    };
    seen.feasibility = Some(FeasibilityView {
        progress: 1.0,
        stretches: [
            stretch("r_knee", 9, [0.3, 0.36], StretchKind::Reach, 1.1),
            stretch("r_elbow", 3, [0.62, 1.02], StretchKind::Speed, 1.8),
            stretch("r_shoulder_pitch", 2, [0.7, 0.95], StretchKind::Acceleration, 1.3),
            stretch("r_elbow", 3, [1.7, 1.9], StretchKind::Speed, 1.2),
        ]
        .into(),
        slow_down: 1.8,
        ..FeasibilityView::default()
    });
    if let Some(figure) = &mut seen.figure {
        figure.selected = Some(3);
    }
    seen
}

/// Posing a forearm, nothing playing, the puppet stopped by hand.
pub(crate) fn posing() -> Snapshot {
    let mut seen = playing();
    seen.transport = TransportView {
        secs: 0.6,
        playing: false,
        looped: false,
        ..seen.transport
    };
    seen.keys[2].selected = true;
    if let (Some(view), Some(clip)) = (&mut seen.figure, &seen.clip) {
        *view = figure_view(&view.figure.clone(), clip, 0.6);
        let link = view.placed[3];
        view.selected = Some(3);
        view.posing = true;
        view.candidates = vec![
            link.end,
            link.start + (link.end - link.start) * DVec3::new(1.0, 1.0, -1.0),
        ];
        view.cursor = Some(DVec2::new(-0.34, 0.18));
    }
    if let Some(puppet) = &mut seen.puppet {
        puppet.state = PuppetState::Faulted;
        puppet.fault =
            Some("servo 5 (r_elbow) reports overload; free the joint, then reset and arm again".into());
        puppet.clip_secs = None;
        puppet.joints[4].error = Some("overload".into());
        puppet.joints[9].present = false;
    }
    seen.desk.dials[3].live = false;
    seen.desk.keys[6].lit = false;
    seen.desk.keys[7].lit = false;
    seen.devices[1].health = DeviceHealth::Lost;
    seen.unsaved = false;
    seen.redo = Some("move key 3".into());
    seen
}
