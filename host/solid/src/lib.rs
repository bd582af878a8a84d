//! Polygon solids: primitives, revolution, closedness.
