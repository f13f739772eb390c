//! Areas: rectangles of pixels.

/// The pixels from the upper left one at `corner` (column and row) up to, but not with, those at `end`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Area {
    /// The first column and row.
    pub corner: [u32; 2],
    /// The column and row after the last; not before `corner`.
    pub end: [u32; 2],
}

impl Area {
    /// A whole picture.
    pub fn of(size: [u32; 2]) -> Self {
        Self {
            corner: [0; 2],
            end: size,
        }
    }

    /// The width and height.
    pub fn size(&self) -> [u32; 2] {
        [0, 1].map(|axis| self.end[axis] - self.corner[axis])
    }

    /// How many pixels there are.
    pub fn pixels(&self) -> usize {
        let [width, height] = self.size();
        width as usize * height as usize
    }

    /// Whether that pixel is one of them.
    pub fn has(&self, pixel: [u32; 2]) -> bool {
        (0..2).all(|axis| (self.corner[axis]..self.end[axis]).contains(&pixel[axis]))
    }

    /// Squares with this side that cover it, in rows; those at the right and lower edge may be smaller rectangles.
    ///
    /// # Panics
    /// If the side is 0.
    pub fn squares(&self, side: u32) -> impl Iterator<Item = Self> + use<> {
        let Self { corner, end } = *self;
        let steps = move |axis: usize| (corner[axis]..end[axis]).step_by(side as usize);
        let corners = steps(1).flat_map(move |y| steps(0).map(move |x| [x, y]));
        corners.map(move |corner| Self {
            corner,
            end: [0, 1].map(|axis| end[axis].min(corner[axis].saturating_add(side))),
        })
    }
}
