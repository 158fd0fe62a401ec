//! Keys of `transforms.json`, of the file and of its frames. Most writers agree on these names, and no document defines
//! them.

use crate::statements::{Fate, Statement};

const fn read(name: &'static str, note: &'static str) -> Statement {
    Statement { name, fate: Fate::Read, note }
}

const fn unused(name: &'static str, note: &'static str) -> Statement {
    Statement { name, fate: Fate::NoEffect, note }
}

const fn named(name: &'static str, note: &'static str) -> Statement {
    Statement { name, fate: Fate::Named, note }
}

/// Replacement of all distortion of lenses.
const STRAIGHT: &str = "the image has no distortion";

/// The keys.
pub const STATEMENTS: &[Statement] = &[
    read("frames", "one view each"),
    read("file_path", "name of the image, in folders below the output folder"),
    read("transform_matrix", "from the camera, which looks along -z with y up, to the scene"),
    read("camera_angle_x", "horizontal field of view in radians, unless there is `fl_x`"),
    read("camera_angle_y", "vertical field of view in radians; with `camera_angle_x`, `w` and `h`"),
    read("fl_x", "focal length in pixels"),
    read("fl_y", "focal length in pixels along y; by default `fl_x`"),
    read("cx", "principal point in pixels from the left; by default the middle"),
    read("cy", "principal point in pixels from the top; by default the middle"),
    read("w", "width in pixels; by default the width of the scene's film"),
    read("h", "height in pixels; by default the height of the scene's film"),
    read("camera_model", "a perspective model; else named"),
    named("k1", STRAIGHT),
    named("k2", STRAIGHT),
    named("k3", STRAIGHT),
    named("k4", STRAIGHT),
    named("k5", STRAIGHT),
    named("k6", STRAIGHT),
    named("p1", STRAIGHT),
    named("p2", STRAIGHT),
    named("distortion_params", STRAIGHT),
    named("is_fisheye", "the image is a perspective one"),
    named("orientation_override", "cameras are as `transform_matrix` says"),
    named("applied_transform", "cameras are as `transform_matrix` says"),
    named("applied_scale", "cameras are as `transform_matrix` says"),
    named("time", "the scene stands still"),
    unused("aabb_scale", "a bound of the reconstruction"),
    unused("scale", "a scale of the reconstruction"),
    unused("offset", "an offset of the reconstruction"),
    unused("rotation", "a turntable's step, which `transform_matrix` has, too"),
    unused("sharpness", "of the photograph"),
    unused("mask_path", "a mask of the photograph"),
    unused("depth_file_path", "a depth image of the photograph"),
    unused("depth_path", "a depth image of the photograph"),
    unused("colmap_im_id", "a number in COLMAP"),
    unused("camera_id", "a number in COLMAP"),
    unused("ply_file_path", "points of the reconstruction"),
    unused("train_filenames", "a part of the frames for training"),
    unused("val_filenames", "a part of the frames for validation"),
    unused("test_filenames", "a part of the frames for tests"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statements::assert_page_lists;

    #[test]
    fn the_page_lists_every_key() {
        assert_page_lists("Lists of cameras", STATEMENTS);
    }
}
