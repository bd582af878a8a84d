//! The window: asks a session for what is to be seen, and gives it what hands want done.
//!
//! The window never steps the rig: whoever runs the rig does, at its own pace, on its own thread. A slow
//! picture cannot make a servo late.

use std::sync::Arc;

use egui::{Rect, Ui, UiBuilder, pos2};
use rig::{Command, PuppetCommand, Snapshot, TransportCommand};

use crate::panels::controls::Controls;
use crate::panels::layout::Areas;
use crate::panels::patch::Patch;
use crate::panels::{Board, Choices, Commands, Panel, canvas, help, keyboard, style};
use crate::panels::{desk, devices, header, keys, puppet, transport, view};
use crate::patch::look::Look;
use crate::render::theme;
use crate::watch::Watch;

/// The other end of the window: a rig that runs somewhere else. It is looked at from two threads.
pub trait Session: Send + Sync {
    /// What is to be seen now; cheap, never waits for a step.
    fn snapshot(&self) -> Arc<Snapshot>;
    /// Passes on what a hand wants done; never waits.
    fn send(&self, command: Command);
    /// Whether the window is to close by itself, as after Ctrl-C where the program was started.
    fn is_over(&self) -> bool {
        false
    }
}

impl Session for rig::live::Live {
    fn snapshot(&self) -> Arc<Snapshot> {
        rig::live::Live::snapshot(self)
    }

    fn send(&self, command: Command) {
        rig::live::Live::send(self, command);
    }
}

/// Shared, so that whoever started the rig can still close it when the window is gone.
impl<S: Session + ?Sized> Session for Arc<S> {
    fn snapshot(&self) -> Arc<Snapshot> {
        (**self).snapshot()
    }

    fn send(&self, command: Command) {
        (**self).send(command);
    }

    fn is_over(&self) -> bool {
        (**self).is_over()
    }
}

/// All panels, in the order the Tab key visits them.
pub struct Studio {
    panels: Vec<(Place, Box<dyn Panel>)>,
    choices: Choices,
    queue: Vec<Command>,
    patch: Patch,
    controls: Controls,
    /// Whether the rig was asked to show the network.
    looking: bool,
}

/// Panels whose place another board takes.
const COVERED: [&str; 3] = ["front", "side", "transport"];

/// Which of the layout's rectangles a panel takes.
type Place = fn(&Areas) -> Rect;

impl Default for Studio {
    fn default() -> Self {
        Studio::new()
    }
}

impl Studio {
    /// A studio with nothing chosen.
    pub fn new() -> Studio {
        let panels: Vec<(Place, Box<dyn Panel>)> = vec![
            (|areas| areas.front, Box::new(view::Front::default())),
            (|areas| areas.side, Box::new(view::Side)),
            (|areas| areas.transport, Box::new(transport::Transport::default())),
            (|areas| areas.desk, Box::new(desk::Desk::default())),
            (|areas| areas.header, Box::new(header::Header)),
            (|areas| areas.keys, Box::new(keys::Keys::default())),
            (|areas| areas.puppet, Box::new(puppet::Puppet::default())),
            (|areas| areas.devices, Box::new(devices::Devices)),
        ];
        Studio {
            panels,
            choices: Choices::default(),
            queue: Vec::new(),
            patch: Patch::default(),
            controls: Controls::default(),
            looking: false,
        }
    }

    /// The patch panel.
    pub fn patch(&mut self) -> &mut Patch {
        &mut self.patch
    }

    /// Draws everything into `ui`'s rectangle; returns what hands wanted since the last time, in order.
    pub fn ui(&mut self, ui: &mut Ui, seen: &Snapshot) -> Vec<Command> {
        let mut commands = Commands::new(&mut self.queue, &mut self.choices);
        keyboard::act(ui.ctx(), seen, &mut commands);
        // All of the window: whoever embeds the studio may keep a margin, the studio does not.
        let window = ui.ctx().content_rect();
        ui.set_clip_rect(window);
        let areas = Areas::of(window);
        ui.painter().rect_filled(window, 0.0, style::ink(theme::PANEL));
        let board = commands.choices.board;
        let patching = board == Board::Patch;
        for (place, panel) in &mut self.panels {
            if board != Board::Figure && COVERED.contains(&panel.title()) {
                continue;
            }
            let area = place(&areas);
            let builder = UiBuilder::new().max_rect(area).id_salt(panel.title());
            ui.scope_builder(builder, |ui| {
                ui.set_clip_rect(area.intersect(window));
                panel.ui(ui, seen, &mut commands);
            });
        }
        if patching != self.looking {
            self.looking = patching;
            commands.push(Command::LookAtNetwork(patching));
        }
        if patching {
            let look = Look::of(seen);
            let builder = UiBuilder::new().max_rect(areas.board()).id_salt("patch");
            let asked = ui.scope_builder(builder, |ui| {
                ui.set_clip_rect(areas.board().intersect(window));
                let asked = self.patch.ui(ui, look.as_ref());
                view::remark(ui, self.patch.table_area(areas.board()), seen);
                asked
            });
            for edit in asked.inner.edits {
                commands.push(Command::Network(edit));
            }
            if asked.inner.play {
                commands.push(Command::Transport(TransportCommand::Toggle));
            }
        }
        if board == Board::Controls {
            let builder = UiBuilder::new().max_rect(areas.board()).id_salt("controls");
            ui.scope_builder(builder, |ui| {
                ui.set_clip_rect(areas.board().intersect(window));
                self.controls.ui(ui, seen, &mut commands);
            });
        }
        separators(ui, &areas, board != Board::Figure);
        if self.choices.help {
            help::show(ui, areas.front.union(areas.side), patching);
        }
        std::mem::take(&mut self.queue)
    }

    /// What the window itself remembers.
    pub fn choices(&mut self) -> &mut Choices {
        &mut self.choices
    }
}

/// Hairlines between the panels.
fn separators(ui: &Ui, areas: &Areas, covered: bool) {
    let painter = ui.painter();
    let edge = style::hair(theme::EDGE);
    let column = areas.header.left() + 0.5;
    painter.vline(column, areas.header.top()..=areas.devices.bottom(), edge);
    for top in [areas.transport.top(), areas.desk.top()]
        .into_iter()
        .skip(usize::from(covered))
    {
        painter.hline(areas.transport.left()..=column, top + 0.5, edge);
    }
    for top in [areas.keys.top(), areas.puppet.top(), areas.devices.top()] {
        painter.hline(column..=areas.header.right(), top + 0.5, edge);
    }
}

/// The studio on a session, as a program of its own.
pub struct App {
    studio: Studio,
    session: Arc<dyn Session>,
    watch: Option<Watch>,
}

impl App {
    /// Prepares context and graphics card, and begins to watch the session.
    pub fn new(creation: &eframe::CreationContext<'_>, session: Box<dyn Session>) -> std::io::Result<App> {
        style::apply(&creation.egui_ctx);
        if let Some(state) = &creation.wgpu_render_state {
            canvas::setup(state);
        }
        let session: Arc<dyn Session> = session.into();
        let context = creation.egui_ctx.clone();
        let watch = Watch::start(Arc::clone(&session), move || context.request_repaint())?;
        Ok(App {
            studio: Studio::new(),
            session,
            watch: Some(watch),
        })
    }

    /// The studio inside.
    pub fn studio(&mut self) -> &mut Studio {
        &mut self.studio
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        if self.session.is_over() {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
        let seen = self.session.snapshot();
        for command in self.studio.ui(ui, &seen) {
            self.session.send(command);
        }
    }

    fn on_exit(&mut self) {
        self.watch = None;
        // Nobody is left to press STOP; letting go softly is the player's own policy.
        self.session.send(Command::Puppet(PuppetCommand::Release));
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        let theme::Rgb(r, g, b) = theme::PANEL;
        [r, g, b, 255].map(|c| f32::from(c) / 255.0)
    }
}

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum StudioError {
    /// Neither X11 nor Wayland is there.
    #[error(
        "there is no display (DISPLAY and WAYLAND_DISPLAY are empty); `dialrig demo` shows everything in files"
    )]
    NoDisplay,
    /// A library that is loaded while starting is not installed.
    #[error(
        "the library {library} is missing, without which no window can be opened; install it (Debian: {package})"
    )]
    MissingLibrary {
        /// The file's name.
        library: &'static str,
        /// The package that brings it.
        package: &'static str,
    },
    /// The window system refused.
    #[error("the window could not be opened: {0}")]
    Window(String),
}

/// Whether a window could be opened: for programs that want to know before they start anything else.
pub fn check() -> Result<(), StudioError> {
    crate::display::check()
}

/// Opens the window on a session and stays until it is closed.
pub fn run(session: Box<dyn Session>) -> Result<(), StudioError> {
    check()?;
    let viewport = egui::ViewportBuilder::default()
        .with_title("dialrig")
        .with_app_id("dialrig")
        .with_inner_size([1440.0, 900.0])
        .with_min_inner_size(crate::panels::layout::SMALLEST);
    let options = eframe::NativeOptions {
        viewport,
        ..eframe::NativeOptions::default()
    };
    eframe::run_native(
        "dialrig",
        options,
        Box::new(|creation| Ok(Box::new(App::new(creation, session)?))),
    )
    .map_err(|error| StudioError::Window(error.to_string()))
}

/// A rectangle of a window's size with its corner at zero.
pub fn window_rect(size: [f32; 2]) -> Rect {
    Rect::from_min_size(pos2(0.0, 0.0), size.into())
}
