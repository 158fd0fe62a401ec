//! Next-event estimation for sixteen points at once.

use super::area::AreaLight;
use super::direct::DirectSample;
use super::emitters::Emitters;
use super::receivers::Receivers16;
use base::math::{F32x16, LANES, Rgb, U32x16, Vec2x16, Vec3x16, lanes_in, mask_of};
use base::sampling::uniform_triangle;
use glam::Vec2;

/// Light arriving at sixteen points; see [`super::DirectSample`] for the fields.
#[derive(Clone, Debug, Default)]
pub struct DirectSamples16 {
    /// Unit directions towards the light.
    pub direction: Vec3x16,
    /// Distances to the emitters' points; infinite for light from infinitely far away.
    pub distance: F32x16,
    /// Geometric normals at those points; zero if there is no surface.
    pub normal: Vec3x16,
    /// Radiances, or irradiances for delta lights.
    pub radiance: Vec3x16,
    /// Densities per solid angle; for delta lights the probabilities of their choice.
    pub pdf: F32x16,
    /// Not zero if the light is a delta light.
    pub delta: U32x16,
    /// Not zero if the sample contributes.
    useful: U32x16,
}

/// Points on emitting triangles, one per lane. Lanes of other emitters have zero area.
#[derive(Default)]
struct Triangles16 {
    corner: Vec3x16,
    edges: [Vec3x16; 2],
    normal: Vec3x16,
    radiance: Vec3x16,
    /// Area of the whole emitter.
    area: F32x16,
    two_sided: U32x16,
    index: U32x16,
    barycentric: Vec2x16,
}

impl DirectSamples16 {
    /// Returns the lanes whose samples contribute.
    #[inline]
    pub fn useful(&self) -> u16 {
        mask_of(&self.useful)
    }

    /// Sets the sample of one lane.
    fn set(&mut self, lane: usize, sample: Option<DirectSample>) {
        self.useful[lane] = u32::from(sample.is_some());
        if let Some(s) = sample {
            self.direction.set(lane, s.direction);
            self.distance[lane] = s.distance;
            self.normal.set(lane, s.normal);
            self.radiance.set(lane, s.radiance);
            self.pdf[lane] = s.pdf;
            self.delta[lane] = u32::from(s.delta);
        }
    }
}

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
        let mut triangles = Triangles16::default();
        let (mut textured, mut rest) = (0u16, 0u16);
        for lane in lanes_in(wanted).filter(|i| choice[*i] > 0.0) {
            match self.areas.get(chosen[lane] as usize) {
                Some(light) => {
                    textured |= u16::from(light.emission.texture.is_some()) << lane;
                    triangles.set(lane, light, u.get(lane));
                }
                None => rest |= 1 << lane,
            }
        }
        let mut samples = triangles.sample(at.position, choice);
        for lane in lanes_in(textured) {
            let light = &self.areas[chosen[lane] as usize];
            let factor = light.texture(triangles.index[lane], triangles.barycentric.get(lane));
            let radiance = samples.radiance.get(lane) * factor;
            samples.radiance.set(lane, radiance);
            samples.useful[lane] &= u32::from(radiance != Rgb::ZERO);
        }
        let mut far = 0;
        for lane in lanes_in(rest) {
            match self.deltas.get(chosen[lane] as usize - self.areas.len()) {
                Some(light) => {
                    samples.set(lane, DirectSample::delta(light, at.position.get(lane), choice[lane]))
                }
                None => far |= 1 << lane,
            }
        }
        if far != 0 {
            self.sample_environment(at, u, choice, far, &mut samples);
        }
        samples
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
        let sampled = environment.sample16(
            u,
            wanted,
            at.learned.and_then(|l| l.sky.as_ref()).map(|sky| (sky, at.position)),
        );
        for lane in lanes_in(wanted) {
            samples.set(lane, sampled[lane].map(|s| DirectSample::environment(&s, choice[lane])));
        }
    }
}

impl Triangles16 {
    /// Chooses a triangle of a light for a lane, by the random numbers `u`.
    #[inline]
    fn set(&mut self, lane: usize, light: &AreaLight, u: Vec2) {
        let (triangle, [corner, e1, e2, normal], u) = light.choose_triangle(u);
        self.corner.set(lane, corner);
        self.edges[0].set(lane, e1);
        self.edges[1].set(lane, e2);
        self.normal.set(lane, normal);
        self.radiance.set(lane, light.emission.radiance);
        self.area[lane] = light.area;
        self.two_sided[lane] = u32::from(light.emission.two_sided);
        self.index[lane] = triangle;
        self.barycentric.set(lane, u);
    }

    /// Maps the random numbers in `barycentric` to barycentric weights, and samples the light from these points.
    #[inline]
    fn sample(&mut self, x: &Vec3x16, choice: &F32x16) -> DirectSamples16 {
        let mut s = DirectSamples16 { normal: self.normal, radiance: self.radiance, ..Default::default() };
        for i in 0..LANES {
            let b = uniform_triangle(self.barycentric.get(i));
            self.barycentric.set(i, b);
            let position = self.corner.get(i) + self.edges[0].get(i) * b.x + self.edges[1].get(i) * b.y;
            let offset = position - x.get(i);
            let dist_sq = offset.length_squared();
            let distance = dist_sq.sqrt();
            let direction = offset / distance;
            let cos = -self.normal.get(i).dot(direction);
            let pdf = choice[i] * dist_sq / (self.area[i] * cos.abs());
            s.direction.set(i, direction);
            s.distance[i] = distance;
            s.pdf[i] = pdf;
            let shines = (cos > 0.0) | (self.two_sided[i] != 0);
            s.useful[i] = u32::from((pdf < f32::INFINITY) & (pdf > 0.0) & shines);
        }
        s
    }
}
