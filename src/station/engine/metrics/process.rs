//! Figures of this process, under the names that Prometheus prescribes.

use super::families::{Families, Labels, Metric};

const CPU: Metric =
    Metric::counter("process_cpu", "Processor time of this process.").in_unit("seconds");
const RESIDENT: Metric =
    Metric::gauge("process_resident_memory", "Memory of this process in RAM.").in_unit("bytes");
const VIRTUAL: Metric =
    Metric::gauge("process_virtual_memory", "Address space of this process.").in_unit("bytes");
const START: Metric =
    Metric::gauge("process_start_time", "Unix time at which this process started.")
        .in_unit("seconds");
const FILES: Metric = Metric::gauge("process_open_fds", "Open files and sockets of this process.");
const THREADS: Metric = Metric::gauge("process_threads", "Threads of this process.");

pub(super) const METRICS: [Metric; 6] = [CPU, RESIDENT, VIRTUAL, START, FILES, THREADS];

/// Adds the figures that the operating system reports.
#[cfg(target_os = "linux")]
pub(super) fn add(families: &mut Families) {
    let Ok(process) = procfs::process::Process::myself() else { return };
    let files = process.fd_count().ok().map(|count| count as f64);
    families.add(FILES, Labels::new(), files);
    let Ok(stat) = process.stat() else { return };
    let ticks_per_second = procfs::ticks_per_second() as f64;
    let cpu_s = (stat.utime + stat.stime) as f64 / ticks_per_second;
    families.add(CPU, Labels::new(), cpu_s);
    families.add(RESIDENT, Labels::new(), (stat.rss * procfs::page_size()) as f64);
    families.add(VIRTUAL, Labels::new(), stat.vsize as f64);
    families.add(THREADS, Labels::new(), stat.num_threads as f64);
    let start = procfs::boot_time_secs().ok();
    let start = start.map(|boot| boot as f64 + stat.starttime as f64 / ticks_per_second);
    families.add(START, Labels::new(), start);
}

/// Adds nothing: the figures come from Linux alone.
#[cfg(not(target_os = "linux"))]
pub(super) fn add(_: &mut Families) {}
