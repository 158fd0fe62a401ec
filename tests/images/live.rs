//! Images in the making: watchers see all pixels of every method, and the image keeps its bits.

use crate::kit::{WorldAndView, room_with_ball, small_methods};
use lightsplat::live::LiveImage;
use lightsplat::method::{LightStore, Method};
use lightsplat::progress::Control;
use std::sync::Arc;

fn rendered(
    world: &WorldAndView,
    method: &Method,
    live: Option<Arc<LiveImage>>,
) -> lightsplat::method::Output {
    let control = Control::new();
    control.watch(live);
    method.render(world, &LightStore::default(), &world.view, &control)
}

#[test]
fn watched_images_have_the_bits_of_others_and_are_seen_before_they_are_complete() {
    let world = room_with_ball(None);
    let size = [world.view.window.width, world.view.window.height];
    for (name, method) in small_methods() {
        let live = Arc::new(LiveImage::new(size));
        let watched = rendered(&world, &method, Some(Arc::clone(&live)));
        assert_eq!(watched.color, rendered(&world, &method, None).color, "{name}");
        let seen = live.copy().expect("pixels were shown");
        assert_eq!(seen.known.pixels.len(), watched.color.pixels.len(), "{name}");
        // Several steps were seen: tiles, records, patches.
        assert!(live.changes() > 2, "{name}: {} changes", live.changes());
        // Sums of patches have another order than the image's.
        let pairs = seen.image.pixels.iter().zip(&watched.color.pixels);
        let off =
            pairs.map(|(a, b)| (*a - *b).abs().max_element() / (b.max_element() + 1e-3)).fold(0.0, f32::max);
        let is_last = matches!(name, "path" | "reconstruction" | "cache" | "records");
        assert!(!is_last || off < 1e-4, "{name}: {off}");
    }
}

#[test]
fn images_of_another_size_are_not_shown() {
    let world = room_with_ball(None);
    let live = Arc::new(LiveImage::new([world.view.window.width + 1, world.view.window.height]));
    let (_, path) = small_methods().into_iter().find(|(name, _)| *name == "path").expect("the method");
    rendered(&world, &path, Some(Arc::clone(&live)));
    assert_eq!(live.changes(), 0);
}
