//! Numbers of rows, and columns that are read and written there: neighbours in one piece, others one by one.

use std::ops::Range;

/// The numbers of some rows, in any order.
#[derive(Clone, Debug)]
pub struct Rows<'a> {
    numbers: &'a [u32],
    /// The range that they are, if each follows the one before.
    run: Option<Range<usize>>,
}

impl<'a> Rows<'a> {
    /// Rows with these numbers.
    #[inline(always)]
    pub fn of(numbers: &'a [u32]) -> Self {
        let rows = Self::between_ends(numbers);
        let first = numbers.first().map_or(0, |number| *number);
        // All are asked: a loop without an early end compares many at once.
        let mut others = 0;
        for (expected, number) in (first..).zip(numbers) {
            others |= expected ^ number;
        }
        let run = rows.run.filter(|_| others == 0);
        Self { numbers, run }
    }

    /// Rows with these numbers, each larger than the one before: then the ends tell whether they are neighbours.
    #[inline(always)]
    pub fn in_order(numbers: &'a [u32]) -> Self {
        debug_assert!(numbers.is_sorted_by(|a, b| a < b), "rows are in order");
        Self::between_ends(numbers)
    }

    /// Neighbours, if there are as many as between the ends.
    #[inline(always)]
    fn between_ends(numbers: &'a [u32]) -> Self {
        let ends = numbers.first().zip(numbers.last());
        let run = ends.map_or(0..0, |(a, b)| *a as usize..*b as usize + 1);
        Self {
            numbers,
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
        match self.run.clone() {
            Some(run) => taken.copy_from_slice(&column[run]),
            None => {
                for (value, number) in taken.iter_mut().zip(self.numbers) {
                    *value = column[*number as usize];
                }
            }
        }
    }

    /// Copies values, one for each row, to where they belong in a column; of those for the same row the last.
    ///
    /// # Panics
    /// If the column is too short, or there are fewer values.
    #[inline(always)]
    pub fn put<T: Copy>(&self, column: &mut [T], values: &[T]) {
        match self.run.clone() {
            Some(run) => column[run].copy_from_slice(&values[..self.numbers.len()]),
            None => self.each(column, values, |place, value| *place = value),
        }
    }

    /// Adds numbers, one for each row, to those of a column.
    ///
    /// # Panics
    /// If the column is too short, or there are fewer numbers.
    #[inline(always)]
    pub fn add(&self, column: &mut [f64], numbers: &[f64]) {
        self.each(column, numbers, |sum, number| *sum += number);
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

    #[inline(always)]
    fn each<T: Copy>(&self, column: &mut [T], values: &[T], change: impl Fn(&mut T, T)) {
        let values = &values[..self.numbers.len()];
        match self.run.clone() {
            Some(run) => {
                for (place, value) in column[run].iter_mut().zip(values) {
                    change(place, *value);
                }
            }
            None => {
                for (number, value) in self.numbers.iter().zip(values) {
                    change(&mut column[*number as usize], *value);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_read_and_written_at_the_rows() {
        let column: Vec<f64> = (0..20).map(f64::from).collect();
        let whole: Vec<u32> = (0..20).collect();
        let lists: [&[u32]; 7] = [
            &[],
            &[7],
            &[4, 5, 6],
            &[6, 5, 4],
            &[3, 3, 5],
            &[2, 9],
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
