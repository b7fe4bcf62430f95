//! Rows as text: made by all threads, and written in their order.

use std::io::{self, Write};

use rayon::prelude::*;

use super::ExportedPass;

/// Number of rows that one thread takes at a time: some 100 kB of text, for which the allocator
/// need not ask the operating system each time.
const CHUNK: usize = 256;
/// Number of chunks for each thread between two writes.
const CHUNKS_AHEAD: usize = 16;

/// Writes `rows` in their order, each as `push` appends it to a buffer. The work is shared by the
/// threads of the rayon pool in which this is called.
pub(super) fn write_rows(
    out: &mut impl Write,
    rows: &[ExportedPass<'_>],
    push: impl Fn(&mut Vec<u8>, &ExportedPass<'_>) -> io::Result<()> + Sync,
) -> io::Result<()> {
    let text_of = |rows: &[ExportedPass<'_>]| {
        let mut text = Vec::new();
        rows.iter().try_for_each(|row| push(&mut text, row)).map(|()| text)
    };
    for rows in rows.chunks(CHUNK * CHUNKS_AHEAD * rayon::current_num_threads()) {
        let texts: Vec<_> = rows.par_chunks(CHUNK).map(text_of).collect();
        for text in texts {
            out.write_all(&text?)?;
        }
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
            writeln!(text, "{}", row.pass.aos.time.as_second())
        };
        let mut out = Vec::new();
        pool.install(|| write_rows(&mut out, &rows, push)).unwrap();
        out
    }

    #[test]
    fn rows_are_in_order_whatever_thread_made_them() {
        let count = 3 * CHUNK * CHUNKS_AHEAD + 7;
        let one = written(count, 1);
        let text = String::from_utf8(one.clone()).unwrap();
        let seconds: Vec<i64> = text.lines().map(|line| line.parse().unwrap()).collect();
        assert_eq!(seconds.len(), count);
        assert!(seconds.windows(2).all(|two| two[1] == two[0] + 1));
        assert_eq!(written(count, 3), one);
        assert_eq!(written(0, 2), b"");
    }
}
