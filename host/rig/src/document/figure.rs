//! The figure as the document keeps it: `motion`'s figure with the texts it was read from.

use std::sync::Arc;

use glam::DMat3;
use motion::Figure;

use super::bvh::{Skeleton, figure_of, joint_from_link};
use super::fault::Findings;
use super::source::Source;
use super::structure;

/// A figure with its sources. The texts are kept as written, comments included, and written back so.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureDoc {
    /// The figure's name: that of its files without the extension.
    pub name: String,
    /// Links and how they hang together. Link names are unique.
    pub figure: Arc<Figure>,
    /// Text of the structure file (`.str`).
    pub structure: Arc<str>,
    /// Text of the primitives file (`.pri`): network commands that define shapes; may be empty.
    pub primitives: Arc<str>,
    /// Text of the shapes file (`.shp`): network commands that give each link a shape; may be empty.
    pub shapes: Arc<str>,
    /// The motion-capture skeleton the figure was made from: joint i is the figure's link i.
    pub skeleton: Option<Arc<Skeleton>>,
}

/// The texts of the shape files; empty where there is no such file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FigureTexts {
    /// `.pri`.
    pub primitives: String,
    /// `.shp`.
    pub shapes: String,
}

impl FigureDoc {
    /// Reads a structure file into a figure called `name`.
    pub fn read(name: &str, structure: &Source, texts: FigureTexts, found: &mut Findings) -> Option<Self> {
        let mut own = Findings::default();
        let figure = structure::read(structure, &mut own);
        own.errors.into_iter().for_each(|error| found.error(error));
        own.warnings.into_iter().for_each(|warning| found.warn(warning));
        Some(Self {
            name: name.to_owned(),
            figure: Arc::new(figure?),
            structure: structure.text().into(),
            primitives: texts.primitives.into(),
            shapes: texts.shapes.into(),
            skeleton: None,
        })
    }

    /// A figure without shapes; its structure file is written from its links.
    pub fn from_figure(name: &str, figure: Figure, comment: &str) -> Self {
        Self {
            name: name.to_owned(),
            structure: structure::write(&figure, comment).into(),
            figure: Arc::new(figure),
            primitives: "".into(),
            shapes: "".into(),
            skeleton: None,
        }
    }

    /// How link axes lie when a motion-capture figure stands in its rest pose: `world_from_link`, one a link.
    /// `None` for a figure of our own, whose axes are what its structure file says.
    pub fn rest_frames(&self) -> Option<Vec<DMat3>> {
        let skeleton = self.skeleton.as_ref()?;
        Some(skeleton.bones().into_iter().map(joint_from_link).collect())
    }

    /// Adopts a skeleton; the words say why it is not this figure's.
    pub(super) fn set_skeleton(&mut self, skeleton: Skeleton) -> Result<(), String> {
        let expected = figure_of(&skeleton).map_err(|error| error.to_string())?;
        if expected != *self.figure {
            return Err("this skeleton does not belong to the figure beside it".to_owned());
        }
        self.skeleton = Some(Arc::new(skeleton));
        Ok(())
    }
}
