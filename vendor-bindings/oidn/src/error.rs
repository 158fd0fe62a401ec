//! Errors, each with its remedy.

/// Reason why there is no denoiser, or no denoised picture.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The folder that the user chose holds no library that fits.
    #[error(
        "OIDN_DIR={directory} holds no Open Image Denoise 2 ({tried}): correct it, or unset it and run `make setup`"
    )]
    NotInChosenFolder {
        /// Value of the variable.
        directory: String,
        /// Places tried, and why each failed.
        tried: String,
    },
    /// No library that fits was found.
    #[error(
        "no Open Image Denoise 2 was found ({tried}): run `make setup` in the repository, or set OIDN_DIR to the folder \
         that holds libOpenImageDenoise.so.2"
    )]
    NotFound {
        /// Places tried, and why each failed.
        tried: String,
    },
    /// The library reported an error.
    #[error("Open Image Denoise failed while {during}: {message} (error {code})")]
    Call {
        /// Activity during which it failed.
        during: &'static str,
        /// The library's number of the error.
        code: i32,
        /// The library's explanation.
        message: String,
    },
    /// An image has not the picture's size.
    #[error("the {image} has {}x{} pixels, and the image {}x{}", size[0], size[1], picture[0], picture[1])]
    Size {
        /// Name of the image.
        image: &'static str,
        /// Columns and rows of the image; pixels in one row where no more is known.
        size: [usize; 2],
        /// Columns and rows of the picture.
        picture: [usize; 2],
    },
}
