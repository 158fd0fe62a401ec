//! Memory that the allocator keeps: mimalloc gives free memory back to the system after a delay, and only when more is
//! freed then.

/// Number of mimalloc's option `purge_delay`, which its bindings do not name.
const PURGE_DELAY: libmimalloc_sys::mi_option_t = 15;

/// Lets the allocator keep free memory for some milliseconds, unless its environment variable sets another time. Memory
/// that is used again meanwhile causes no page faults. Where another allocator is used, nothing happens.
pub fn keep_for(milliseconds: u16) {
    // SAFETY: it takes no pointer, and the option exists in all versions since 2.1 of the library.
    unsafe { libmimalloc_sys::mi_option_set_default(PURGE_DELAY, milliseconds.into()) }
}

/// Gives all free memory back to the system at once, that which the calling thread's own small blocks leave aside too.
/// Using it again costs page faults: a call is for the moments between large arrays. Where another allocator is used,
/// nothing happens.
pub fn give_back() {
    // SAFETY: it takes no pointer, and may be called by any thread at any time, beside others that allocate.
    unsafe { libmimalloc_sys::mi_collect(true) }
}

#[cfg(test)]
mod tests {
    #[test]
    fn memory_in_use_stays() {
        let kept: Vec<u64> = (0..1 << 20).collect();
        super::give_back();
        assert!(kept.iter().zip(0..).all(|(a, b)| *a == b));
    }
}
