//! What a traversal has still to visit: a stack of which the first entries need no allocation and deeper ones spill.

/// A stack; `N` entries are held in place.
pub(super) struct Stack<T, const N: usize> {
    entries: [T; N],
    len: usize,
    spilled: Vec<T>,
}

impl<T: Copy + Default, const N: usize> Stack<T, N> {
    #[inline(always)]
    pub fn new() -> Self {
        Stack { entries: [T::default(); N], len: 0, spilled: Vec::new() }
    }

    #[inline(always)]
    pub fn push(&mut self, entry: T) {
        if self.len < N {
            self.entries[self.len] = entry;
            self.len += 1;
        } else {
            self.spilled.push(entry);
        }
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<T> {
        if self.len == N
            && let Some(entry) = self.spilled.pop()
        {
            return Some(entry);
        }
        self.len = self.len.checked_sub(1)?;
        Some(self.entries[self.len])
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

#[cfg(test)]
mod tests {
    use super::Stack;

    #[test]
    fn entries_come_back_last_first_also_where_they_spill() {
        let mut stack = Stack::<u32, 3>::new();
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
