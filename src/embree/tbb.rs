//! The library that runs the tasks of Embree.

use libloading::os::unix::{Library, Symbol};
use std::ffi::{CStr, c_char};

/// Returns the version of TBB that Embree has loaded; `None` if Embree was built with other tasks.
pub fn tbb_version() -> Option<String> {
    // SAFETY: oneTBB declares `const char* TBB_runtime_version(void)` since 2021.1.
    let version: Symbol<unsafe extern "C" fn() -> *const c_char> =
        unsafe { Library::this().get(b"TBB_runtime_version\0") }.ok()?;
    // SAFETY: the function takes nothing and returns a constant text that ends in NUL.
    let text = unsafe { CStr::from_ptr(version()) };
    Some(text.to_string_lossy().into_owned())
}
