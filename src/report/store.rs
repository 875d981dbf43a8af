//! Results as JSON lines: a file for each component or scene, the machine first, then a row a line.

use super::page::{Page, slug};
use super::row::{Machine, Row};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Why a file of results could not be read.
#[derive(Debug, thiserror::Error)]
#[error("line {line} is not a row of results: {error}")]
pub struct StoreError {
    /// From 1.
    pub line: usize,
    /// What is wrong with it.
    pub error: serde_json::Error,
}

/// A file for each group of rows, which are components or scenes: "results/cubic-evaluation.jsonl".
pub fn write<R: Serialize>(machine: &Machine, rows: &[R], group: impl Fn(&R) -> &str) -> Vec<Page> {
    let mut files: Vec<Page> = Vec::new();
    for row in rows {
        let name = format!("results/{}.jsonl", slug(group(row)));
        let at = files.iter().position(|file| file.name == name).unwrap_or_else(|| {
            files.push(Page { name, text: line(machine) });
            files.len() - 1
        });
        files[at].text += &line(row);
    }
    files
}

fn line(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("numbers and strings are always written") + "\n"
}

/// The machine and the rows of one file.
pub fn read<R: DeserializeOwned>(text: &str) -> Result<(Machine, Vec<R>), StoreError> {
    let mut lines = text.lines().enumerate();
    let fault = |line: usize| move |error| StoreError { line: line + 1, error };
    let machine = match lines.next() {
        Some((i, first)) => serde_json::from_str(first).map_err(fault(i))?,
        None => Machine::default(),
    };
    let rows: Result<Vec<R>, StoreError> =
        lines.map(|(i, text)| serde_json::from_str(text).map_err(fault(i))).collect();
    Ok((machine, rows?))
}

/// Sorts rows read from many files as they were measured: by component in the order of measuring, each in its own order.
pub fn sort(rows: &mut [Row]) {
    rows.sort_by_key(|row| row.order);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back_as_they_were() {
        let row =
            Row { component: "a b".into(), error_max: 0.1 + 0.2, bar: Some(0.0), n: 7, ..Row::default() };
        let other = Row { component: "c".into(), ..Row::default() };
        let machine = Machine { seed: 3, ..Machine::default() };
        let files = write(&machine, &[row.clone(), other, row.clone()], |row| &row.component);
        assert_eq!(
            files.iter().map(|f| &*f.name).collect::<Vec<_>>(),
            ["results/a-b.jsonl", "results/c.jsonl"]
        );
        let (again, rows) = read::<Row>(&files[0].text).unwrap();
        assert_eq!((again, rows), (machine, vec![row.clone(), row]));
        assert_eq!(read::<Row>("{}\n{}\nx").unwrap_err().line, 3);
    }
}
