//! A memo of one value, valid for one key.

use base::progress::Control;
use std::sync::{Arc, Mutex, PoisonError};

/// A value with the key that it was made for, if there is one.
pub type Memo<K, V> = Mutex<Option<(K, Arc<V>)>>;

/// Returns the value of `memo` if it was made for `key`. Otherwise makes it, and stores it unless cancelled.
pub fn recall<K: PartialEq, V>(
    memo: &Memo<K, V>,
    key: K,
    control: &Control,
    make: impl FnOnce(&K) -> V,
) -> Arc<V> {
    // Values are complete when they are stored: a panic elsewhere cannot have left them half-made.
    let mut stored = memo.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((made_for, value)) = &*stored
        && *made_for == key
    {
        return Arc::clone(value);
    }
    let value = Arc::new(make(&key));
    *stored = (!control.is_cancelled()).then(|| (key, Arc::clone(&value)));
    value
}

/// Drops the value of `memo`.
pub fn forget<K, V>(memo: &Memo<K, V>) {
    *memo.lock().unwrap_or_else(PoisonError::into_inner) = None;
}
