//! Tables of numbers, column by column in one piece of memory.

use super::{F64x32, Rows};
use std::{array, mem};

/// The room of columns is a multiple of this, so that lanes need not stop at their ends.
const LANES: usize = F64x32::WIDTH;

/// `N` columns of one length.
#[derive(Clone, Debug)]
pub struct Columns<const N: usize> {
    /// The columns one after the other, each with the room that all of them have.
    numbers: Vec<f64>,
    room: usize,
    rows: usize,
}

impl<const N: usize> Columns<N> {
    /// No rows, with room for as many.
    pub fn with_capacity(rows: usize) -> Self {
        let room = rows.next_multiple_of(LANES);
        Self {
            numbers: vec![0.0; N * room],
            room,
            rows: 0,
        }
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Column number `k`.
    #[inline(always)]
    pub fn column(&self, k: usize) -> &[f64] {
        &self.numbers[k * self.room..][..self.rows]
    }

    /// Column number `k`, to be written.
    pub fn column_mut(&mut self, k: usize) -> &mut [f64] {
        &mut self.numbers[k * self.room..][..self.rows]
    }

    /// Row number `i`.
    ///
    /// # Panics
    /// If there are fewer.
    #[inline]
    pub fn row(&self, i: usize) -> [f64; N] {
        assert!(i < self.rows, "there are so many rows");
        array::from_fn(|k| self.numbers[k * self.room + i])
    }

    /// All columns.
    #[inline(always)]
    pub fn columns(&self) -> [&[f64]; N] {
        self.up_to(self.rows)
    }

    /// All columns up to a multiple of the lanes of [`F64x32`]: behind the last is whatever was there.
    #[inline(always)]
    pub fn lanes(&self) -> [&[f64]; N] {
        self.up_to(self.rows.next_multiple_of(LANES))
    }

    /// All columns up to this row.
    #[inline(always)]
    fn up_to(&self, end: usize) -> [&[f64]; N] {
        let mut columns = [&self.numbers[..0]; N];
        for (k, column) in columns.iter_mut().enumerate() {
            *column = &self.numbers[k * self.room..][..end];
        }
        columns
    }

    /// All columns, to be written.
    pub fn columns_mut(&mut self) -> [&mut [f64]; N] {
        let (room, rows) = (self.room, self.rows);
        let mut rest = &mut self.numbers[..];
        array::from_fn(|_| {
            let (column, others) = mem::take(&mut rest).split_at_mut(room);
            rest = others;
            &mut column[..rows]
        })
    }

    /// Makes it so many rows of the same number.
    pub fn fill(&mut self, rows: usize, number: f64) {
        self.resize(rows);
        for column in self.columns_mut() {
            column.fill(number);
        }
    }

    /// Makes it so many rows, of whatever was there.
    pub fn resize(&mut self, rows: usize) {
        self.rows = self.rows.min(rows);
        self.grow(rows - self.rows);
    }

    /// Adds a row.
    pub fn push(&mut self, row: [f64; N]) {
        self.grow(1);
        for (k, number) in row.into_iter().enumerate() {
            self.numbers[k * self.room + self.rows - 1] = number;
        }
    }

    /// Adds these rows of other columns.
    ///
    /// # Panics
    /// If a column is too short.
    pub fn pick(&mut self, columns: [&[f64]; N], rows: &[u32]) {
        let first = self.rows;
        self.grow(rows.len());
        let rows = Rows::of(rows);
        for (target, source) in self.columns_mut().into_iter().zip(columns) {
            rows.take(source, &mut target[first..]);
        }
    }

    /// Adds the rows of other columns.
    ///
    /// # Panics
    /// If the columns differ in length.
    pub fn append(&mut self, columns: [&[f64]; N]) {
        let first = self.rows;
        self.grow(columns.first().map_or(0, |column| column.len()));
        for (target, source) in self.columns_mut().into_iter().zip(columns) {
            target[first..].copy_from_slice(source);
        }
    }

    /// Adds rows of zeros, or of whatever was there.
    fn grow(&mut self, more: usize) {
        let rows = self.rows + more;
        if rows > self.room {
            let mut larger = Self::with_capacity(rows.max(2 * self.room));
            larger.rows = self.rows;
            for (target, source) in larger.columns_mut().into_iter().zip(self.columns()) {
                target.copy_from_slice(source);
            }
            *self = larger;
        }
        self.rows = rows;
    }
}

impl<const N: usize> Default for Columns<N> {
    fn default() -> Self {
        Self::with_capacity(0)
    }
}

impl<const N: usize> PartialEq for Columns<N> {
    fn eq(&self, other: &Self) -> bool {
        self.columns() == other.columns()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stay_together_while_columns_grow() {
        let mut columns = Columns::<3>::default();
        let row = |i: usize| [0.0, 1.0, 2.0].map(|k| 10.0 * i as f64 + k);
        (0..100).for_each(|i| columns.push(row(i)));
        let mut some = Columns::<3>::with_capacity(1);
        some.pick(columns.columns(), &[7, 99, 3]);
        some.pick(columns.columns(), &[50]);
        some.append(columns.columns().map(|column| &column[20..22]));
        for (place, i) in [7, 99, 3, 50, 20, 21].into_iter().enumerate() {
            let found: [f64; 3] = array::from_fn(|k| some.column(k)[place]);
            assert_eq!(found, row(i));
        }
        assert_eq!((columns.len(), some.len()), (100, 6));
        let mut others = Columns::<3>::default();
        others.pick(columns.columns(), &[]);
        others.pick(columns.columns(), &[40, 41, 42]);
        others.pick(columns.columns(), &[5, 5, 6]);
        for (place, i) in [40, 41, 42, 5, 5, 6].into_iter().enumerate() {
            assert_eq!(others.row(place), row(i));
        }
        assert_eq!(others.len(), 6);
        some.resize(2);
        some.append(columns.columns().map(|column| &column[..1]));
        assert_eq!((some.len(), some.row(1), some.row(2)), (3, row(99), row(0)));
        let lanes = some.lanes();
        assert!(lanes.iter().all(|lanes| lanes.len() == 32));
        assert_eq!(lanes.map(|lanes| lanes[2]), row(0));
        assert!(
            Columns::<2>::default()
                .lanes()
                .iter()
                .all(|lanes| lanes.is_empty())
        );
        some.fill(2, 0.5);
        assert_eq!(
            (some.len(), some.row(0), some.row(1)),
            (2, [0.5; 3], [0.5; 3])
        );
    }
}
