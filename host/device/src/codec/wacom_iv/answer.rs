//! What a tablet answers to the three questions, as text.

/// The questions, in the order they are asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::codec) enum Question {
    /// `~#`: model and ROM version.
    Identity,
    /// `~C`: largest x and y.
    Size,
    /// `~R`: resolution, among other settings.
    Resolution,
}

impl Question {
    /// As it is sent; the first takes no return.
    pub(in crate::codec) fn bytes(self) -> &'static [u8] {
        match self {
            Self::Identity => b"~#",
            Self::Size => b"~C\r",
            Self::Resolution => b"~R\r",
        }
    }

    fn prefix(self) -> &'static str {
        match self {
            Self::Identity => "~#",
            Self::Size => "~C",
            Self::Resolution => "~R",
        }
    }
}

/// Model and version, as in `~#UD-1212-R00,V1.4-0`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::codec) struct Identity {
    /// All of it, without the `~#`.
    pub(in crate::codec) text: String,
    /// Up to the version.
    pub(in crate::codec) model: String,
    /// Major and minor; `None` where none can be read.
    pub(in crate::codec) version: Option<(u32, u32)>,
}

/// An answer understood.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::codec) enum Answer {
    Identity(Identity),
    /// Largest x and y.
    Size([u16; 2]),
    /// Lines per inch.
    Resolution([u16; 2]),
}

/// Reads the answer to `question`; `None` if it is not one. Zeroes are no sizes.
pub(in crate::codec) fn read(question: Question, line: &str) -> Option<Answer> {
    let rest = line.trim().strip_prefix(question.prefix())?;
    let pair = |fields: &[&str]| {
        let [x, y] = fields else { return None };
        let number = |text: &str| text.trim().parse::<u16>().ok().filter(|&n| n > 0);
        Some([number(x)?, number(y)?])
    };
    let fields: Vec<&str> = rest.split(',').collect();
    match question {
        Question::Identity => identity(rest).map(Answer::Identity),
        Question::Size => pair(&fields).map(Answer::Size),
        // Settings in hexadecimal, interval and increment come first.
        Question::Resolution => pair(fields.get(3..5)?).map(Answer::Resolution),
    }
}

/// The version follows the last `V`: a model's name may hold one too.
fn identity(rest: &str) -> Option<Identity> {
    if rest.is_empty() {
        return None;
    }
    let (model, version) = match rest.rsplit_once('V') {
        Some((model, version)) => (model, numbers(version)),
        None => (rest, None),
    };
    let model = model.trim_end_matches([',', ' ']).to_owned();
    Some(Identity {
        text: rest.to_owned(),
        model,
        version,
    })
}

fn numbers(version: &str) -> Option<(u32, u32)> {
    let (major, rest) = version.split_once('.')?;
    let minor = rest.split(|c: char| !c.is_ascii_digit()).next()?;
    Some((major.trim().parse().ok()?, minor.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_and_versions_are_told_apart() {
        let rows = [
            ("~#UD-1212-R00,V1.4-0", "UD-1212-R00", Some((1, 4))),
            ("~#ET-0405-R00 V2.0-10\r", "ET-0405-R00", Some((2, 0))),
            ("~#CT-0045-R00,V1.3-5,", "CT-0045-R00", Some((1, 3))),
            ("~#PL-V550 V1.2", "PL-V550", Some((1, 2))),
            ("~#UD-0608-R", "UD-0608-R", None),
            ("~#UD V?", "UD", None),
        ];
        for (line, model, version) in rows {
            let Some(Answer::Identity(got)) = read(Question::Identity, line) else {
                panic!("{line}")
            };
            assert_eq!((got.model.as_str(), got.version), (model, version), "{line}");
        }
    }

    #[test]
    fn sizes_and_resolutions_are_read_or_refused() {
        let size = |line| read(Question::Size, line);
        assert_eq!(size("~C06144,08448"), Some(Answer::Size([6144, 8448])));
        for line in [
            "~C",
            "~C1",
            "~C0,5",
            "~C1,2,3",
            "~C70000,1",
            "~Cx,y",
            "~R1,2",
            "C1,2",
            "",
        ] {
            assert_eq!(size(line), None, "{line}");
        }
        let resolution = |line| read(Question::Resolution, line);
        assert_eq!(
            resolution("~RE202C900,002,02,1270,1270"),
            Some(Answer::Resolution([1270, 1270]))
        );
        assert_eq!(resolution("~RE202C900,002,02"), None);
        assert_eq!(read(Question::Identity, "~#"), None);
    }
}
