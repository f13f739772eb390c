//! Numbers of rows, and columns that are read and written there: neighbours in one piece, others one by one.

use std::ops::Range;

/// The numbers of some rows, in any order.
#[derive(Clone, Debug)]
pub struct Rows<'a> {
    numbers: &'a [u32],
    /// Whether each is larger than the one before: then the ends of some tell whether they are neighbours.
    is_in_order: bool,
    /// The range that they are, if each follows the one before.
    run: Option<Range<usize>>,
}

/// So many neighbours are looked for among others.
const SOME: usize = 8;

impl<'a> Rows<'a> {
    /// Rows with these numbers.
    #[inline(always)]
    pub fn of(numbers: &'a [u32]) -> Self {
        // All are asked: a loop without an early end compares many at once.
        let mut others = 0;
        for (a, b) in numbers.iter().zip(numbers.iter().skip(1)) {
            others |= u32::from(a >= b);
        }
        if others == 0 {
            return Self::in_order(numbers);
        }
        Self {
            numbers,
            is_in_order: false,
            run: None,
        }
    }

    /// Rows with these numbers, each larger than the one before.
    #[inline(always)]
    pub fn in_order(numbers: &'a [u32]) -> Self {
        debug_assert!(numbers.is_sorted_by(|a, b| a < b), "rows are in order");
        let ends = numbers.first().zip(numbers.last());
        let run = ends.map_or(0..0, |(a, b)| *a as usize..*b as usize + 1);
        Self {
            numbers,
            is_in_order: true,
            run: (run.len() == numbers.len()).then_some(run),
        }
    }

    /// Copies what a column has there to the beginning of another one.
    ///
    /// # Panics
    /// If a column is too short.
    #[inline(always)]
    pub fn take<T: Copy>(&self, column: &[T], taken: &mut [T]) {
        let taken = &mut taken[..self.numbers.len()];
        if let Some(run) = self.run.clone() {
            return taken.copy_from_slice(&column[run]);
        }
        let (some_taken, rest) = taken.as_chunks_mut::<SOME>();
        let (some_numbers, others) = self.numbers.as_chunks::<SOME>();
        for (taken, numbers) in some_taken.iter_mut().zip(some_numbers) {
            let first = numbers[0] as usize;
            if self.is_in_order && numbers[SOME - 1] as usize - first == SOME - 1 {
                taken.copy_from_slice(&column[first..first + SOME]);
            } else {
                gather(column, numbers, taken);
            }
        }
        gather(column, others, rest);
    }

    /// Copies values, one for each row, to where they belong in a column; of those for the same row the last.
    ///
    /// # Panics
    /// If the column is too short, or there are fewer values.
    #[inline(always)]
    pub fn put<T: Copy>(&self, column: &mut [T], values: &[T]) {
        let values = &values[..self.numbers.len()];
        if let Some(run) = self.run.clone() {
            return column[run].copy_from_slice(values);
        }
        for (number, value) in self.numbers.iter().zip(values) {
            column[*number as usize] = *value;
        }
    }

    /// Adds numbers, one for each row, to those of a column; to a row that is there several times all of its numbers.
    ///
    /// # Panics
    /// If the column is too short, or there are fewer numbers.
    #[inline(always)]
    pub fn add(&self, column: &mut [f64], numbers: &[f64]) {
        let numbers = &numbers[..self.numbers.len()];
        if let Some(run) = self.run.clone() {
            for (sum, number) in column[run].iter_mut().zip(numbers) {
                *sum += number;
            }
            return;
        }
        for (row, number) in self.numbers.iter().zip(numbers) {
            column[*row as usize] += number;
        }
    }

    /// Gives all of these rows the same value.
    ///
    /// # Panics
    /// If the column is too short.
    pub fn fill<T: Copy>(&self, column: &mut [T], value: T) {
        match self.run.clone() {
            Some(run) => column[run].fill(value),
            None => {
                for number in self.numbers {
                    column[*number as usize] = value;
                }
            }
        }
    }
}

/// Copies what a column has at these rows, one by one.
#[inline(always)]
fn gather<T: Copy>(column: &[T], numbers: &[u32], taken: &mut [T]) {
    for (value, number) in taken.iter_mut().zip(numbers) {
        *value = column[*number as usize];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_read_and_written_at_the_rows() {
        let column: Vec<f64> = (0..20).map(f64::from).collect();
        let whole: Vec<u32> = (0..20).collect();
        let lists: [&[u32]; 9] = [
            &[],
            &[7],
            &[4, 5, 6],
            &[6, 5, 4],
            &[3, 3, 5],
            &[2, 9],
            &[0, 1, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 19],
            &[9, 2, 3, 4, 5, 6, 7, 16, 1],
            &whole,
        ];
        for numbers in lists {
            let mut rows = Rows::of(numbers);
            if numbers.is_sorted_by(|a, b| a < b) {
                assert_eq!(rows.run, Rows::in_order(numbers).run);
                rows = Rows::in_order(numbers);
            }
            let mut taken = [-1.0; 20];
            rows.take(&column, &mut taken);
            let expected = |k: usize| numbers.get(k).map_or(-1.0, |number| f64::from(*number));
            assert_eq!(taken, std::array::from_fn(expected));

            let values: Vec<f64> = (0..20).map(|k| 100.0 + f64::from(k)).collect();
            let [mut put, mut added, mut filled] = [(); 3].map(|()| column.clone());
            rows.put(&mut put, &values);
            rows.add(&mut added, &values);
            rows.fill(&mut filled, 0.5);
            for (i, before) in column.iter().enumerate() {
                let here = numbers.iter().zip(&values);
                let here = here.filter(|(number, _)| **number as usize == i);
                let here: Vec<f64> = here.map(|(_, value)| *value).collect();
                assert_eq!(put[i], *here.last().unwrap_or(before));
                assert_eq!(added[i], before + here.iter().sum::<f64>());
                assert_eq!(filled[i], if here.is_empty() { *before } else { 0.5 });
            }
        }
    }
}
