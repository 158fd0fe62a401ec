//! The CPU device and its filter.

use crate::api::{Api, DEVICE_TYPE_CPU, ERROR_NONE, FORMAT_FLOAT3, Handle};
use crate::{Error, locate};
use std::ffi::{CStr, c_int, c_void};
use std::fmt;
use std::path::Path;
use std::ptr;

/// Memory that the filter may take, in MB. Large pictures are then denoised in parts, as fast as whole ones, which
/// would take three times as much at 2048x2048 pixels.
const MAX_MEMORY: c_int = 600;

/// Quality of the filter, against its time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quality {
    /// The smallest network.
    Fast,
    /// A network in between.
    Balanced,
    /// The largest network, where both guides are free of noise; that of `Balanced` elsewhere.
    #[default]
    High,
}

impl Quality {
    /// The number that a version of the library has for it, or for the next that it knows.
    fn number(self, version: Version) -> c_int {
        match self {
            Quality::Fast if (version.major, version.minor) >= (2, 3) => 4,
            Quality::Fast | Quality::Balanced => 5,
            Quality::High => 6,
        }
    }
}

/// Version of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Version {
    /// Changes where programs must.
    pub major: i32,
    /// Changes with features.
    pub minor: i32,
    /// Changes with corrections.
    pub patch: i32,
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}

/// The library's device that computes on processors.
pub struct Device {
    api: Api,
    handle: Handle,
    version: Version,
}

/// A picture and its guides.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Linear radiance by pixel, of any magnitude, finite and not negative.
    pub color: &'a [[f32; 3]],
    /// Share of light reflected by the surfaces seen, 0 to 1.
    pub albedo: Option<&'a [[f32; 3]]>,
    /// Normals of the visible surfaces, components from -1 to 1; left out where there is no albedo, as the library
    /// asks.
    pub normal: Option<&'a [[f32; 3]]>,
    /// True if albedo and normals have no noise.
    pub clean_guides: bool,
    /// Quality wanted.
    pub quality: Quality,
}

impl Device {
    /// Finds the library and makes its CPU device, which will use `threads` threads, 0 for all processors, and pin
    /// none.
    ///
    /// # Errors
    /// If no library of version 2 with a CPU device is found, with the places tried and the remedy.
    pub fn load(threads: usize) -> Result<Device, Error> {
        locate::first(|path| Device::open(path, threads))
    }

    /// Version of the library.
    pub fn version(&self) -> Version {
        self.version
    }

    fn open(path: &Path, threads: usize) -> Result<Device, String> {
        let api = Api::load(path)?;
        // SAFETY: any type is a valid argument.
        let handle = unsafe { (api.new_device)(DEVICE_TYPE_CPU) };
        if handle.is_null() {
            let (_, message) = take_error(&api, handle).unwrap_or_default();
            return Err(format!("it has no CPU device: {message}"));
        }
        let mut device = Device { api, handle, version: Version { major: 0, minor: 0, patch: 0 } };
        // SAFETY: the device is alive, the names are NUL-terminated, and both parameters exist on the CPU device.
        unsafe {
            (api.set_device_int)(handle, c"numThreads".as_ptr(), c_int::try_from(threads).unwrap_or(0));
            (api.set_device_bool)(handle, c"setAffinity".as_ptr(), false);
            (api.commit_device)(handle);
        }
        device.check("making its CPU device").map_err(|e| e.to_string())?;
        let number = |name: &CStr| {
            // SAFETY: as above.
            unsafe { (api.get_device_int)(handle, name.as_ptr()) }
        };
        let [major, minor, patch] = [c"versionMajor", c"versionMinor", c"versionPatch"].map(number);
        device.version = Version { major, minor, patch };
        match major {
            2 => Ok(device),
            _ => Err(format!("it is version {}, and not 2", device.version)),
        }
    }

    /// The picture without noise.
    ///
    /// # Errors
    /// If an image has not as many pixels as the picture, or the library fails, for lack of memory for example.
    pub fn denoise(&self, picture: &Picture) -> Result<Vec<[f32; 3]>, Error> {
        let Picture { size, color, albedo, .. } = *picture;
        let normal = picture.normal.filter(|_| albedo.is_some());
        let inputs = [(c"color", Some(color)), (c"albedo", albedo), (c"normal", normal)];
        for (name, image) in inputs {
            if let Some(image) = image
                && Some(image.len()) != size[0].checked_mul(size[1])
            {
                let (name, pixels) = (name.to_str().unwrap_or_default(), image.len());
                return Err(Error::Size { image: name, size: [pixels, 1], picture: size });
            }
        }
        let mut output = vec![[0.0; 3]; color.len()];
        // SAFETY: the device is alive and the name NUL-terminated.
        let handle = unsafe { (self.api.new_filter)(self.handle, c"RT".as_ptr()) };
        let filter = Filter { api: self.api, handle };
        self.check("making its filter")?;
        for (name, image) in inputs {
            if let Some(image) = image {
                filter.set_image(name, image.as_ptr().cast_mut().cast(), size);
            }
        }
        filter.set_image(c"output", output.as_mut_ptr().cast(), size);
        filter.set_bool(c"hdr", true);
        filter.set_bool(c"cleanAux", picture.clean_guides && normal.is_some());
        // SAFETY: the filter is alive and the names are NUL-terminated.
        unsafe {
            (self.api.set_filter_int)(filter.handle, c"maxMemoryMB".as_ptr(), MAX_MEMORY);
            (self.api.set_filter_int)(
                filter.handle,
                c"quality".as_ptr(),
                picture.quality.number(self.version),
            );
        }
        // SAFETY: the filter is alive. Its images have the size that it was told, and live as long as this function,
        // which the filter does not outlive; it writes to the output alone, which nothing else refers to.
        unsafe { (self.api.commit_filter)(filter.handle) };
        self.check("preparing its filter")?;
        // SAFETY: as above.
        unsafe { (self.api.execute_filter)(filter.handle) };
        self.check("denoising")?;
        Ok(output)
    }

    /// Fails if the library has reported an error since the last call.
    fn check(&self, during: &'static str) -> Result<(), Error> {
        take_error(&self.api, self.handle)
            .map_or(Ok(()), |(code, message)| Err(Error::Call { during, code, message }))
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: made by this library, released once, and no filter is left.
        unsafe { (self.api.release_device)(self.handle) };
    }
}

/// A filter of a device that outlives it.
struct Filter {
    api: Api,
    handle: Handle,
}

impl Filter {
    fn set_image(&self, name: &CStr, pixels: *mut c_void, [width, height]: [usize; 2]) {
        // SAFETY: the library keeps the address and reads nothing before the filter runs; the filter is alive and the
        // name NUL-terminated.
        unsafe {
            (self.api.set_shared_filter_image)(
                self.handle,
                name.as_ptr(),
                pixels,
                FORMAT_FLOAT3,
                width,
                height,
                0,
                0,
                0,
            );
        }
    }

    fn set_bool(&self, name: &CStr, value: bool) {
        // SAFETY: the filter is alive and the name NUL-terminated.
        unsafe { (self.api.set_filter_bool)(self.handle, name.as_ptr(), value) };
    }
}

impl Drop for Filter {
    fn drop(&mut self) {
        // SAFETY: made by this library and released once.
        unsafe { (self.api.release_filter)(self.handle) };
    }
}

/// The first error since the last call, and its text; a null device stands for the calling thread's last error.
fn take_error(api: &Api, device: Handle) -> Option<(i32, String)> {
    let mut message = ptr::null();
    // SAFETY: the device is alive or null, which both are allowed, and the address is that of a pointer.
    let code = unsafe { (api.get_device_error)(device, &mut message) };
    if code == ERROR_NONE {
        return None;
    }
    let text = if message.is_null() {
        String::new()
    } else {
        // SAFETY: a NUL-terminated string of the library's that lives until its next call on this thread.
        unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned()
    };
    Some((code, text))
}
