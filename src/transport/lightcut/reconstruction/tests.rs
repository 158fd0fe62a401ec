//! Points among the anchors must gather nearly the light of cuts of their own.

use super::*;
use crate::lightcut::fixtures::{Ball, EXACT, RandomNumbers, rms, room};
use crate::lightcut::{Lightcut, Receiver};
use crate::lights::LightTrees;
use base::math::{Frame, LANES, luminance};
use base::progress::Control;
use glam::Vec3;

/// Points of a lattice above the floor, eight a row.
fn lattice(count: usize) -> Vec<Receiver<'static>> {
    let frame = Frame::from_normal(Vec3::Z);
    let at = |i: usize| Vec3::new(0.3 + 0.02 * (i % 8) as f32, 0.4 + 0.02 * (i / 8) as f32, 0.01);
    (0..count).map(|i| Receiver::irradiance(at(i), Vec3::Z, &frame)).collect()
}

#[test]
fn points_gather_nearly_the_light_of_cuts_of_their_own() {
    let mut numbers = RandomNumbers(77);
    let ball = Ball { centre: Vec3::new(0.5, 0.5, 0.6), radius: 0.15 };
    let trees = LightTrees::build(&[room(3000, &mut numbers)], Vec::new(), 1.7, &Control::new());
    let transfer = Transfer::new(&trees, 1.7);
    let receivers = lattice(32);
    let (mut packet, mut points) = (Lightcut::new(), ReceiverPacket::new());
    let mut reconstruction = ReconstructionCut::default();
    points.set(receivers.iter().step_by(2).copied());
    let cut = packet.gather(&transfer, &ball, &points, &EXACT);
    reconstruction.set(&transfer, &points, &cut, &EXACT);
    let (own, mut again) = (cut.sum, reconstruction.gather(&transfer, &ball, &points, 0.5));
    assert!(reconstruction.counts.rays < packet.counts.rays / 2, "most clusters are agreed upon");
    let close = |own: &PacketSum, again: &PacketSum| {
        for (own, again) in own.radiance.iter().zip(&again.radiance) {
            assert!((*own - *again).abs().max_element() < 0.04 * own.max_element(), "{own} {again}");
        }
    };
    close(&own, &again);
    // The points in between, against cuts of their own.
    points.set(receivers.iter().skip(1).step_by(2).copied());
    again = reconstruction.gather(&transfer, &ball, &points, 0.5);
    close(&packet.gather(&transfer, &ball, &points, &EXACT).sum, &again);
}

#[test]
fn sampled_clusters_are_right_on_average() {
    // Half in the shadow of a ball: the anchors disagree about many small clusters.
    let mut numbers = RandomNumbers(78);
    let ball = Ball { centre: Vec3::new(0.5, 0.5, 0.25), radius: 0.15 };
    let trees = LightTrees::build(&[room(3000, &mut numbers)], Vec::new(), 1.7, &Control::new());
    let transfer = Transfer::new(&trees, 1.7);
    let receivers = lattice(64);
    let (mut packet, mut points) = (Lightcut::new(), ReceiverPacket::new());
    let mut reconstruction = ReconstructionCut::default();
    points.set(receivers.iter().skip(1).step_by(4).copied());
    let cut = packet.gather(&transfer, &ball, &points, &EXACT);
    reconstruction.set(&transfer, &points, &cut, &EXACT);
    points.set(receivers.iter().skip(3).step_by(4).copied());
    // A reference: all clusters, each with a shadow ray.
    let exact: Vec<f32> = (0..LANES)
        .map(|lane| {
            let given = |cluster: &PacketCluster| {
                let n = &trees.nodes[cluster.node as usize];
                let vpl = &trees.vpls[n.representative()];
                let seen = points.visible(&ball, 1 << lane, vpl, n);
                let response = transfer.unshadowed(points.get(lane), vpl, n.kind());
                if seen != 0 { luminance(n.intensity * response) } else { 0.0 }
            };
            cut.clusters.iter().map(given).sum()
        })
        .collect();
    let starts = 256;
    let (mut means, mut squares) = ([0.0f32; LANES], 0.0);
    for start in 0..starts {
        let start = (start as f32 + 0.5) / starts as f32;
        let PacketSum { radiance, .. } = reconstruction.gather(&transfer, &ball, &points, start);
        for lane in 0..LANES {
            let error = luminance(radiance[lane]) / exact[lane] - 1.0;
            means[lane] += error / starts as f32;
            squares += error * error / (starts * LANES) as f32;
        }
    }
    let (rays, size) = (reconstruction.counts.rays / starts as u64, cut.clusters.len());
    assert!(rays < (size * LANES / 4) as u64, "{rays} rays for {size} clusters");
    // The random residue of a patch half in shadow is a few times ε; on average, a tenth of it.
    assert!(squares.sqrt() < 0.06 && squares.sqrt() > 0.001, "{}", squares.sqrt());
    // Odd lanes are beyond the last anchors, dependent on light that no anchor sees.
    let among: Vec<f32> = means.into_iter().step_by(2).collect();
    assert!(rms(&among) < 0.003, "{means:?}");
}
