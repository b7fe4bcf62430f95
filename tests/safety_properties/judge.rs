//! Judge of a case, by the true positions of the axes and the requests that the unit received.

use std::time::Duration;

use azel::{clock::Instant, contract::driver::Safety};

use super::{scene::Scene, unit::Word};

/// Max clock readings per second of a session that waits between them.
const MAX_READINGS_PER_S: f64 = 20_000.0;

/// Max time from a write of the session to its arrival at the unit.
const ON_THE_WAY: Duration = Duration::from_millis(100);

/// Judge of one case, with its current expectations.
pub(super) struct Judge {
    pub(super) case: String,
    began: Instant,
    readings: u64,
    /// Time after which no order to move may arrive.
    quiet_since: Option<Instant>,
    /// `true` if the angles lie, or if the link is down in a jog that only the unit could end.
    pub(super) is_lost: bool,
}

impl Judge {
    pub(super) fn new(scene: &Scene, case: String) -> Self {
        let (began, readings) = (Instant::now(), scene.clock.readings());
        Self { case, began, readings, quiet_since: None, is_lost: false }
    }

    /// Allows motions, because the operator asks for one.
    pub(super) fn allow(&mut self) {
        self.quiet_since = None;
    }

    /// Forbids motions from now on.
    pub(super) fn forbid(&mut self) {
        self.quiet_since.get_or_insert(Instant::now());
    }

    /// Checks that the session runs and that the antenna is outside of all keep-outs.
    pub(super) fn look(&self, scene: &Scene) {
        assert!(!scene.has_ended(), "the session broke down: {self}\n{}", scene.report());
        if self.is_lost {
            return;
        }
        let margin_deg = scene.world.margin_clearance_deg();
        assert!(
            margin_deg >= -scene.world.coarse_deg,
            "{} inside a keep-out and its margin: {self}\n{}",
            -margin_deg,
            scene.report()
        );
    }

    /// Checks that the unit has received no motion since the operator last asked for one.
    pub(super) fn hear(&self, scene: &Scene) {
        let Some(since) = self.quiet_since else { return };
        let words = scene.world.words_since(since + ON_THE_WAY);
        let moved = words.iter().find(|(_, word)| *word == Word::Motion);
        assert!(moved.is_none(), "moved by itself: {self}\n{words:?}\n{}", scene.report());
    }

    /// Checks at the end of a case that the session neither moves the antenna nor spins nor broke
    /// down.
    pub(super) fn end(&self, scene: &Scene) {
        self.hear(scene);
        let lasted_s = (Instant::now() - self.began).as_secs_f64() + 1.0;
        let rate = (scene.clock.readings() - self.readings) as f64 / lasted_s;
        assert!(rate < MAX_READINGS_PER_S, "{rate} readings a second: {self}");
        let broke = scene.told(self.began, |event| {
            matches!(event, azel::contract::driver::Event::Safety(Safety::SessionBroke))
        });
        assert!(broke.is_none(), "the session broke down: {self}");
    }

    /// Presses STOP on a good line. STOP must be the first order that the unit receives, nothing
    /// may move afterwards, and the antenna must stand within `within_s`.
    pub(super) async fn stop(&mut self, scene: &mut Scene, within_s: f64) {
        let pressed = Instant::now();
        scene.stop();
        self.forbid();
        self.stands(scene, pressed, within_s).await;
    }

    /// Checks that the antenna stands within `within_s`, and that the first order since `since` is
    /// STOP.
    pub(super) async fn stands(&mut self, scene: &mut Scene, since: Instant, within_s: f64) {
        let end = Instant::now() + Duration::try_from_secs_f64(within_s).unwrap();
        while Instant::now() < end {
            scene.look().await;
            self.look(scene);
        }
        let words = scene.world.words_since(since);
        let first = words.iter().map(|(_, word)| *word).find(|word| *word != Word::Question);
        assert_eq!(first, Some(Word::Stop), "first: {self}\n{words:?}\n{}", scene.report());
        for _ in 0..40 {
            assert!(!scene.world.unit.is_turning(), "still turns: {self}\n{}", scene.report());
            scene.look().await;
            self.look(scene);
        }
        self.end(scene);
    }
}

impl std::fmt::Display for Judge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.case)
    }
}
