//! Text of measured points: one count and angle on each line.

use super::{Unfit, value::number};
use crate::device::CountPoint;

/// Returns the text of the points, one point a line.
pub(super) fn write(points: &[CountPoint]) -> String {
    let lines = points.iter().map(|point| format!("{} {}", point.counts, point.degrees));
    lines.collect::<Vec<_>>().join("\n")
}

/// Returns the points of a text, or the reason why it contains anything else.
pub(super) fn read(text: &str) -> Result<Vec<CountPoint>, Unfit> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let points: Vec<CountPoint> = lines
        .map(|(index, line)| {
            point(line).ok_or_else(|| {
                let line = index + 1;
                Unfit::Text(format!("line {line} must be a count and an angle, such as 1240 45.5"))
            })
        })
        .collect::<Result<_, _>>()?;
    CountPoint::check(&points)?;
    Ok(points)
}

fn point(line: &str) -> Option<CountPoint> {
    let separated = |c: char| c.is_whitespace() || c == ';';
    let mut words = line.split(separated).filter(|word| !word.is_empty());
    let counts = words.next()?.trim_end_matches(',').parse().ok()?;
    let degrees = number(words.next()?)?;
    words.next().is_none().then_some(CountPoint { counts, degrees })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let points = vec![
            CountPoint { counts: 0, degrees: -12.25 },
            CountPoint { counts: 65_535, degrees: 361.0 },
        ];
        assert_eq!(read(&write(&points)), Ok(points));
        assert_eq!(read(" \n"), Ok(Vec::new()));
    }

    #[test]
    fn signs_and_marks_of_others_are_understood() {
        let points = read("30;−4,5\n\n 200\t90\n300, 91").unwrap();
        let angles: Vec<f64> = points.iter().map(|point| point.degrees).collect();
        assert_eq!(angles, [-4.5, 90.0, 91.0]);
    }

    #[test]
    fn a_wrong_line_is_named() {
        for (text, line) in [("1 2\n\nx 4", 3), ("1", 1), ("1 2\n3 4 5", 2), ("70000 1", 1)] {
            let message = read(text).unwrap_err().to_string();
            assert!(message.starts_with(&format!("line {line} ")), "{text}: {message}");
        }
        assert!(read("1 2").is_err() && read("1 2\n1 3").is_err());
    }
}
