//! The matrix of limits and methods, as a table in Markdown.

use crate::lang::Judgement;
use crate::scene::Method;
use std::fmt;

/// How a method fares at a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell {
    /// All rays find what they should, in at most so many steps.
    Right(u32),
    /// Some ray does not find out; the others are right.
    Unknown,
    /// A surface at a wrong distance, off by this, in scene units.
    Off(f64),
    /// A surface where there is none.
    FalseHit,
    /// No surface where there is one.
    FalseMiss,
    /// Something else that is expected is not so.
    Failed,
    /// The script is refused, as it should be.
    Refused,
    /// The script should be refused, and is not.
    Accepted,
}

/// What a cell counts as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Right,
    Unknown,
    Wrong,
}

impl Cell {
    /// The worst of how the rays fared: one that passes through a surface is worse than one that stops where nothing is, and
    /// that is worse than one that is off.
    pub fn of<'a>(judgements: impl Iterator<Item = &'a Judgement>, steps: u32) -> Self {
        let cells = judgements.map(|judgement| match judgement {
            Judgement::Right => Self::Right(steps),
            Judgement::Off(by) => Self::Off(*by),
            Judgement::FalseHit => Self::FalseHit,
            Judgement::FalseMiss => Self::FalseMiss,
            Judgement::Unknown => Self::Unknown,
            Judgement::Failed => Self::Failed,
        });
        cells.fold(Self::Right(steps), Self::worse)
    }

    fn worse(self, other: Self) -> Self {
        match (self, other) {
            (Self::Off(a), Self::Off(b)) => Self::Off(a.max(b)),
            (a, b) if b.rank() > a.rank() => b,
            (a, _) => a,
        }
    }

    fn rank(self) -> u8 {
        match self {
            Self::Right(_) | Self::Refused => 0,
            Self::Unknown => 1,
            Self::Failed => 2,
            Self::Off(_) => 3,
            Self::FalseHit => 4,
            Self::FalseMiss | Self::Accepted => 5,
        }
    }

    fn outcome(self) -> Outcome {
        match self {
            Self::Right(_) | Self::Refused => Outcome::Right,
            Self::Unknown => Outcome::Unknown,
            _ => Outcome::Wrong,
        }
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Right(steps) => write!(f, "ok {steps}"),
            Self::Unknown => f.write_str("unknown"),
            Self::Off(by) => write!(f, "**wrong {by:.0e}**"),
            Self::FalseHit => f.write_str("**hit!**"),
            Self::FalseMiss => f.write_str("**miss!**"),
            Self::Failed => f.write_str("**failed**"),
            Self::Refused => f.write_str("refused"),
            Self::Accepted => f.write_str("**accepted!**"),
        }
    }
}

/// A row of the matrix.
#[derive(Clone, Debug)]
pub struct Limit {
    /// Its number in the catalogue of failures.
    pub number: u32,
    /// Its name.
    pub name: String,
    /// A cell for each method; none where it is no matter of rays.
    pub cells: Vec<Cell>,
    /// Where else it is tested.
    pub see: Option<String>,
}

/// The matrix.
pub struct Matrix {
    methods: Vec<Method>,
    limits: Vec<Limit>,
}

const LEGEND: &str = "\
- `ok 12`: every ray of the script finds what it should, to within a tenth of a pixel or closer; the longest took 12 steps. Surfaces that
  are entered in closed form take none.
- `unknown`: some ray says that it does not know; the others are right.
- `wrong 3e-2`: some ray stops at a wrong distance, off by so many scene units; `hit!`: it stops where nothing is; `miss!`: it
  passes through a surface; `failed`: something else is not as expected.
- `refused`: the script is refused with a reason, as it should be.
";

impl Matrix {
    /// The matrix of these rows, whose cells are in the order of the methods.
    pub fn new(methods: Vec<Method>, limits: Vec<Limit>) -> Self {
        Self { methods, limits }
    }

    /// The names of the limits that a method is wrong at; none where it is not in the matrix.
    pub fn wrong_by(&self, method: Method) -> Vec<String> {
        let Some(column) = self.methods.iter().position(|m| *m == method) else {
            return Vec::new();
        };
        let is_wrong = |limit: &&Limit| {
            let cell = limit.cells.get(column);
            cell.is_some_and(|cell| cell.outcome() == Outcome::Wrong)
        };
        let wrong = self.limits.iter().filter(is_wrong);
        wrong
            .map(|limit| format!("{} ({})", limit.number, limit.name))
            .collect()
    }

    /// A line that counts for each method the limits with an outcome.
    fn summary(&self, name: &str, outcome: Outcome) -> String {
        let count = |column: usize| {
            let cells = self
                .limits
                .iter()
                .filter_map(|limit| limit.cells.get(column));
            cells.filter(|cell| cell.outcome() == outcome).count()
        };
        let counts = (0..self.methods.len()).map(|column| format!("**{}**", count(column)));
        row("", &format!("**{name}**"), counts)
    }
}

fn row(number: &str, name: &str, cells: impl Iterator<Item = String>) -> String {
    let cells: String = cells.map(|cell| format!(" {cell} |")).collect();
    format!("| {number} | {name} |{cells}\n")
}

impl fmt::Display for Matrix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("# Where methods fail\n\n")?;
        f.write_str("One script each; printed by `fieldstone limits`.\n\n")?;
        writeln!(f, "{LEGEND}")?;
        let names = self.methods.iter().map(|m| format!("`{}`", m.name()));
        f.write_str(&row("", "limit", names))?;
        f.write_str(&row(
            "--:",
            "---",
            self.methods.iter().map(|_| "---".into()),
        ))?;
        let (here, elsewhere): (Vec<&Limit>, Vec<&Limit>) =
            self.limits.iter().partition(|limit| limit.see.is_none());
        for limit in here {
            let cells = limit.cells.iter().map(ToString::to_string);
            f.write_str(&row(&limit.number.to_string(), &limit.name, cells))?;
        }
        f.write_str(&self.summary("right", Outcome::Right))?;
        f.write_str(&self.summary("unknown", Outcome::Unknown))?;
        f.write_str(&self.summary("wrong", Outcome::Wrong))?;
        if elsewhere.is_empty() {
            return Ok(());
        }
        f.write_str("\nWhat is no matter of single rays is tested elsewhere:\n\n")?;
        for limit in elsewhere {
            let place = limit.see.as_deref().unwrap_or_default();
            writeln!(f, "- {}, {}: {place}", limit.number, limit.name)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_ray_is_told() {
        use Judgement::{FalseHit, FalseMiss, Off, Right, Unknown};
        let cell = |judgements: &[Judgement]| Cell::of(judgements.iter(), 7).to_string();
        assert_eq!(cell(&[Right, Right]), "ok 7");
        assert_eq!(cell(&[Unknown, Right]), "unknown");
        assert_eq!(cell(&[Off(0.25), Unknown, Off(0.031)]), "**wrong 2e-1**");
        assert_eq!(cell(&[FalseHit, Off(1.0)]), "**hit!**");
        assert_eq!(cell(&[FalseMiss, FalseHit]), "**miss!**");
    }

    #[test]
    fn summaries_count_and_the_wrong_are_named() {
        let limit = |number, cells: &[Cell]| Limit {
            number,
            name: "seam".into(),
            cells: cells.to_vec(),
            see: None,
        };
        let limits = vec![
            limit(3, &[Cell::Right(4), Cell::FalseMiss]),
            limit(4, &[Cell::Unknown, Cell::Off(0.5)]),
        ];
        let matrix = Matrix::new(vec![Method::Auto, Method::Sphere], limits);
        assert!(matrix.wrong_by(Method::Auto).is_empty());
        assert_eq!(matrix.wrong_by(Method::Sphere), ["3 (seam)", "4 (seam)"]);
        let text = matrix.to_string();
        assert!(text.contains("| 3 | seam | ok 4 | **miss!** |\n"), "{text}");
        assert!(
            text.contains("|  | **wrong** | **0** | **2** |\n"),
            "{text}"
        );
    }
}
