//! What a traversal has still to visit: a stack of which the first entries need no allocation and deeper ones spill. One of the rooms with unsafe code:
//! to clear entries that are written before they are read takes a fiftieth of the time of a short walk.

use std::mem::MaybeUninit;

/// Entries that an owner lends. They begin a cache line, and so that they do, all that a walk keeps beside them does or lies within one: else it is
/// left to who calls whether the numbers of a ray lie across two, which costs a tenth of the time of a walk.
#[repr(align(64))]
pub(super) struct Held<T, const N: usize>([MaybeUninit<T>; N]);

impl<T, const N: usize> Held<T, N> {
    /// Entries of which none has been written.
    #[inline(always)]
    pub fn new() -> Self {
        Held([const { MaybeUninit::uninit() }; N])
    }
}

/// A stack; `N` entries need no allocation, the rest are in a vector. Its owner lends both: apart from it, so that the length stays in a register.
pub(super) struct Stack<'s, T, const N: usize> {
    entries: &'s mut [MaybeUninit<T>; N],
    /// So many have been written.
    len: usize,
    spilled: &'s mut Vec<T>,
}

impl<'s, T: Copy, const N: usize> Stack<'s, T, N> {
    /// Empty, whatever `entries` holds.
    #[inline(always)]
    pub fn on(Held(entries): &'s mut Held<T, N>, spilled: &'s mut Vec<T>) -> Self {
        Stack { entries, len: 0, spilled }
    }

    #[inline(always)]
    pub fn push(&mut self, entry: T) {
        if self.len < N {
            self.entries[self.len].write(entry);
            self.len += 1;
        } else {
            spill(self.spilled, entry);
        }
    }

    /// Pushes an entry so that those from `bottom` on stay in order, the largest first. Where some have spilled, no order is kept.
    #[inline(always)]
    pub fn push_above(&mut self, bottom: usize, entry: T)
    where
        T: PartialOrd,
    {
        let mut at = self.len;
        self.push(entry);
        while at > bottom && at < N && self.written(at - 1) < entry {
            self.entries[at] = self.entries[at - 1];
            at -= 1;
            self.entries[at].write(entry);
        }
    }

    /// The last entry; those that spilled come last of all.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<T> {
        let Some(len) = self.len.checked_sub(1) else {
            return if self.spilled.is_empty() { None } else { unspill(self.spilled) };
        };
        let last = self.written(len);
        self.len = len;
        Some(last)
    }

    /// One of the entries that have been written.
    #[inline(always)]
    fn written(&self, at: usize) -> T {
        debug_assert!(at < self.len && self.len <= N, "entry {at} of {}", self.len);
        // SAFETY: so it is, and each before the length has been written.
        #[allow(unsafe_code, reason = "there is no safe way to what may not have been written")]
        unsafe {
            self.entries.get_unchecked(at).assume_init()
        }
    }

    /// The last entry that still matters; those above it are dropped.
    #[inline(always)]
    pub fn next(&mut self, matters: impl Fn(&T) -> bool) -> Option<T> {
        loop {
            let entry = self.pop()?;
            if matters(&entry) {
                return Some(entry);
            }
        }
    }

    /// How many are held in place.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }
}

#[cold]
#[inline(never)]
fn spill<T>(spilled: &mut Vec<T>, entry: T) {
    spilled.push(entry);
}

#[cold]
#[inline(never)]
fn unspill<T>(spilled: &mut Vec<T>) -> Option<T> {
    spilled.pop()
}

#[cfg(test)]
mod tests {
    use super::{Held, Stack};

    #[test]
    fn entries_come_back_last_first_and_then_those_that_spilled() {
        let (mut held, mut spilled) = (Held::new(), Vec::new());
        let mut stack = Stack::<u32, 3>::on(&mut held, &mut spilled);
        for round in 1..8 {
            (0..round).for_each(|i| stack.push(i));
            let all: Vec<u32> = std::iter::from_fn(|| stack.pop()).collect();
            assert_eq!(all, (0..round.min(3)).rev().chain((3..round).rev()).collect::<Vec<_>>());
        }
        (0..7).for_each(|i| stack.push(i));
        assert_eq!(stack.next(|i| *i < 2), Some(1));
        assert_eq!(stack.len(), 1);
        [5, 9, 7].into_iter().for_each(|i| stack.push_above(1, i));
        let all: Vec<u32> = std::iter::from_fn(|| stack.pop()).collect();
        assert_eq!(all, [5, 9, 0, 7, 6, 5, 4, 3], "there was no room for 7");
    }
}
