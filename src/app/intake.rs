//! Elements that the operator offers, read on a thread.

use std::sync::Arc;

use super::App;
use crate::{
    contract::CatalogState,
    job::Job,
    library::read_element_file,
    model::intake::{Intake, Judged, Offer},
};

/// Running job that judges the offers.
#[derive(Default)]
pub(super) struct IntakeWork {
    judging: Option<Job<Vec<Judged>>>,
}

impl App {
    /// Starts to read the offers, unless they equal the current ones.
    pub(super) fn offer_elements(&mut self, offers: Vec<Offer>, is_dropped: bool) {
        if let Some(intake) = self.model.intake.as_mut().filter(|intake| intake.offers == offers) {
            intake.is_dropped |= is_dropped;
            return;
        }
        let catalog = match &self.model.catalog {
            CatalogState::Ready(catalog) => Some(Arc::clone(catalog)),
            CatalogState::Loading | CatalogState::Failed => None,
        };
        let list = offers.clone();
        self.intake_work.judging =
            Some(Job::start("azel-intake", Arc::clone(&self.wake), move |cancelled| {
                let remaining = list.iter().take_while(|_| !cancelled());
                let judge = |bytes: &[u8]| Judged::new(bytes, catalog.as_deref());
                remaining
                    .map(|offer| match offer {
                        Offer::Text(text) => judge(text.as_bytes()),
                        Offer::File(path) => match read_element_file(path) {
                            Ok(bytes) => judge(&bytes),
                            Err(error) => Judged::Unreadable(error.to_string()),
                        },
                    })
                    .collect()
            }));
        self.model.intake = Some(Intake { offers, is_dropped, judged: None });
    }

    /// Discards the offers.
    pub(super) fn leave_elements(&mut self) {
        self.intake_work.judging = None;
        self.model.intake = None;
    }

    pub(super) fn take_intake(&mut self) {
        if let Some(Ok(judged)) = Job::take(&mut self.intake_work.judging)
            && let Some(intake) = &mut self.model.intake
        {
            intake.judged = Some(judged);
        }
    }
}
