//! Metrics with their samples, as `OpenMetrics` text.

use std::fmt;

use prometheus_client::{
    collector::Collector,
    encoding::{DescriptorEncoder, NoLabelSet, text},
    metrics::MetricType,
    registry::{Registry, Unit},
};

/// Labels of a sample. All values come from the station file or from Azel, never from a client.
pub(super) type Labels = Vec<(&'static str, String)>;

/// Description of a metric.
#[derive(Debug, Clone, Copy)]
pub(super) struct Metric {
    /// Name without unit and without the suffix of its kind.
    name: &'static str,
    unit: Option<&'static str>,
    kind: Kind,
    help: &'static str,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Gauge,
    Counter,
    /// Metric that has only labels.
    Info,
}

impl Metric {
    pub(super) const fn gauge(name: &'static str, help: &'static str) -> Self {
        Self { name, unit: None, kind: Kind::Gauge, help }
    }

    pub(super) const fn counter(name: &'static str, help: &'static str) -> Self {
        Self { name, unit: None, kind: Kind::Counter, help }
    }

    pub(super) const fn info(name: &'static str, help: &'static str) -> Self {
        Self { name, unit: None, kind: Kind::Info, help }
    }

    /// Adds a unit, which the text appends to the name.
    #[must_use]
    pub(super) const fn in_unit(self, unit: &'static str) -> Self {
        Self { unit: Some(unit), ..self }
    }
}

/// Metrics of one scrape. A metric without a sample still has its description in the text.
#[derive(Debug)]
pub(super) struct Families(Vec<(Metric, Vec<(Labels, f64)>)>);

impl Families {
    /// Creates the families of these metrics, without samples.
    pub(super) fn new(metrics: impl IntoIterator<Item = Metric>) -> Self {
        Self(metrics.into_iter().map(|metric| (metric, Vec::new())).collect())
    }

    /// Adds a sample. A value that is absent or no number adds nothing.
    pub(super) fn add(&mut self, metric: Metric, labels: Labels, value: impl Into<Option<f64>>) {
        let Some(value) = value.into().filter(|value| value.is_finite()) else { return };
        let family = self.0.iter_mut().find(|(other, _)| other.name == metric.name);
        match family {
            Some((_, samples)) => samples.push((labels, value)),
            None => self.0.push((metric, vec![(labels, value)])),
        }
    }

    /// Adds a sample for each state: 1 for the current state, 0 for all others.
    pub(super) fn add_states(
        &mut self,
        metric: Metric,
        labels: &Labels,
        key: &'static str,
        (states, current): (&[&'static str], &str),
    ) {
        for state in states {
            let mut labels = labels.clone();
            labels.push((key, (*state).to_owned()));
            self.add(metric, labels, flag(*state == current));
        }
    }

    /// Returns the text of all metrics.
    pub(super) fn into_text(self) -> Result<String, fmt::Error> {
        let mut registry = Registry::default();
        registry.register_collector(Box::new(self));
        let mut encoded = String::new();
        text::encode(&mut encoded, &registry)?;
        Ok(encoded)
    }
}

/// Returns the value of a flag.
pub(super) fn flag(is_set: bool) -> f64 {
    if is_set { 1.0 } else { 0.0 }
}

impl Collector for Families {
    fn encode(&self, mut encoder: DescriptorEncoder<'_>) -> fmt::Result {
        for (metric, samples) in &self.0 {
            let unit = metric.unit.map(|unit| Unit::Other(unit.to_owned()));
            let metric_type = match metric.kind {
                Kind::Gauge => MetricType::Gauge,
                Kind::Counter => MetricType::Counter,
                Kind::Info => MetricType::Info,
            };
            let (name, help) = (metric.name, metric.help);
            let mut family = encoder.encode_descriptor(name, help, unit.as_ref(), metric_type)?;
            for (labels, value) in samples {
                match metric.kind {
                    Kind::Gauge => family.encode_family(labels)?.encode_gauge(value)?,
                    Kind::Counter => family
                        .encode_family(labels)?
                        .encode_counter::<NoLabelSet, f64, f64>(value, None)?,
                    Kind::Info => family.encode_info(labels)?,
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_suffixes_labels_and_absent_values_follow_the_format() {
        const AGE: Metric = Metric::gauge("azel_age", "Age.").in_unit("seconds");
        const PASSES: Metric = Metric::counter("azel_passes", "Passes.");
        const BUILD: Metric = Metric::info("azel_build", "Version.");
        let mut families = Families::new([AGE, PASSES, BUILD]);
        let labels = vec![("antenna", "a \"b\"\\c\nd".to_owned())];
        families.add(AGE, labels, 1.5);
        families.add(AGE, Labels::new(), None);
        families.add(AGE, Labels::new(), f64::NAN);
        families.add(AGE, Labels::new(), f64::INFINITY);
        families.add(PASSES, Labels::new(), 3.0);
        families.add(BUILD, vec![("version", "1".to_owned())], 1.0);
        let expected = "\
# HELP azel_age_seconds Age.
# TYPE azel_age_seconds gauge
# UNIT azel_age_seconds seconds
azel_age_seconds{antenna=\"a \\\"b\\\"\\\\c\\nd\"} 1.5
# HELP azel_passes Passes.
# TYPE azel_passes counter
azel_passes_total 3.0
# HELP azel_build Version.
# TYPE azel_build info
azel_build_info{version=\"1\"} 1
# EOF
";
        assert_eq!(families.into_text().unwrap(), expected);
    }
}
