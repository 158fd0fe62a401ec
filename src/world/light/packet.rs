//! Next-event estimation for sixteen points at once.

use super::direct::{DirectSample, DirectSamples16};
use super::emitters::Emitters;
use super::receivers::Receivers16;
use super::triangles::Triangles16;
use base::math::{F32x16, LANES, Mask16, Rgb, U32x16, V3, Vec2x16, lanes_in, lanes_with, mask_of};
use glam::Vec3;

impl Emitters {
    /// Samples light arriving at points in the lanes of `wanted`, without a visibility test.
    #[inline]
    pub fn sample_direct(
        &self,
        at: Receivers16,
        u_choice: &F32x16,
        u: &Vec2x16,
        wanted: u16,
    ) -> DirectSamples16 {
        let (chosen, choice) = self.choice.sample(at, u_choice, wanted);
        self.sample_chosen(at, &chosen, &choice, u, wanted)
    }

    /// Samples light in all lanes whose chosen emitter is `is_wanted`. Returns the chosen emitters, too.
    pub fn sample_of(
        &self,
        at: Receivers16,
        u_choice: &F32x16,
        u: &Vec2x16,
        is_wanted: impl Fn(u32) -> bool,
    ) -> (U32x16, DirectSamples16) {
        let (chosen, choice) = self.choice.sample(at, u_choice, u16::MAX);
        let wanted = mask_of(&chosen.map(|emitter| u32::from(is_wanted(emitter))));
        (chosen, self.sample_chosen(at, &chosen, &choice, u, wanted))
    }

    /// Samples light in all lanes whose chosen emitter is not the environment. Returns the chosen emitters, too.
    pub fn sample_without_environment(
        &self,
        at: Receivers16,
        u_choice: &F32x16,
        u: &Vec2x16,
    ) -> (U32x16, DirectSamples16) {
        self.sample_of(at, u_choice, u, |emitter| emitter != self.environment_index())
    }

    /// Samples the light of emitters that were `chosen` with probability `choice`, in the lanes of `wanted`.
    #[inline]
    fn sample_chosen(
        &self,
        at: Receivers16,
        chosen: &U32x16,
        choice: &F32x16,
        u: &Vec2x16,
        wanted: u16,
    ) -> DirectSamples16 {
        let (mut possible, mut on_areas, count) = ([0; LANES], [0; LANES], self.areas.len() as u32);
        for i in 0..LANES {
            possible[i] = u32::from(choice[i] > 0.0);
            on_areas[i] = u32::from(chosen[i] < count);
        }
        let possible = wanted & mask_of(&possible);
        let near = possible & mask_of(&on_areas);
        let far = possible & lanes_with(chosen, self.environment_index());
        let mut samples = DirectSamples16::default();
        if near != 0 {
            self.sample_areas(at, chosen, choice, u, near, &mut samples);
        }
        for lane in lanes_in(possible & !near & !far) {
            let light = &self.deltas[chosen[lane] as usize - self.areas.len()];
            samples.set(lane, DirectSample::delta(light, at.position.get(lane), choice[lane]));
        }
        if far != 0 {
            self.sample_environment(at, u, choice, far, &mut samples);
        }
        samples
    }

    /// Samples the light of area lights that were `chosen` with probability `choice`, in the lanes of `wanted`.
    #[inline]
    fn sample_areas(
        &self,
        at: Receivers16,
        chosen: &U32x16,
        choice: &F32x16,
        u: &Vec2x16,
        wanted: u16,
        samples: &mut DirectSamples16,
    ) {
        let mut triangles = Triangles16::default();
        let (mut varying, mut left) = (0, wanted);
        while left != 0 {
            let index = chosen[left.trailing_zeros() as usize];
            let lanes = left & lanes_with(chosen, index);
            left &= !lanes;
            let light = &self.areas[index as usize];
            varying |= if light.varies() { lanes } else { 0 };
            triangles.choose(lanes, light, u);
        }
        triangles.sample(at.position, choice, samples);
        for lane in lanes_in(varying) {
            let light = &self.areas[chosen[lane] as usize];
            let factor = light.factor(triangles.index[lane], triangles.barycentric.get(lane));
            let radiance = samples.radiance.get(lane) * factor;
            samples.radiance.set(lane, radiance);
            samples.useful[lane] &= u32::from(radiance != Rgb::ZERO);
        }
    }

    /// Samples the environment in the lanes of `wanted`.
    fn sample_environment(
        &self,
        at: Receivers16,
        u: &Vec2x16,
        choice: &F32x16,
        wanted: u16,
        samples: &mut DirectSamples16,
    ) {
        let Some(environment) = &self.environment else { return };
        let sky = environment.sample16(u, wanted, at.sky());
        let mask = Mask16::of(wanted);
        samples.direction.put(mask, sky.direction.load());
        samples.radiance.put(mask, sky.radiance.load());
        samples.normal.put(mask, V3::splat(Vec3::ZERO));
        mask.put(&mut samples.distance, &[f32::INFINITY; LANES]);
        let (mut pdf, mut useful) = ([0.0; LANES], [0; LANES]);
        for i in 0..LANES {
            pdf[i] = choice[i] * sky.pdf[i];
            useful[i] = u32::from(sky.pdf[i] > 0.0);
        }
        mask.put(&mut samples.pdf, &pdf);
        mask.put_u32(&mut samples.useful, &useful);
        mask.put_u32(&mut samples.delta, &[0; LANES]);
    }
}
