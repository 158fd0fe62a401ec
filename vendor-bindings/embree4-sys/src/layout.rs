//! Layouts that the hand-written callers rely on, checked apart from bindgen's own assertions: those follow
//! the headers wherever they go, these must not.

use crate::*;
use core::mem::{align_of, offset_of, size_of};

macro_rules! layout {
    ($($name:ident: size $size:literal, align $align:literal $(, $field:ident at $offset:literal)*;)*) => {
        $(const _: () = {
            assert!(size_of::<$name>() == $size);
            assert!(align_of::<$name>() == $align);
            $(assert!(offset_of!($name, $field) == $offset);)*
        };)*
    };
}

#[cfg(target_pointer_width = "64")]
layout! {
    RTCRay: size 48, align 16, org_x at 0, tnear at 12, dir_x at 16, time at 28, tfar at 32, mask at 36, id at 40, flags at 44;
    RTCHit: size 48, align 16, Ng_x at 0, u at 12, v at 16, primID at 20, geomID at 24, instID at 28, instPrimID at 32;
    RTCRayHit: size 96, align 16, ray at 0, hit at 48;
    RTCRay4: size 192, align 16, org_x at 0, tnear at 48, dir_x at 64, time at 112, tfar at 128, mask at 144, id at 160, flags at 176;
    RTCRay8: size 384, align 32, org_x at 0, tnear at 96, dir_x at 128, time at 224, tfar at 256, mask at 288, id at 320, flags at 352;
    RTCRay16: size 768, align 64, org_x at 0, tnear at 192, dir_x at 256, time at 448, tfar at 512, mask at 576, id at 640, flags at 704;
    RTCHit4: size 144, align 16, Ng_x at 0, u at 48, v at 64, primID at 80, geomID at 96, instID at 112, instPrimID at 128;
    RTCRayHit4: size 336, align 16, ray at 0, hit at 192;
    RTCHit8: size 288, align 32, Ng_x at 0, u at 96, v at 128, primID at 160, geomID at 192, instID at 224, instPrimID at 256;
    RTCRayHit8: size 672, align 32, ray at 0, hit at 384;
    RTCHit16: size 576, align 64, Ng_x at 0, u at 192, v at 256, primID at 320, geomID at 384, instID at 448, instPrimID at 512;
    RTCRayHit16: size 1344, align 64, ray at 0, hit at 768;
    RTCRayQueryContext: size 8, align 4, instID at 0, instPrimID at 4;
    RTCIntersectArguments: size 32, align 8, flags at 0, feature_mask at 4, context at 8, filter at 16, intersect at 24;
    RTCOccludedArguments: size 32, align 8, flags at 0, feature_mask at 4, context at 8, filter at 16, occluded at 24;
    RTCFilterFunctionNArguments: size 48, align 8, valid at 0, geometryUserPtr at 8, context at 16, ray at 24, hit at 32, N at 40;
    RTCBounds: size 32, align 16, lower_x at 0, upper_x at 16;
}
