//! The table of handles: the library's only global.
//!
//! A handle's id holds the index of a slot, the slot's generation, and the kind of what it stands for, so that a handle
//! that was destroyed, made up or meant for something else is known from every live one.

use super::basics::*;
use super::character::character_state::CharacterState;
use super::deformer::deformer_state::DeformerState;
use super::guard::{Failure, Outcome};
use crate::shape::style::Style;
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard, TryLockError, TryLockResult};

/// What a handle stands for.
#[derive(Clone)]
pub enum Object {
    /// A character.
    Character(Arc<RwLock<CharacterState>>),
    /// A style.
    Style(Arc<Style>),
    /// A deformer.
    Deformer(Arc<RwLock<DeformerState>>),
}

const CHARACTER: u64 = 1;
const STYLE: u64 = 2;
const DEFORMER: u64 = 3;

impl Object {
    /// Its kind as a number and as a word.
    fn kind(&self) -> (u64, &'static str) {
        match self {
            Object::Character(_) => (CHARACTER, "character"),
            Object::Style(_) => (STYLE, "style"),
            Object::Deformer(_) => (DEFORMER, "deformer"),
        }
    }
}

struct Slot {
    generation: u32,
    object: Option<Object>,
}

impl Slot {
    /// True where `id` stands for what is in it.
    fn is_of(&self, id: u64) -> bool {
        let (kind, generation, _) = parts_of(id);
        self.generation == generation && self.object.as_ref().is_some_and(|object| object.kind().0 == kind)
    }
}

struct Table {
    slots: Vec<Slot>,
    free: Vec<u32>,
    live: u64,
}

static TABLE: RwLock<Table> = RwLock::new(Table { slots: Vec::new(), free: Vec::new(), live: 0 });

/// Bits of an id: kind, generation, slot.
const SLOT_BITS: u32 = 32;
const GENERATION_BITS: u32 = 24;
const LAST_GENERATION: u32 = (1 << GENERATION_BITS) - 1;

fn parts_of(id: u64) -> (u64, u32, usize) {
    (
        id >> (SLOT_BITS + GENERATION_BITS),
        (id >> SLOT_BITS) as u32 & LAST_GENERATION,
        (id & u64::from(u32::MAX)) as usize,
    )
}

/// Gives `object` a handle.
pub fn insert(object: Object) -> Outcome<u64> {
    let (kind, _) = object.kind();
    let mut table = TABLE.write().unwrap_or_else(PoisonError::into_inner);
    let slot = match table.free.pop() {
        Some(slot) => slot,
        None => {
            let full = |_| {
                Failure::new(SDEF_STATUS_OUT_OF_MEMORY, "there is no memory for another handle: destroy some")
            };
            table.slots.try_reserve(1).map_err(full)?;
            // So that destroying never needs memory.
            let count = table.slots.len() + 1;
            let room = count - table.free.len();
            table.free.try_reserve(room).map_err(full)?;
            let slot = u32::try_from(table.slots.len()).map_err(|_| {
                Failure::new(SDEF_STATUS_OUT_OF_MEMORY, "there are 4294967296 handles: destroy some")
            })?;
            table.slots.push(Slot { generation: 1, object: None });
            slot
        }
    };
    let entry = &mut table.slots[slot as usize];
    entry.object = Some(object);
    let id =
        kind << (SLOT_BITS + GENERATION_BITS) | u64::from(entry.generation) << SLOT_BITS | u64::from(slot);
    table.live += 1;
    Ok(id)
}

/// What `id` stands for, if anything.
pub fn find(id: u64) -> Option<Object> {
    let table = TABLE.read().unwrap_or_else(PoisonError::into_inner);
    table.slots.get(parts_of(id).2).filter(|slot| slot.is_of(id))?.object.clone()
}

/// Takes `id` out of the table; what it stood for goes with its last user.
pub fn remove(id: u64) -> Outcome {
    if id == 0 {
        return Ok(());
    }
    let taken = {
        let mut table = TABLE.write().unwrap_or_else(PoisonError::into_inner);
        let Table { slots, free, live } = &mut *table;
        let (.., slot) = parts_of(id);
        slots.get_mut(slot).filter(|entry| entry.is_of(id)).and_then(|entry| {
            let object = entry.object.take();
            entry.generation += 1;
            // A slot that has used up its generations is left alone, so that no id ever comes again.
            *live -= 1;
            if entry.generation <= LAST_GENERATION {
                free.push(slot as u32);
            }
            object
        })
    };
    taken.map(drop).ok_or_else(|| bad_handle(id, "handle"))
}

/// How many handles there are.
pub fn live() -> u64 {
    TABLE.read().unwrap_or_else(PoisonError::into_inner).live
}

/// Why `id` does not stand for a `needed` one.
pub fn bad_handle(id: u64, needed: &str) -> Failure {
    let message = match find(id) {
        _ if id == 0 => format!("the {needed} is none (id 0): make one first"),
        Some(other) => {
            format!("the handle {id:#x} is a {}, but a {needed} is asked for: give one", other.kind().1)
        }
        None => format!("the {needed} {id:#x} was destroyed, or never was: use one that is alive"),
    };
    Failure::new(SDEF_STATUS_BAD_HANDLE, message)
}

/// The character of a handle.
pub fn character(handle: SdefCharacter) -> Outcome<Arc<RwLock<CharacterState>>> {
    match find(handle.id) {
        Some(Object::Character(character)) => Ok(character),
        _ => Err(bad_handle(handle.id, "character")),
    }
}

/// The style of a handle.
pub fn style(handle: SdefStyle) -> Outcome<Arc<Style>> {
    match find(handle.id) {
        Some(Object::Style(style)) => Ok(style),
        _ => Err(bad_handle(handle.id, "style")),
    }
}

/// The deformer of a handle.
pub fn deformer(handle: SdefDeformer) -> Outcome<Arc<RwLock<DeformerState>>> {
    match find(handle.id) {
        Some(Object::Deformer(deformer)) => Ok(deformer),
        _ => Err(bad_handle(handle.id, "deformer")),
    }
}

/// A use of a `what`, where it could be had.
fn use_of<Guard>(tried: TryLockResult<Guard>, what: &str) -> Outcome<Guard> {
    match tried {
        Ok(guard) => Ok(guard),
        // States change in steps that cannot fail halfway.
        Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => Err(Failure::new(
            SDEF_STATUS_BUSY,
            format!(
                "the {what} is in use, by another thread or by the call around this one: try again later"
            ),
        )),
    }
}

/// Use beside other uses. Nothing ever waits here, so nothing can lock up.
pub fn read<'a, T>(lock: &'a RwLock<T>, what: &str) -> Outcome<RwLockReadGuard<'a, T>> {
    use_of(lock.try_read(), what)
}

/// Use that changes, beside no other.
pub fn write<'a, T>(lock: &'a RwLock<T>, what: &str) -> Outcome<RwLockWriteGuard<'a, T>> {
    use_of(lock.try_write(), what)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn new() -> u64 {
        insert(Object::Style(Arc::new(Style::Heads(2.5)))).unwrap()
    }

    #[test]
    fn an_id_never_comes_again() {
        let mut seen = std::collections::BTreeSet::new();
        for _ in 0..1000 {
            let id = new();
            assert!(id != 0 && seen.insert(id));
            remove(id).unwrap();
            assert_eq!(remove(id).unwrap_err().status, SDEF_STATUS_BAD_HANDLE);
        }
    }

    #[test]
    fn a_slot_without_generations_left_is_left_alone() {
        let id = new();
        let (_, _, slot) = parts_of(id);
        TABLE.write().unwrap().slots[slot].generation = LAST_GENERATION;
        let last = STYLE << 56 | u64::from(LAST_GENERATION) << 32 | slot as u64;
        assert!(style(SdefStyle { id: last }).is_ok());
        remove(last).unwrap();
        for _ in 0..100 {
            let id = new();
            assert_ne!(parts_of(id).2, slot);
            remove(id).unwrap();
        }
    }

    #[test]
    fn every_bit_of_an_id_counts() {
        let id = new();
        for bit in 0..64 {
            assert!(style(SdefStyle { id: id ^ 1 << bit }).is_err(), "bit {bit}");
        }
        assert!(style(SdefStyle { id }).is_ok());
        remove(id).unwrap();
    }
}
