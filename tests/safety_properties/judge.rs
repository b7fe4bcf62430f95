//! Judges a case by where the metal is and by what the unit received.

use std::time::Duration;

use azel::{clock::Instant, contract::driver::Safety};

use super::{scene::Scene, unit::Word};

/// Readings of the clock in a second of a session that waits for something in between.
const MAX_READINGS_PER_S: f64 = 20_000.0;

/// Time within which what a session has written reaches the unit.
const ON_THE_WAY: Duration = Duration::from_millis(100);

/// Judge of one case.
pub(super) struct Judge {
    pub(super) case: String,
    began: Instant,
    readings: u64,
    /// No order to move may arrive after that.
    quiet_since: Option<Instant>,
    /// The angles lie, or the link is down in a jog that only the unit could end.
    pub(super) is_lost: bool,
}

impl Judge {
    pub(super) fn new(scene: &Scene, case: String) -> Self {
        let (began, readings) = (Instant::now(), scene.clock.readings());
        Self { case, began, readings, quiet_since: None, is_lost: false }
    }

    /// The operator asks for a motion.
    pub(super) fn allow(&mut self) {
        self.quiet_since = None;
    }

    /// From now on nobody asks for a motion.
    pub(super) fn forbid(&mut self) {
        self.quiet_since.get_or_insert(Instant::now());
    }

    /// Looks at the metal.
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

    /// Looks at what the unit has received since the operator last asked for a motion.
    pub(super) fn hear(&self, scene: &Scene) {
        let Some(since) = self.quiet_since else { return };
        let words = scene.world.words_since(since + ON_THE_WAY);
        let moved = words.iter().find(|(_, word)| *word == Word::Motion);
        assert!(moved.is_none(), "moved by itself: {self}\n{words:?}\n{}", scene.report());
    }

    /// Looks whether the session spins.
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

    /// The operator presses STOP: it is the first order that the unit receives, nothing moves any
    /// more, and the antenna stands within `within_s`. The line is good.
    pub(super) async fn stop(&mut self, scene: &mut Scene, within_s: f64) {
        let pressed = Instant::now();
        scene.stop();
        self.forbid();
        self.stands(scene, pressed, within_s).await;
    }

    /// The antenna comes to stand, and the first order since `since` is STOP.
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
