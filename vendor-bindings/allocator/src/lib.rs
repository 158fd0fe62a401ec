//! Memory that the allocator keeps: mimalloc gives free memory back to the system a second late, and only when more is
//! freed then.

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
