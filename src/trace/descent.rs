//! Descents: beams go down the hierarchy level by level, and what many of them would ask again, each asks only once.
//!
//! A bundle whose beam meets more than it should be asked of is divided before it has gone all the way down: its halves go on
//! from the nodes that it has met. Source: Reshetov, Soupikov and Hurley 2005, entry points for beams of rays.

use super::beam::Beam;
use super::bits::{bits, ones};
use super::hierarchy::{BRANCHES, Hierarchy};
use crate::field::{Level, Task, run_at};
use std::ops::ControlFlow;

/// What a beam has met on its way down.
#[derive(Default)]
pub(super) struct Descent {
    /// Nodes whose boxes are still to be asked.
    open: Vec<u32>,
    /// Nodes with parts that were met.
    leaves: Vec<u32>,
    /// The parts that were met, with where.
    pub met: Vec<(f64, u32)>,
    next: Vec<u32>,
}

impl Descent {
    /// Goes down from `nodes`, which the beam may meet before `limit`; stops where it meets more than `most` nodes and parts on
    /// one level. Gives whether it came all the way down.
    pub fn go(&mut self, step: &Step, nodes: impl Iterator<Item = u32>, most: usize) -> bool {
        self.open.clear();
        self.leaves.clear();
        self.met.clear();
        self.open.extend(nodes);
        while !self.open.is_empty() {
            let descent = &mut *self;
            run_at(step.level, Down { descent, step });
            std::mem::swap(&mut self.open, &mut self.next);
            if self.open.len() + self.met.len() > most && !self.open.is_empty() {
                return false;
            }
        }
        true
    }

    /// The nodes below which everything lies that the beam may meet.
    pub fn nodes(&self) -> impl Iterator<Item = u32> {
        self.leaves.iter().chain(&self.open).copied()
    }
}

/// Asks whether a beam may enter the box of a part: down to the first of them, not along all ways.
pub(super) struct Meets<'a> {
    /// The hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// The rays, however far they go.
    pub beam: &'a Beam,
}

impl Task for Meets<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        self.hierarchy.visit(
            |boxes| self.beam.entered(boxes, f64::INFINITY),
            |_, _| ControlFlow::Break(()),
        )
    }
}

/// What is needed to go down.
pub(super) struct Step<'a> {
    /// The hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// The rays.
    pub beam: &'a Beam,
    /// How far they go.
    pub limit: f64,
    /// The instructions of lanes.
    pub level: Level,
}

/// Goes down by one level.
struct Down<'a, 's> {
    descent: &'a mut Descent,
    step: &'a Step<'s>,
}

impl Task for Down<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Descent {
            open,
            leaves,
            met,
            next,
        } = self.descent;
        next.clear();
        for number in open.iter() {
            let node = self.step.hierarchy.node(*number);
            let entered = self.step.beam.entered(&node.boxes, self.step.limit);
            let before = met.len();
            let found = bits(|k| entered[k] < f64::INFINITY);
            for k in ones(found & ((1 << node.count) - 1)) {
                let k = k % BRANCHES;
                if node.has_parts {
                    met.push((entered[k], node.inside[k]));
                } else {
                    next.push(node.inside[k]);
                }
            }
            if met.len() > before {
                leaves.push(*number);
            }
        }
    }
}
