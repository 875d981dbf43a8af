//! What a traversal has still to visit: a stack of which the first entries need no allocation and deeper ones spill.

/// A stack; `N` entries are held in place, the rest in a vector that its owner lends: apart from it, so that the length stays in a register.
pub(super) struct Stack<'s, T, const N: usize> {
    entries: [T; N],
    len: usize,
    spilled: &'s mut Vec<T>,
}

impl<'s, T: Copy + Default, const N: usize> Stack<'s, T, N> {
    #[inline(always)]
    pub fn new(spilled: &'s mut Vec<T>) -> Self {
        Stack { entries: [T::default(); N], len: 0, spilled }
    }

    #[inline(always)]
    pub fn push(&mut self, entry: T) {
        if self.len < N {
            self.entries[self.len] = entry;
            self.len += 1;
        } else {
            spill(self.spilled, entry);
        }
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<T> {
        if self.len == N
            && let Some(entry) = unspill(self.spilled)
        {
            return Some(entry);
        }
        self.len = self.len.checked_sub(1)?;
        self.entries.get(self.len).copied()
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

    /// Those held in place from one on.
    #[inline(always)]
    pub fn above(&mut self, bottom: usize) -> &mut [T] {
        &mut self.entries[bottom..self.len]
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
    use super::Stack;

    #[test]
    fn entries_come_back_last_first_also_where_they_spill() {
        let mut spilled = Vec::new();
        let mut stack = Stack::<u32, 3>::new(&mut spilled);
        for round in 1..8 {
            (0..round).for_each(|i| stack.push(i));
            let all: Vec<u32> = std::iter::from_fn(|| stack.pop()).collect();
            assert_eq!(all, (0..round).rev().collect::<Vec<_>>());
        }
        (0..7).for_each(|i| stack.push(i));
        assert_eq!(stack.next(|i| *i < 2), Some(1));
        assert_eq!((stack.len(), stack.above(0)), (1, &mut [0][..]));
    }
}
