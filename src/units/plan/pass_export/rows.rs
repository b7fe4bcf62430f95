//! Rows as text: made by all threads, and written in their order.

use std::{
    io::{self, Write},
    mem, ptr,
};

use jiff::Timestamp;
use rayon::prelude::*;

use super::ExportedPass;
use crate::orbit::{OverGround, Pass, Propagator};

/// Number of rows that are made while as many before them are written, some 0.7 MB of CSV.
const AT_ONCE: usize = 1 << 12;
/// Number of rows that one thread takes at a time.
const CHUNK: usize = 256;

/// Rows as text. They are made in the order in which their satellites lie in memory: in that of
/// time, much of the work would be to wait for memory.
#[derive(Default)]
struct Made {
    /// Where a satellite lies, and the place of its row in the order of time.
    order: Vec<(usize, u32)>,
    texts: Vec<Text>,
}

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

impl Made {
    /// Makes these rows in place of those before. The memory of those is used again, so that the
    /// allocator need not ask the operating system each time.
    fn make<const PLACES: usize>(
        &mut self,
        rows: &[ExportedPass<'_>],
        times: &(impl Fn(&Pass) -> [Timestamp; PLACES] + Sync),
        push: &(impl Fn(&mut Vec<u8>, &ExportedPass<'_>, [Option<OverGround>; PLACES]) + Sync),
    ) {
        let Self { order, texts } = self;
        order.clear();
        order.extend(rows.iter().map(|row| ptr::from_ref(row.satellite).addr()).zip(0..));
        order.sort_unstable();
        texts.resize_with(order.len().div_ceil(CHUNK), Text::default);
        texts.par_iter_mut().zip(order.par_chunks(CHUNK)).for_each(|(text, order)| {
            text.bytes.clear();
            text.ends.clear();
            let rows = || order.iter().filter_map(|(_, index)| rows.get(*index as usize));
            let mut wanted = Vec::with_capacity(PLACES * order.len());
            for ExportedPass { satellite, pass } in rows() {
                wanted.extend(times(pass).map(|at| (&satellite.propagator, at)));
            }
            let places = Propagator::over_ground(&wanted);
            for (row, places) in rows().zip(places.as_chunks().0) {
                push(&mut text.bytes, row, *places);
                text.ends.push(text.bytes.len());
            }
        });
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let mut in_order: Vec<&[u8]> = vec![&[]; self.order.len()];
        for ((_, index), text) in self.order.iter().zip(self.texts.iter().flat_map(Text::rows)) {
            if let Some(place) = in_order.get_mut(*index as usize) {
                *place = text;
            }
        }
        in_order.into_iter().try_for_each(|text| out.write_all(text))
    }
}

/// Writes `rows` in their order, each as `push` appends it to a buffer, given the places of its
/// satellite at its `times` (see [`Propagator::over_ground`]). The work is shared by the threads of
/// the rayon pool in which this is called; some rows at a time are held as text.
pub(super) fn write_rows<'a, const PLACES: usize>(
    out: &mut impl Write,
    mut rows: impl Iterator<Item = ExportedPass<'a>>,
    times: impl Fn(&Pass) -> [Timestamp; PLACES] + Sync,
    push: impl Fn(&mut Vec<u8>, &ExportedPass<'_>, [Option<OverGround>; PLACES]) + Sync,
) -> io::Result<()> {
    let mut take = || rows.by_ref().take(AT_ONCE).collect::<Vec<_>>();
    let (mut made, mut next) = (Made::default(), Made::default());
    let mut taken = take();
    loop {
        // One thread writes and takes while the others make.
        let (written, ahead) = rayon::in_place_scope(|scope| {
            scope.spawn(|_| next.make(&taken, &times, &push));
            (made.write(out), take())
        });
        written?;
        if taken.is_empty() {
            return Ok(());
        }
        taken = ahead;
        mem::swap(&mut made, &mut next);
    }
}

#[cfg(test)]
mod tests {
    use jiff::SignedDuration;

    use super::{super::testing::example, *};
    use crate::plan::pass_export::Satellite;

    /// Rows in the order of their AOS, of satellites that lie in another in memory.
    fn written(count: usize, threads: usize) -> Vec<u8> {
        let (elements, pass) = example();
        let satellites = vec![Satellite::new(elements).unwrap(); 7];
        let rows =
            (0..).take(count).zip(satellites.iter().rev().cycle()).map(|(second, satellite)| {
                let mut pass = pass;
                pass.aos.time += SignedDuration::from_secs(second);
                ExportedPass { satellite, pass }
            });
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let times = |pass: &Pass| [pass.aos.time, pass.los.time];
        let push = |text: &mut Vec<u8>, row: &ExportedPass<'_>, places: [Option<OverGround>; 2]| {
            let propagator = &row.satellite.propagator;
            for (at, place) in times(&row.pass).into_iter().zip(places) {
                let exact = propagator.state_at(at).unwrap().over_ground(at);
                let off = place.unwrap().position_km - exact.position_km;
                assert!(off.length() < 2e-8, "{off}");
            }
            writeln!(text, "{}", row.pass.aos.time.as_second()).unwrap();
        };
        let mut out = Vec::new();
        pool.in_place_scope(|_| write_rows(&mut out, rows, times, push)).unwrap();
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
