//! Rows as text: made by all threads, and written in their order.

use std::io::{self, Write};

use rayon::prelude::*;

use super::ExportedPass;

/// Number of rows that one thread takes at a time: some 200 kB of text.
const CHUNK: usize = 1024;
/// Number of chunks for each thread between two writes.
const CHUNKS_AHEAD: usize = 4;

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
