//! Tables: rows of numbers in, rows of cells out, as CSV or JSON.

use super::failure::Failure;
use super::value::number;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// A row of input, and the line that it stands in, from 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<const N: usize> {
    /// The numbers.
    pub values: [f64; N],
    /// The line in its file.
    pub line: u64,
}

/// What `path` is called in messages; `-` is standard input.
pub fn source_name(path: &Path) -> String {
    if is_standard_input(path) {
        "standard input".into()
    } else {
        format!("`{}`", path.display())
    }
}

fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The rows of a CSV file of `N` numbers each; `-` is standard input.
///
/// # Errors
/// If it cannot be read, or a row is not `N` finite numbers: the message names line and column.
pub fn read<const N: usize>(path: &Path) -> Result<Vec<Row<N>>, Failure> {
    let name = source_name(path);
    let input: Box<dyn Read> = if is_standard_input(path) {
        Box::new(io::stdin().lock())
    } else {
        Box::new(File::open(path).map_err(|error| Failure::reading(&name, &error))?)
    };
    rows(input, &name)
}

/// The rows of CSV text. A first row of as many fields, none of which starts like a number, is a header; empty lines and lines that start with `#` are
/// passed over.
fn rows<const N: usize>(input: impl Read, name: &str) -> Result<Vec<Row<N>>, Failure> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(input);
    let mut rows = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| unreadable(name, error))?;
        let line = record.position().map_or(0, csv::Position::line);
        let is_word =
            |field: &str| !field.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        let is_header = index == 0 && record.len() == N && record.iter().all(is_word);
        if !is_header {
            let values = values(&record)
                .map_err(|message| Failure::Other(format!("{name}, line {line}{message}")))?;
            rows.push(Row { values, line });
        }
    }
    Ok(rows)
}

fn unreadable(name: &str, error: csv::Error) -> Failure {
    match error.kind() {
        csv::ErrorKind::Io(error) => Failure::reading(name, error),
        csv::ErrorKind::Utf8 { pos, err } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            let column = err.field() + 1;
            Failure::Other(format!("{name}, line {line}, column {column}: not UTF-8"))
        }
        _ => Failure::Other(format!("cannot read {name}: {error}")),
    }
}

/// The numbers of a record, or where they fail and how.
fn values<const N: usize>(record: &csv::StringRecord) -> Result<[f64; N], String> {
    let found = record.len();
    if found != N {
        return Err(format!(": expected {N} numbers, found {found}"));
    }
    let mut values = [0.0; N];
    for (column, (value, field)) in values.iter_mut().zip(record).enumerate() {
        *value = number(field).map_err(|message| format!(", column {}: {message}", column + 1))?;
    }
    Ok(values)
}

/// A cell of an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A number, with 17 significant digits.
    Number(f64),
    /// A count.
    Count(u32),
    /// A word.
    Text(String),
    /// Nothing.
    Empty,
}

impl Cell {
    /// The cell of a CSV file. What is not finite reads `inf`, `-inf` or `nan`.
    fn to_csv(&self) -> String {
        match self {
            Self::Number(x) => digits(*x),
            Self::Count(n) => n.to_string(),
            Self::Text(text) => quoted(text),
            Self::Empty => String::new(),
        }
    }

    /// The JSON value; null for nothing and for what is not finite.
    fn to_json(&self) -> String {
        match self {
            Self::Number(x) if x.is_finite() => digits(*x),
            Self::Count(n) => n.to_string(),
            Self::Text(text) => serde_json::Value::from(text.as_str()).to_string(),
            Self::Number(_) | Self::Empty => "null".into(),
        }
    }
}

/// The text as a CSV field.
fn quoted(text: &str) -> String {
    if text.contains(['"', ',', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.into()
    }
}

/// The number with 17 significant digits, so that reading it gives the same bits; zeros at the end are left out. Powers
/// of ten below -4 and from 17 on are written with an exponent (as `%.17g` in C).
pub fn digits(x: f64) -> String {
    if x.is_nan() {
        return "nan".into();
    }
    if x.is_infinite() || x == 0.0 {
        return format!("{x}");
    }
    let scientific = format!("{x:.16e}");
    let (mantissa, exponent) = scientific
        .split_once('e')
        .expect("the format has an exponent");
    let power: i32 = exponent.parse().expect("the exponent is a whole number");
    if (-4..17).contains(&power) {
        return without_zeros(&format!("{x:.*}", (16 - power) as usize)).into();
    }
    format!("{}e{power}", without_zeros(mantissa))
}

/// The decimal without zeros at the end of its fraction.
fn without_zeros(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

/// The rows as CSV with a header line.
pub fn to_csv(columns: &[&str], rows: &[Vec<Cell>]) -> String {
    let mut text = columns.join(",");
    text.push('\n');
    for row in rows {
        let cells: Vec<String> = row.iter().map(Cell::to_csv).collect();
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// The rows as a JSON array of objects, an object a line.
pub fn to_json(columns: &[&str], rows: &[Vec<Cell>]) -> String {
    let mut text = String::from("[");
    for (i, row) in rows.iter().enumerate() {
        text.push_str(if i == 0 { "\n" } else { ",\n" });
        let pairs: Vec<String> = columns
            .iter()
            .zip(row)
            .map(|(column, cell)| format!("\"{column}\": {}", cell.to_json()))
            .collect();
        // Writing to a string cannot fail.
        let _ = write!(text, "  {{{}}}", pairs.join(", "));
    }
    text.push_str(if rows.is_empty() { "]\n" } else { "\n]\n" });
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text<const N: usize>(text: &str) -> Result<Vec<[f64; N]>, String> {
        rows(text.as_bytes(), "`p.csv`")
            .map(|rows| rows.iter().map(|row| row.values).collect())
            .map_err(|failure| failure.to_string())
    }

    #[test]
    fn header_is_optional() {
        let rows = vec![[1.0, 2.0, 3.0], [-0.5, 1e-3, 0.0]];
        assert_eq!(read_text("1,2,3\n-0.5, 1e-3 ,0\n").as_ref(), Ok(&rows));
        assert_eq!(
            read_text("x,y,z\n1,2,3\n\n# more\n-0.5,1e-3,0").as_ref(),
            Ok(&rows)
        );
        assert_eq!(read_text::<3>(""), Ok(vec![]));
    }

    #[test]
    fn bad_rows_name_line_and_column() {
        let message = |text| read_text::<3>(text).unwrap_err();
        assert_eq!(
            message("x,y,z\n1,2,3\n1,b,3\n"),
            "`p.csv`, line 3, column 2: `b` is not a number"
        );
        assert_eq!(
            message("1,2\n"),
            "`p.csv`, line 1: expected 3 numbers, found 2"
        );
        assert_eq!(
            message("1,2,x\n"),
            "`p.csv`, line 1, column 3: `x` is not a number"
        );
        assert_eq!(
            message("1,2,3\nx,y,z\n"),
            "`p.csv`, line 2, column 1: `x` is not a number"
        );
        assert_eq!(
            message("1,2,inf\n"),
            "`p.csv`, line 1, column 3: `inf` is not a finite number"
        );
    }

    #[test]
    fn digits_give_the_same_bits_back() {
        let tricky = [
            0.1,
            1.0 / 3.0,
            0.5,
            1.0,
            -2.0,
            1e16,
            123456789012345680.0,
            1e17,
            1e22,
            1e-5,
            9.9e-6,
            1e300,
            5e-324,
            f64::MAX,
            f64::MIN_POSITIVE,
            -0.0,
            0.1 + 0.2,
            99999999999999990.0,
            0.999_999_999_999_999_9,
        ];
        for x in tricky {
            let back: f64 = digits(x).parse().expect("a number");
            assert_eq!(back.to_bits(), x.to_bits(), "{x} as {}", digits(x));
        }
    }

    #[test]
    fn digits_are_seventeen_without_zeros() {
        assert_eq!(digits(0.1), "0.10000000000000001");
        assert_eq!(digits(0.5), "0.5");
        assert_eq!(digits(-3.0), "-3");
        assert_eq!(digits(100.0), "100");
        assert_eq!(digits(2.5e-7), "2.4999999999999999e-7");
        assert_eq!(digits(1e20), "1e20");
        assert_eq!(digits(-0.0), "-0");
        assert_eq!(digits(f64::NEG_INFINITY), "-inf");
        assert_eq!(digits(f64::NAN), "nan");
    }

    #[test]
    fn cells_in_both_formats() {
        let rows = [
            vec![
                Cell::Number(0.5),
                Cell::Text("a, \"b\"".into()),
                Cell::Empty,
            ],
            vec![
                Cell::Number(f64::INFINITY),
                Cell::Text("c".into()),
                Cell::Count(7),
            ],
        ];
        let columns = ["x", "name", "steps"];
        assert_eq!(
            to_csv(&columns, &rows),
            "x,name,steps\n0.5,\"a, \"\"b\"\"\",\ninf,c,7\n"
        );
        assert_eq!(
            to_json(&columns, &rows),
            "[\n  {\"x\": 0.5, \"name\": \"a, \\\"b\\\"\", \"steps\": null},\n  \
             {\"x\": null, \"name\": \"c\", \"steps\": 7}\n]\n"
        );
        assert_eq!(to_json(&columns, &[]), "[]\n");
    }
}
