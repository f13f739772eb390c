//! Numbers and tables as text.

/// The number with about four digits, as people read it: no more places than say something.
pub fn short(x: f64) -> String {
    if x.fract() == 0.0 && x.abs() < 1e15 {
        return format!("{x}");
    }
    let places = match x.abs() {
        a if a >= 1000.0 => 0,
        a if a >= 100.0 => 1,
        a if a >= 10.0 => 2,
        a if a >= 1e-3 => 3,
        _ => return format!("{x:.1e}"),
    };
    format!("{x:.places$}")
}

/// A table in Markdown; the first `words` columns are flush left, the others flush right.
pub fn markdown(head: &[&str], words: usize, rows: &[Vec<String>]) -> String {
    let line = |cells: &mut dyn Iterator<Item = String>| {
        let cells: Vec<String> = cells.map(|cell| cell.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let mut text = line(&mut head.iter().map(|cell| (*cell).into()));
    let rule = |i| if i < words { "---" } else { "--:" };
    text.push_str(&line(&mut (0..head.len()).map(|i| rule(i).into())));
    for row in rows {
        text.push_str(&line(&mut row.iter().cloned()));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_about_four_digits() {
        let numbers = [
            0.0, 2.0, 1e8, 1234.5, 123.45, 12.345, 1.2345, 0.0012, 1.5e-7,
        ]
        .map(short);
        assert_eq!(
            numbers,
            [
                "0",
                "2",
                "100000000",
                "1234",
                "123.5",
                "12.35",
                "1.234",
                "0.001",
                "1.5e-7"
            ]
        );
    }

    #[test]
    fn tables_in_markdown() {
        let rows = [vec!["a|b".to_string(), "1".into()]];
        let expected = "| name | n |\n| --- | --: |\n| a\\|b | 1 |\n";
        assert_eq!(markdown(&["name", "n"], 1, &rows), expected);
    }
}
