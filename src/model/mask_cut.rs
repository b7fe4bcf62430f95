//! The stretches of the selected pass above the horizon mask.

use crate::{
    astro::{HorizonMask, Site},
    engine::passes::PredictedPass,
    orbit::{Pass, clear_stretches},
};

/// The cut of a pass by the horizon mask, recomputed only for another pass or mask.
#[derive(Debug, Default)]
pub struct MaskCut {
    cut: Option<Vec<Pass>>,
    made_of: Option<(u32, Pass, Site, HorizonMask)>,
}

impl MaskCut {
    /// The stretches above the mask, in order: empty if the mask hides the whole pass, `None` if
    /// it cuts nothing off.
    pub fn cut(&self) -> Option<&[Pass]> {
        self.cut.as_deref()
    }

    pub(super) fn refresh(
        &mut self,
        selected: Option<&PredictedPass>,
        site: Site,
        mask: Option<&HorizonMask>,
    ) {
        let (Some(predicted), Some(mask)) = (selected, mask) else {
            *self = Self::default();
            return;
        };
        let (number, pass) = (predicted.satellite.elements.catalog_number(), predicted.pass);
        let same = self.made_of.as_ref().is_some_and(|(of_number, of_pass, of_site, of_mask)| {
            (*of_number, *of_pass, *of_site) == (number, pass, site) && of_mask == mask
        });
        if same {
            return;
        }
        let clear = clear_stretches(&predicted.satellite.propagator, site, mask, &pass);
        let is_whole = matches!(clear[..], [only]
            if only.aos.time == pass.aos.time && only.los.time == pass.los.time);
        self.cut = (!is_whole).then_some(clear);
        self.made_of = Some((number, pass, site, mask.clone()));
    }
}
