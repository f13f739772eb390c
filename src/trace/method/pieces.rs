//! Pieces of a ray that are still to be looked at, from near to far: what methods by ranges share. The reference, which
//! judges them, keeps pieces of its own.

use super::Segment;

/// The open pieces of a segment.
pub(super) struct Pieces {
    /// The nearest last.
    stack: Vec<(f64, f64)>,
    /// What is known of the scene's size; 1 where nothing is.
    size: f64,
}

impl Pieces {
    /// How many sizes of what is known a ray without an end is followed before it is given up.
    const FAR: f64 = (1u64 << 30) as f64;

    /// The whole segment as one piece.
    pub fn of(segment: &Segment) -> Self {
        let size = segment.size.max(segment.footprint.at_origin);
        Self {
            stack: vec![(segment.start, segment.end)],
            size: if size > 0.0 { size } else { 1.0 },
        }
    }

    /// The nearest piece.
    pub fn nearest(&self) -> (f64, f64) {
        self.stack.last().copied().unwrap_or_default()
    }

    /// Where it is cut: in the middle, and a piece without an end where it has doubled.
    pub fn middle(&self) -> f64 {
        let (from, to) = self.nearest();
        if to.is_finite() {
            from + 0.5 * (to - from)
        } else {
            2.0 * from.max(self.size)
        }
    }

    /// Whether it has no end, and begins farther away than a ray is followed.
    pub fn is_too_far(&self) -> bool {
        let (from, to) = self.nearest();
        to.is_infinite() && from > Self::FAR * self.size
    }

    /// Cuts it.
    pub fn cut(&mut self) {
        let ((from, to), middle) = (self.nearest(), self.middle());
        self.stack.pop();
        self.stack.push((middle, to));
        self.stack.push((from, middle));
    }

    /// Keeps one half of it: the far or the near one.
    pub fn keep(&mut self, is_far: bool) {
        let ((from, to), middle) = (self.nearest(), self.middle());
        self.stack.pop();
        self.stack
            .push(if is_far { (middle, to) } else { (from, middle) });
    }

    /// Puts another one before it.
    pub fn precede(&mut self, piece: (f64, f64)) {
        self.stack.push(piece);
    }

    /// Leaves it behind; gives whether it was the last.
    pub fn pass(&mut self) -> bool {
        self.stack.pop();
        self.stack.is_empty()
    }
}
