//! Tables for people: words to the left, numbers to the right, as wide as they need to be.

/// A row of cells, the first of which is to the left.
pub type Row = Vec<String>;

/// The rows below each other, indented by two blanks, with two between columns. The first `words` columns are flush left.
pub fn aligned(rows: &[Row], words: usize) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns)
        .map(|i| {
            rows.iter()
                .filter_map(|row| row.get(i))
                .map(|cell| cell.chars().count())
                .max()
        })
        .map(|width| width.unwrap_or(0))
        .collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (i, (cell, width)) in row.iter().zip(&widths).enumerate() {
            let blanks = " ".repeat(width - cell.chars().count());
            line.push_str("  ");
            line.push_str(&if i < words {
                cell.clone() + &blanks
            } else {
                blanks + cell
            });
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_left_and_numbers_right() {
        let row = |cells: &[&str]| cells.iter().map(|c| c.to_string()).collect::<Row>();
        let rows = [
            row(&["method", "ms"]),
            row(&["a", "10.5"]),
            row(&["ü", "7"]),
        ];
        assert_eq!(
            aligned(&rows, 1),
            "  method    ms\n  a       10.5\n  ü          7\n"
        );
        assert_eq!(aligned(&[], 1), "");
    }
}
