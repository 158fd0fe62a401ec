//! The library's C functions that are used here, by hand after `oidn.h` of 2.0 to 2.5, whose ABI is one.

use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
use std::ffi::{OsStr, c_char, c_int, c_void};
use std::path::Path;

/// A device or filter, known to the library only.
pub type Handle = *mut c_void;

/// `OIDN_DEVICE_TYPE_CPU`.
pub const DEVICE_TYPE_CPU: c_int = 1;
/// `OIDN_FORMAT_FLOAT3`.
pub const FORMAT_FLOAT3: c_int = 3;
/// `OIDN_ERROR_NONE`.
pub const ERROR_NONE: c_int = 0;

/// glibc's flag by which a library's symbols come from its own dependencies first.
const RTLD_DEEPBIND: c_int = 8;

/// Start of the name of the module that computes on processors.
const CPU_MODULE: &str = "libOpenImageDenoise_device_cpu.so";

macro_rules! functions {
    ($($field:ident = $symbol:literal: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// Functions of a library that stays loaded until the process ends.
        #[derive(Clone, Copy)]
        pub struct Api {
            $(pub $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Api {
            fn of(library: &Library) -> Result<Api, libloading::Error> {
                Ok(Api {
                    $($field: {
                        // SAFETY: the symbol's type is that of the header.
                        *unsafe { library.get(concat!($symbol, "\0").as_bytes()) }?
                    },)*
                })
            }
        }
    };
}

functions! {
    new_device = "oidnNewDevice": fn(c_int) -> Handle;
    release_device = "oidnReleaseDevice": fn(Handle);
    set_device_bool = "oidnSetDeviceBool": fn(Handle, *const c_char, bool);
    set_device_int = "oidnSetDeviceInt": fn(Handle, *const c_char, c_int);
    get_device_int = "oidnGetDeviceInt": fn(Handle, *const c_char) -> c_int;
    get_device_error = "oidnGetDeviceError": fn(Handle, *mut *const c_char) -> c_int;
    commit_device = "oidnCommitDevice": fn(Handle);
    new_filter = "oidnNewFilter": fn(Handle, *const c_char) -> Handle;
    release_filter = "oidnReleaseFilter": fn(Handle);
    set_filter_bool = "oidnSetFilterBool": fn(Handle, *const c_char, bool);
    set_filter_int = "oidnSetFilterInt": fn(Handle, *const c_char, c_int);
    set_shared_filter_image = "oidnSetSharedFilterImage":
        fn(Handle, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);
    commit_filter = "oidnCommitFilter": fn(Handle);
    execute_filter = "oidnExecuteFilter": fn(Handle);
}

impl Api {
    /// Loads the library of that path, or of that name if it has no folder.
    pub fn load(path: &Path) -> Result<Api, String> {
        if let Some(module) = cpu_module(path) {
            keep_loaded(module.as_os_str(), RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND)?;
        }
        let library = keep_loaded(path.as_os_str(), RTLD_NOW | RTLD_LOCAL)?;
        // Version 1 lacks some.
        Api::of(library).map_err(|e| format!("it is not version 2: {e}"))
    }
}

/// Loads a library for the rest of the process: the threads that these start survive their devices.
fn keep_loaded(path: &OsStr, flags: c_int) -> Result<&'static Library, String> {
    // SAFETY: initialisers of these libraries set up their own tables only.
    let library = unsafe { Library::open(Some(path), flags) }.map_err(|e| e.to_string())?;
    Ok(Box::leak(Box::new(library)))
}

/// The module beside the library that computes on processors.
///
/// The library would load it by itself, but with the symbols of the TBB that Embree has brought in, of another version
/// than the module was built with. Loaded before, and bound to its own TBB, it is found to be there already.
fn cpu_module(library: &Path) -> Option<std::path::PathBuf> {
    let folder = library.parent().filter(|folder| !folder.as_os_str().is_empty())?;
    let is_module = |path: &Path| {
        path.file_name().and_then(OsStr::to_str).is_some_and(|name| name.starts_with(CPU_MODULE))
    };
    let mut modules: Vec<_> = std::fs::read_dir(folder)
        .ok()?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|p| is_module(p))
        .collect();
    modules.sort_unstable();
    modules.into_iter().next()
}
