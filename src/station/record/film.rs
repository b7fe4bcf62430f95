//! Film of a station: its published snapshots, picture by picture.
//!
//! A picture is stored as its changes from the previous picture. A reel covers one minute and
//! begins with a whole picture. Large parts that seldom change are stored once, and pictures refer
//! to them.

mod camera;
mod patch;
mod reels;

use std::{any::Any, collections::HashMap, sync::Arc};

use serde::Serialize;
use serde_json::Value;

pub(super) use camera::Camera;
pub use reels::{Film, FilmError, Shown};

use crate::clock::Moment;

/// Picture of a station at one moment.
pub trait Picture: Send + Sync {
    fn moment(&self) -> Moment;

    /// Returns the whole picture as JSON, with numbers in place of its large parts.
    fn draw(&self, parts: &mut Parts) -> serde_json::Result<Value>;
}

/// Large parts of pictures. Each is stored once, under a number, while pictures show it.
#[derive(Default)]
pub struct Parts {
    /// Parts by address, which stays unique while the part is held here.
    by_address: HashMap<usize, StoredPart>,
    last: i64,
    /// Parts that are not on the disk yet.
    new: Vec<(i64, Vec<u8>)>,
    /// Values at these places of the previous picture.
    placed: HashMap<String, Placed>,
    /// Places at which the current picture has the value of the previous one.
    same: Vec<String>,
}

struct StoredPart {
    number: i64,
    is_shown: bool,
    _held: Arc<dyn Any + Send + Sync>,
}

/// Value at a place of the previous picture.
struct Placed {
    address: usize,
    is_shown: bool,
    /// Value that is held to keep its address unique.
    _held: Box<dyn Any + Send + Sync>,
}

impl Parts {
    /// Returns the number of a part.
    pub fn number<T>(&mut self, part: &Arc<T>) -> serde_json::Result<i64>
    where
        T: Serialize + Send + Sync + 'static,
    {
        self.number_with(part, |part| serde_json::to_vec(part))
    }

    /// Returns the number of a part; `write` gives the content of a new part.
    pub fn number_with<T: Send + Sync + 'static>(
        &mut self,
        part: &Arc<T>,
        write: impl FnOnce(&T) -> serde_json::Result<Vec<u8>>,
    ) -> serde_json::Result<i64> {
        let address = Arc::as_ptr(part).addr();
        if let Some(part_entry) = self.by_address.get_mut(&address) {
            part_entry.is_shown = true;
            return Ok(part_entry.number);
        }
        let content = write(part)?;
        self.last += 1;
        self.new.push((self.last, content));
        let part_entry = StoredPart { number: self.last, is_shown: true, _held: part.clone() };
        self.by_address.insert(address, part_entry);
        Ok(self.last)
    }

    /// Returns `true` if the previous picture of the reel had this value at this place, a JSON
    /// pointer. The caller may then draw any value there.
    pub fn is_same<T>(&mut self, place: String, part: &Arc<T>) -> bool
    where
        T: ?Sized + Send + Sync + 'static,
    {
        let address = Arc::as_ptr(part).addr();
        let is_same = self.placed.get(&place).is_some_and(|before| before.address == address);
        if is_same {
            self.same.push(place.clone());
        }
        let placed = Placed { address, is_shown: true, _held: Box::new(Arc::clone(part)) };
        self.placed.insert(place, placed);
        is_same
    }

    /// Drops parts and values that the last picture does not show.
    fn next_picture(&mut self) {
        self.by_address.retain(|_, part_entry| std::mem::take(&mut part_entry.is_shown));
        self.placed.retain(|_, placed| std::mem::take(&mut placed.is_shown));
    }

    fn numbers(&self) -> impl Iterator<Item = i64> {
        self.by_address.values().map(|part_entry| part_entry.number)
    }
}
