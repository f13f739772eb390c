//! Budgets of steps: what rays may take at most.

use super::console::say_error;
use super::failure::Failure;
use super::steps::Counted;
use super::value;
use crate::output::short;

/// What is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    Mean,
    P99,
    Max,
    Evaluations,
    Unknown,
}

impl Quantity {
    /// All of them, with the names in budgets and in messages.
    const ALL: [(&'static str, &'static str, Self); 5] = [
        ("mean", "steps a ray in the mean", Self::Mean),
        ("p99", "steps that 99 % of the rays don't exceed", Self::P99),
        ("max", "steps of a ray", Self::Max),
        ("evaluations", "evaluations a ray", Self::Evaluations),
        ("unknown", "unknown rays", Self::Unknown),
    ];

    fn of(self, counted: &Counted) -> f64 {
        match self {
            Self::Mean => counted.steps.mean,
            Self::P99 => f64::from(counted.steps.p99),
            Self::Max => f64::from(counted.steps.max),
            Self::Evaluations => counted.evaluations,
            Self::Unknown => counted.unknown as f64,
        }
    }
}

/// What may not be exceeded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    quantity: Quantity,
    most: f64,
}

/// A limit from `name=number`.
///
/// # Errors
/// A sentence on what is wrong with it.
pub fn limit(text: &str) -> Result<Limit, String> {
    let (name, number) = text
        .split_once('=')
        .ok_or("write a name and a number, as in mean=20")?;
    let name = name.trim();
    let known = Quantity::ALL.iter().find(|(word, ..)| *word == name);
    let Some((_, _, quantity)) = known else {
        let names: Vec<&str> = Quantity::ALL.iter().map(|(word, ..)| *word).collect();
        return Err(format!(
            "`{name}` is not counted; write one of {}",
            names.join(", ")
        ));
    };
    let most = value::number(number)?;
    if most < 0.0 {
        return Err(format!("`{number}` is below zero"));
    }
    Ok(Limit {
        quantity: *quantity,
        most,
    })
}

/// Says which limits are exceeded by which methods.
///
/// # Errors
/// If one is.
pub fn hold(limits: &[Limit], all: &[Counted]) -> Result<(), Failure> {
    let mut is_held = true;
    for (limit, counted) in limits
        .iter()
        .flat_map(|limit| all.iter().map(move |counted| (limit, counted)))
    {
        let found = limit.quantity.of(counted);
        if found > limit.most {
            is_held = false;
            let words = Quantity::ALL
                .iter()
                .find(|(.., q)| *q == limit.quantity)
                .map_or("", |(_, words, _)| words);
            let (method, most) = (counted.method.name(), short(limit.most));
            say_error(&format!(
                "{method}: {} {words}, and the budget is {most}",
                short(found)
            ));
        }
    }
    if is_held {
        Ok(())
    } else {
        Err(Failure::Other(String::new()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_have_a_name_and_a_number() {
        assert_eq!(
            limit("p99=80"),
            Ok(Limit {
                quantity: Quantity::P99,
                most: 80.0
            })
        );
        assert_eq!(
            limit(" mean = 2.5"),
            Ok(Limit {
                quantity: Quantity::Mean,
                most: 2.5
            })
        );
        assert!(
            limit("median=3")
                .unwrap_err()
                .contains("mean, p99, max, evaluations, unknown")
        );
        for wrong in ["mean", "mean=", "mean=x", "mean=-1", "=3"] {
            assert!(limit(wrong).is_err(), "{wrong}");
        }
    }
}
