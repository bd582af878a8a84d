//! Why a descriptor is refused, and where.

/// A report descriptor that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("report descriptor, byte {at}: {fault}")]
pub struct DescriptorError {
    /// Offset of the item.
    pub at: usize,
    /// What is wrong with it.
    pub fault: DescriptorFault,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DescriptorFault {
    /// More than the format allows.
    #[error("expected at most {most} bytes, found {found}")]
    TooLong {
        /// Allowed.
        most: usize,
        /// There.
        found: usize,
    },
    /// The last item is cut off.
    #[error("an item of {needed} bytes begins here, but only {left} are left")]
    CutOff {
        /// With its head.
        needed: usize,
        /// There.
        left: usize,
    },
    /// End Collection without a collection.
    #[error("a collection ends here that was never begun")]
    EndWithoutCollection,
    /// The descriptor ends inside collections.
    #[error("the descriptor ends with {open} collections still open")]
    OpenCollections {
        /// How many.
        open: usize,
    },
    /// Pop without Push.
    #[error("Pop without Push")]
    PopWithoutPush,
    /// Nested too deeply.
    #[error("more than {most} {what} inside one another")]
    TooDeep {
        /// Collections or pushes.
        what: &'static str,
        /// Allowed.
        most: usize,
    },
    /// Report ids are 1 to 255.
    #[error("expected a report id of 1 to 255, found {found}")]
    ReportId {
        /// There.
        found: u32,
    },
    /// Fields before the first report id belong to no report.
    #[error("a report id comes after fields without one: such reports cannot be told apart")]
    LateReportId,
    /// A field wider than anything known.
    #[error("expected a report size of at most {most} bits, found {found}")]
    ReportSize {
        /// Allowed.
        most: u32,
        /// There.
        found: u32,
    },
    /// A report longer than anything known.
    #[error("the report grows to {bits} bits here, more than {most} bytes hold")]
    ReportLength {
        /// There.
        bits: u64,
        /// Allowed.
        most: u32,
    },
    /// Too many fields.
    #[error("more than {most} fields")]
    TooManyFields {
        /// Allowed.
        most: usize,
    },
    /// Delimiters are opened and closed in turn.
    #[error("a delimiter is {found} here that is already so")]
    Delimiter {
        /// Opened or closed.
        found: &'static str,
    },
    /// A range that falls.
    #[error("{what} falls from {from} to {to}")]
    Falls {
        /// Logical range or usage range.
        what: &'static str,
        /// Minimum.
        from: i64,
        /// Maximum.
        to: i64,
    },
}
