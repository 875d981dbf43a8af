//! Memory for what rays read here and there: where it is large, on pages so large that a processor remembers where all of them are. Changes nothing
//! but time. One of the rooms with unsafe code: the system has no safe way to be asked.

/// A large page, bytes.
const PAGE: usize = 2 << 20;

/// A small one, at which what is asked for must begin; an allocator puts less than that around a large block.
#[cfg(target_os = "linux")]
const SMALL_PAGE: usize = 1 << 12;

/// An empty vector with room for so many.
pub(super) fn with_room<T>(count: usize) -> Vec<T> {
    if count.saturating_mul(size_of::<T>()) < PAGE {
        Vec::with_capacity(count)
    } else {
        on_large_pages(count)
    }
}

#[cfg(not(target_os = "linux"))]
fn on_large_pages<T>(count: usize) -> Vec<T> {
    Vec::with_capacity(count)
}

/// Up to a multiple of large pages, at which the system lets a block begin only then.
#[cfg(target_os = "linux")]
fn on_large_pages<T>(count: usize) -> Vec<T> {
    let bytes = (count * size_of::<T>() + SMALL_PAGE).next_multiple_of(PAGE) - SMALL_PAGE;
    let room = Vec::with_capacity(bytes / size_of::<T>());
    let start = room.as_ptr() as usize;
    let first = start.next_multiple_of(SMALL_PAGE);
    let length = (start + bytes).next_multiple_of(SMALL_PAGE) - first;
    // SAFETY: nothing has been written there, and what is asked for is how it is to be kept. Where that is refused, pages are small.
    #[allow(unsafe_code, reason = "the system has no safe way to be asked")]
    unsafe {
        libc::madvise(first as *mut libc::c_void, length, libc::MADV_HUGEPAGE);
    }
    room
}

/// The same in memory of its size, which is as [`with_room`] gives it.
pub(super) fn settled<T>(mut all: Vec<T>) -> Vec<T> {
    if size_of_val(&*all) < PAGE {
        all.shrink_to_fit();
        return all;
    }
    let mut room = with_room(all.len());
    room.extend(all);
    room
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_large_keeps_what_it_holds() {
        for count in [0, 1, 1000, PAGE / 8 - 1, PAGE / 8, PAGE / 8 + 1, 5 * PAGE / 8] {
            let mut all = with_room::<u64>(count);
            assert!(all.is_empty() && all.capacity() >= count);
            all.extend(0..count as u64);
            assert!(settled(all).into_iter().eq(0..count as u64), "{count}");
        }
    }
}
