//! A value that is kept for as long as the same is wanted.

use base::progress::Control;
use std::sync::{Arc, Mutex, PoisonError};

/// The value in a store if it was made for the same, or one made anew, which stays in the store unless cancelled.
pub(super) fn kept<K: PartialEq, V>(
    store: &Mutex<Option<(K, Arc<V>)>>,
    wanted: K,
    control: &Control,
    make: impl FnOnce(&K) -> V,
) -> Arc<V> {
    // Values are complete when they are stored: a panic elsewhere cannot have left them half-made.
    let mut kept = store.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((made_for, value)) = &*kept
        && *made_for == wanted
    {
        return Arc::clone(value);
    }
    let value = Arc::new(make(&wanted));
    *kept = (!control.is_cancelled()).then(|| (wanted, Arc::clone(&value)));
    value
}
