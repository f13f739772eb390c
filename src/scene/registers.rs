//! Registers for lists of steps: each is used again once nothing needs the value in it (a linear scan).

use super::graph::Id;

/// Gives registers to values, step by step.
pub(super) struct Registers {
    /// The last step that reads each value; beyond all steps where it is wanted in the end.
    last_use: Vec<usize>,
    /// The register of each value.
    held: Vec<Id>,
    /// Registers whose values have ended; the last is used first.
    free: Vec<Id>,
    count: usize,
}

impl Registers {
    /// For that many values, none of which has a register yet. `reads` says which of them each step reads, in the order of the
    /// steps, `wanted` which are wanted after all steps. The first registers, `taken` of them, are given by [`Registers::put`]
    /// alone until their values end.
    pub fn new<R: AsRef<[Id]>>(
        values: usize,
        reads: impl Iterator<Item = R>,
        wanted: &[Id],
        taken: usize,
    ) -> Self {
        let mut last_use = vec![0; values];
        for (step, read) in reads.enumerate() {
            read.as_ref()
                .iter()
                .for_each(|id| last_use[id.index()] = step);
        }
        wanted
            .iter()
            .for_each(|id| last_use[id.index()] = usize::MAX);
        Self {
            last_use,
            held: vec![Id::at(0); values],
            free: Vec::new(),
            count: taken,
        }
    }

    /// Says that a value is in this register already.
    pub fn put(&mut self, value: Id, register: usize) {
        self.held[value.index()] = Id::at(register);
    }

    /// Frees the registers of those values that this step is the last to read.
    pub fn end(&mut self, step: usize, read: &[Id]) {
        let ended = read.iter().filter(|id| self.last_use[id.index()] == step);
        let mut ended: Vec<Id> = ended.map(|id| self.held[id.index()]).collect();
        ended.sort_unstable();
        ended.dedup();
        self.free.extend(ended);
    }

    /// A register for a value that is new.
    pub fn take(&mut self, value: Id) -> Id {
        let register = self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            Id::at(self.count - 1)
        });
        self.held[value.index()] = register;
        register
    }

    /// The register of a value that has one.
    pub fn of(&self, value: Id) -> Id {
        self.held[value.index()]
    }

    /// How many registers there are so far.
    pub fn count(&self) -> usize {
        self.count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_are_used_again_when_their_values_end() {
        // Value 2 is read once more after value 3 is made of 0 and 2; 1 is wanted in the end.
        let reads: [&[usize]; 5] = [&[], &[], &[0, 0], &[0, 2], &[2, 3]];
        let reads = reads.map(|ids| ids.iter().map(|i| Id::at(*i)).collect::<Vec<Id>>());
        let mut registers = Registers::new(5, reads.iter(), &[Id::at(1), Id::at(4)], 0);
        let mut given = Vec::new();
        for (step, read) in reads.iter().enumerate() {
            registers.end(step, read);
            given.push(registers.take(Id::at(step)).index());
        }
        // 3 takes the place of 0; of 2 and 3, which end together, the later register is used first.
        assert_eq!(given, [0, 1, 2, 0, 2]);
        assert_eq!(registers.count(), 3);
    }

    #[test]
    fn a_value_that_is_there_already_makes_room_when_it_ends() {
        let reads = [vec![], vec![Id::at(0)], vec![Id::at(1)]];
        let mut registers = Registers::new(3, reads.iter(), &[Id::at(2)], 3);
        registers.put(Id::at(0), 1);
        registers.end(1, &reads[1]);
        assert_eq!(registers.take(Id::at(1)).index(), 1);
        registers.put(Id::at(2), 0);
        assert_eq!((registers.of(Id::at(2)).index(), registers.count()), (0, 3));
    }
}
