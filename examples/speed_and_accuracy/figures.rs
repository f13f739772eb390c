//! The figures of studies, by name: what stands in the text as `{{study|panel|series|place}}`, or two of them with ` / ` between
//! for their ratio.

use crate::Outcome;
use fieldstone::output::short;
use std::path::Path;

/// A point of a study: panel, series, place and value.
type Row = (String, String, f64, f64);

/// The figures of all studies that were read.
#[derive(Debug, Default)]
pub struct Figures(Vec<(String, Row)>);

impl Figures {
    /// Reads the figures of a study.
    ///
    /// # Errors
    /// If the file cannot be read, or is no table of a study.
    pub fn read(&mut self, study: &str, path: &Path) -> Outcome<()> {
        for record in csv::Reader::from_path(path)?.records() {
            self.0.push((study.into(), record?.deserialize(None)?));
        }
        Ok(())
    }

    /// The text with figures in the place of their names.
    ///
    /// # Errors
    /// If a name is that of no figure.
    pub fn filled(&self, text: &str) -> Outcome<String> {
        let mut parts = text.split("{{");
        let mut filled = parts.next().unwrap_or_default().to_string();
        for part in parts {
            let (name, rest) = part.split_once("}}").ok_or("a place that does not end")?;
            filled.push_str(&self.figure(name)?);
            filled.push_str(rest);
        }
        Ok(filled)
    }

    fn figure(&self, name: &str) -> Outcome<String> {
        let value = match name.split_once(" / ") {
            Some((a, b)) => self.value(a)? / self.value(b)?,
            None => self.value(name)?,
        };
        Ok(brief(value))
    }

    fn value(&self, name: &str) -> Outcome<f64> {
        let words: Vec<&str> = name.split('|').map(str::trim).collect();
        let [study, panel, series, x] = words[..] else {
            return Err(format!("`{name}` is no figure's name").into());
        };
        let x: f64 = x.parse()?;
        let is_it = |(of, row): &&(String, Row)| {
            of == study && row.0 == panel && row.1 == series && row.2 == x
        };
        let found = self.0.iter().find(is_it);
        let (_, row) = found.ok_or(format!("there is no figure `{name}`"))?;
        Ok(row.3)
    }
}

/// A figure with three digits at least, as far as they say something.
pub fn brief(x: f64) -> String {
    let text = match x {
        x if x >= 100.0 => return format!("{x:.0}"),
        x if x >= 10.0 => format!("{x:.1}"),
        x if x >= 1.0 || x == 0.0 => format!("{x:.2}"),
        x => return short(x),
    };
    text.trim_end_matches('0').trim_end_matches('.').into()
}
