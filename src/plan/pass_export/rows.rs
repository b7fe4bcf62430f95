//! Rows as text: made by all threads, and written in their order.

use std::{
    io::{self, Write},
    ptr,
};

use rayon::prelude::*;

use super::ExportedPass;

/// Number of rows that are made before any of them is written, some 2 MB of CSV.
const AT_ONCE: usize = 1 << 13;
/// Number of rows that one thread takes at a time.
const CHUNK: usize = 256;

/// The text of some rows, and where in it each of them ends.
#[derive(Default)]
struct Text {
    bytes: Vec<u8>,
    ends: Vec<usize>,
}

impl Text {
    fn rows(&self) -> impl Iterator<Item = &[u8]> {
        let starts = std::iter::once(&0).chain(&self.ends);
        let spans = starts.zip(&self.ends);
        spans.map(|(start, end)| self.bytes.get(*start..*end).unwrap_or_default())
    }
}

/// Writes `rows` in their order, each as `push` appends it to a buffer. The work is shared by the
/// threads of the rayon pool in which this is called.
pub(super) fn write_rows(
    out: &mut impl Write,
    rows: &[ExportedPass<'_>],
    push: impl Fn(&mut Vec<u8>, &ExportedPass<'_>) + Sync,
) -> io::Result<()> {
    // Used again, so that the allocator need not ask the operating system each time.
    let mut texts: Vec<Text> = Vec::new();
    for rows in rows.chunks(AT_ONCE) {
        // They are made as they lie in memory, where the passes of one satellite follow each other:
        // in the order of time, much of the work would be to wait for memory.
        let place =
            |(row, index): (&ExportedPass<'_>, u32)| (ptr::from_ref(row.pass).addr(), index);
        let mut places: Vec<(usize, u32)> = rows.iter().zip(0..).map(place).collect();
        places.par_sort_unstable();
        texts.resize_with(places.len().div_ceil(CHUNK), Text::default);
        texts.par_iter_mut().zip(places.par_chunks(CHUNK)).for_each(|(text, places)| {
            text.bytes.clear();
            text.ends.clear();
            for row in places.iter().filter_map(|(_, index)| rows.get(*index as usize)) {
                push(&mut text.bytes, row);
                text.ends.push(text.bytes.len());
            }
        });
        let mut in_order: Vec<&[u8]> = vec![&[]; rows.len()];
        for ((_, index), text) in places.iter().zip(texts.iter().flat_map(Text::rows)) {
            if let Some(place) = in_order.get_mut(*index as usize) {
                *place = text;
            }
        }
        in_order.into_iter().try_for_each(|text| out.write_all(text))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use jiff::SignedDuration;

    use super::{super::testing::example, *};
    use crate::plan::pass_export::{Satellite, in_order};

    /// Rows in the order of their AOS, of passes that were found in another.
    fn written(count: usize, threads: usize) -> Vec<u8> {
        let (elements, pass) = example();
        let satellites = [Satellite::new(elements).unwrap()];
        let mut passes = vec![(0, pass); count];
        for ((_, pass), second) in passes.iter_mut().zip((0..i64::try_from(count).unwrap()).rev()) {
            pass.aos.time += SignedDuration::from_secs(second);
        }
        let found: Vec<_> = passes.chunks(100).map(<[_]>::to_vec).collect();
        let rows = in_order(&satellites, &found);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let push = |text: &mut Vec<u8>, row: &ExportedPass<'_>| {
            writeln!(text, "{}", row.pass.aos.time.as_second()).unwrap();
        };
        let mut out = Vec::new();
        pool.install(|| write_rows(&mut out, &rows, push)).unwrap();
        out
    }

    #[test]
    fn rows_are_in_order_whatever_thread_made_them() {
        let count = 2 * AT_ONCE + 7;
        let one = written(count, 1);
        let text = String::from_utf8(one.clone()).unwrap();
        let seconds: Vec<i64> = text.lines().map(|line| line.parse().unwrap()).collect();
        assert_eq!(seconds.len(), count);
        assert!(seconds.windows(2).all(|two| two[1] == two[0] + 1));
        assert_eq!(written(count, 3), one);
        assert_eq!(written(0, 2), b"");
    }
}
