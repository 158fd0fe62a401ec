//! The Embree device: version check and error messages.

use super::{EmbreeError, Version, Width};
use embree4_sys as sys;
use std::ffi::{CStr, CString, c_char, c_void};
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Maximum number of stored messages. Later ones are dropped, since the first one tells the cause.
const MESSAGE_CAPACITY: usize = 16;

/// A handle to the library and its build threads. Clones share one device; an [`super::Accel`] owns a clone.
#[derive(Clone)]
pub struct Device {
    shared: Arc<Shared>,
}

struct Shared {
    handle: sys::RTCDevice,
    version: Version,
    // The log is boxed, since Embree keeps its address.
    errors: Box<ErrorLog>,
}

// SAFETY: Embree's devices are reference-counted and their functions may be called from any thread; the log
// that the error callback writes is behind a mutex.
unsafe impl Send for Shared {}
// SAFETY: as above.
unsafe impl Sync for Shared {}

impl Device {
    /// Creates a device with `threads` build threads; 0 stands for one per hardware thread. Queries run on the caller's
    /// threads.
    ///
    /// # Errors
    /// If Embree returns no device, or its version or build is not supported by the bindings.
    pub fn new(threads: usize) -> Result<Device, EmbreeError> {
        Device::with_config(&format!("threads={threads}"))
    }

    /// Creates a device with a configuration string of `rtcNewDevice`. Tests choose an ISA with it.
    pub(super) fn with_config(config: &str) -> Result<Device, EmbreeError> {
        let config = CString::new(config).unwrap_or_default();
        // SAFETY: the string is NUL-terminated and outlives the call.
        let handle = unsafe { sys::rtcNewDevice(config.as_ptr()) };
        if handle.is_null() {
            // SAFETY: a null device stands for the calling thread's last error; both functions take it.
            let (code, message) =
                unsafe { (sys::rtcGetDeviceError(handle), text(sys::rtcGetDeviceLastErrorMessage(handle))) };
            return Err(EmbreeError::NoDevice { code: code_name(code), message });
        }
        let mut device =
            Shared { handle, version: Version { major: 0, minor: 0, patch: 0 }, errors: Box::default() };
        let property = |which| {
            // SAFETY: the handle is a live device.
            unsafe { sys::rtcGetDeviceProperty(handle, which) }
        };
        let number = u32::try_from(property(sys::RTC_DEVICE_PROPERTY_VERSION)).unwrap_or(0);
        device.version = Version { major: number / 10000, minor: number / 100 % 100, patch: number % 100 };
        if !device.version.is_supported() {
            return Err(EmbreeError::Version { found: device.version });
        }
        for (which, feature) in [
            (sys::RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED, "EMBREE_RAY_MASK"),
            (sys::RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED, "EMBREE_FILTER_FUNCTION"),
            (sys::RTC_DEVICE_PROPERTY_TRIANGLE_GEOMETRY_SUPPORTED, "EMBREE_GEOMETRY_TRIANGLE"),
        ] {
            if property(which) == 0 {
                return Err(EmbreeError::Feature { feature });
            }
        }
        let log: *const ErrorLog = &*device.errors;
        // SAFETY: the log is boxed, and `Shared::drop` unregisters the callback before the box is dropped;
        // the callback has the type that Embree requires and reads the log only through a shared reference.
        unsafe { sys::rtcSetDeviceErrorFunction(handle, Some(record_error), log.cast_mut().cast()) };
        Ok(Device { shared: Arc::new(device) })
    }

    /// Returns the version of the loaded library.
    pub fn version(&self) -> Version {
        self.shared.version
    }

    /// Returns the width of the widest native packets: sixteen with AVX-512, eight with AVX2, else four. Embree splits
    /// wider ones into single rays.
    pub fn widest_packets(&self) -> Width {
        let is_native = |which| {
            // SAFETY: the handle is a live device.
            unsafe { sys::rtcGetDeviceProperty(self.handle(), which) != 0 }
        };
        if is_native(sys::RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) {
            Width::Sixteen
        } else if is_native(sys::RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) {
            Width::Eight
        } else {
            Width::Four
        }
    }

    /// Returns the first error since the last call, if any, and discards the others.
    ///
    /// # Errors
    /// The error that Embree reported; `during` names the activity.
    pub fn check(&self, during: &'static str) -> Result<(), EmbreeError> {
        let reported = std::mem::take(&mut *self.shared.errors.lock());
        match reported.into_iter().next() {
            None => Ok(()),
            Some((code, message)) => Err(EmbreeError::Call { during, code: code_name(code), message }),
        }
    }

    pub(super) fn handle(&self) -> sys::RTCDevice {
        self.shared.handle
    }
}

impl fmt::Debug for Device {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "Embree {}", self.shared.version)
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: the handle is live and ours to release. Scenes may hold the device longer than we do (an
        // `Accel` releases its scene before its `Device`, but Embree counts by itself), so the callback is
        // unregistered first.
        unsafe {
            sys::rtcSetDeviceErrorFunction(self.handle, None, std::ptr::null_mut());
            sys::rtcReleaseDevice(self.handle);
        }
    }
}

/// Errors that the callback received, in order.
#[derive(Default)]
struct ErrorLog(Mutex<Vec<(sys::RTCError, String)>>);

impl ErrorLog {
    fn lock(&self) -> MutexGuard<'_, Vec<(sys::RTCError, String)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Records an error. Embree calls this callback from any thread.
unsafe extern "C" fn record_error(log: *mut c_void, code: sys::RTCError, message: *const c_char) {
    // SAFETY: `log` is the registered pointer, to a live `ErrorLog` that is only ever shared.
    let log = unsafe { &*log.cast::<ErrorLog>() };
    let mut reported = log.lock();
    if reported.len() < MESSAGE_CAPACITY {
        // SAFETY: Embree passes null or a NUL-terminated string that lives through the call.
        reported.push((code, unsafe { text(message) }));
    }
}

/// Returns Embree's name of an error code.
fn code_name(code: sys::RTCError) -> String {
    // SAFETY: takes any value and returns a string with static lifetime.
    unsafe { text(sys::rtcGetErrorString(code)) }
}

/// Converts a C string.
///
/// # Safety
/// `string` must be null or NUL-terminated and live through the call.
unsafe fn text(string: *const c_char) -> String {
    if string.is_null() {
        return "no message".into();
    }
    // SAFETY: not null, the rest by contract.
    unsafe { CStr::from_ptr(string) }.to_string_lossy().into_owned()
}
