//! Contact sheets of frames.

use super::Sandbox;
use image::{Rgb, RgbImage};

#[test]
fn frames_stand_in_rows_in_their_order_and_all_have_to_be_there() {
    let sandbox = Sandbox::new();
    for frame in 1..=5u8 {
        RgbImage::from_pixel(40, 20, Rgb([50 * frame; 3]))
            .save(sandbox.path(&format!("f.{frame:02}.png")))
            .unwrap();
    }
    let sheet = |more: &[&str]| sandbox.run(&[&["sheet", "f.##.exr", "-o", "s.png"], more].concat());
    sheet(&["--frames", "1-5", "--columns", "2", "--width", "20"]).expect(0);
    let picture = image::open(sandbox.path("s.png")).unwrap().into_rgb8();
    assert_eq!(picture.dimensions(), (4 + 2 * 24, 4 + 3 * 14));
    for frame in 1..=5u32 {
        let (column, row) = ((frame - 1) % 2, (frame - 1) / 2);
        let value = |x: u32, y: u32| u32::from(picture.get_pixel(4 + column * 24 + x, 4 + row * 14 + y)[0]);
        assert_eq!([value(0, 0), value(19, 9)], [50 * frame; 2]);
    }
    // Unless it is said otherwise, frames are no larger than they are and the sheet is about 16:9.
    sheet(&["--frames", "1-5"]).expect(0);
    let (width, height) = image::image_dimensions(sandbox.path("s.png")).unwrap();
    assert_eq!((width, height), (4 + 2 * 44, 4 + 3 * 24));
    assert!(sheet(&["--frames", "4-6"]).expect(3).stderr.contains("f.06.png"));
    assert!(
        sandbox.run(&["sheet", "f.##.exr", "-o", "s.exr", "--frames", "1"]).expect(2).stderr.contains(".png")
    );
    assert!(sheet(&[]).expect(2).stderr.contains("--frames"));
}
